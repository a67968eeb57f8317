#pragma once
// Physical units as exact powers of the SI base units, and the reader of unit texts such as "kN/m^2".

#include <array>
#include <string>
#include <string_view>

namespace ergon {

// An exact rational exponent, always in lowest terms with a positive denominator.
struct Exponent {
  int num = 0;
  int den = 1;
  bool operator==(const Exponent&) const = default;
};
// Exponents of more than four digits throw std::invalid_argument.
Exponent operator+(Exponent a, Exponent b);
Exponent operator-(Exponent a, Exponent b);
Exponent operator*(Exponent a, Exponent b);

// Exponents of m, kg, s, K, A, mol, cd. An angle is dimensionless.
struct Unit {
  std::array<Exponent, 7> powers{};
  bool operator==(const Unit&) const = default;
  bool dimensionless() const { return *this == Unit{}; }
};
Unit operator*(const Unit& a, const Unit& b);
Unit operator/(const Unit& a, const Unit& b);
Unit pow(const Unit& a, Exponent e);

// A unit and the factor that brings a number in it to SI: "mm" is {m, 1e-3}.
struct ScaledUnit {
  Unit unit;
  double scale = 1;
};

// Reads "1", "m", "J/m^4", "kg*m/s^2", "kPa", "mm", "g/cm^3", "deg" ... Throws std::invalid_argument with a message
// naming the part that is not known and the nearest unit.
ScaledUnit parse_unit(std::string_view text);

// The common spelling: "Pa", "J/m^4", "kg*m/s", "1".
std::string to_string(const Unit& unit);

// The kind of quantity with its unit: "a length (m)"; the unit alone where the kind has no common name.
std::string describe(const Unit& unit);

}  // namespace ergon
