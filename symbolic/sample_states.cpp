#include "symbolic/sample_states.h"

#include <cln/dfloat.h>
#include <cln/integer.h>

#include <cctype>
#include <cmath>

#include "symbolic/double_algebra.h"
#include "symbolic/elaborate.h"

namespace ergon {
namespace {

bool positive(const std::vector<double>& margins) {
  for (const double margin : margins)
    if (!(margin > 0)) return false;
  return true;
}

}  // namespace

Rational StateSampler::fraction(int limit, int den) {
  const int span = 2 * limit + 1;  // the modulus of a 32-bit draw is uniform enough, and the same on every machine
  return Rational(static_cast<int>(engine_() % static_cast<unsigned>(span)) - limit) / Rational(den);
}

Rational StateSampler::within(const Range& range) {
  const bool lower = std::isfinite(range.lower), upper = std::isfinite(range.upper);
  const Rational step = Rational(static_cast<int>(1 + engine_() % 15));
  if (!lower && !upper) return fraction(8, 4);
  const Rational low = lower ? cln::rational(cln::cl_DF(range.lower)) : Rational(0);
  const Rational high = upper ? cln::rational(cln::cl_DF(range.upper)) : Rational(0);
  if (lower && upper) return low + (high - low) * step / 16;
  return lower ? Rational(low + step / 4) : Rational(high - step / 4);
}

ExactInputs StateSampler::any(const Energy& energy) {
  ExactInputs inputs;
  for (const Symbol& symbol : energy.symbols) {
    std::vector<Rational>& values = inputs[symbol.name];
    if (symbol.role == Role::dof && energy.kind == Energy::Kind::density) values = undeformed(symbol.shape);
    for (int i = 0; i < symbol.shape.size(); ++i) {
      if (symbol.role == Role::dof && energy.kind == Energy::Kind::density) {
        values[static_cast<size_t>(i)] = values[static_cast<size_t>(i)] + fraction(4, 8);
      } else {
        values.push_back(symbol.role == Role::dof ? fraction(16, 8) : within(symbol.range));
      }
    }
  }
  return inputs;
}

std::optional<ExactInputs> StateSampler::admissible(const Energy& energy, const std::string& case_name) {
  for (int attempt = 0; attempt < 3000; ++attempt) {
    ExactInputs inputs = any(energy);
    if (energy.kind == Energy::Kind::density && energy.geometry == "solid" && !cln::plusp(determinant(inputs.at("F"))))
      continue;
    DoubleAlgebra algebra(inputs);
    const Elaborated<double> result = elaborate(energy, case_name, algebra);
    if (positive(result.active) && positive(result.require)) return inputs;
  }
  return std::nullopt;
}

std::vector<Rational> StateSampler::vector3() { return {fraction(16, 8), fraction(16, 8), fraction(16, 8)}; }

// With the skew matrix A of the vector (x, y, z), (I - A)^-1 (I + A) is the rotation of the quaternion (1, x, y, z).
std::vector<Rational> StateSampler::rotation() {
  const Rational x = fraction(9, 3), y = fraction(9, 4), z = fraction(9, 5);
  const Rational s = 2 / (1 + x * x + y * y + z * z);
  return {1 - s * (y * y + z * z), s * (x * y + z), s * (x * z - y), s * (x * y - z),        1 - s * (x * x + z * z),
          s * (y * z + x),         s * (x * z + y), s * (y * z - x), 1 - s * (x * x + y * y)};
}

std::vector<Rational> undeformed(Shape shape) {
  std::vector<Rational> F(static_cast<size_t>(shape.size()), Rational(0));
  for (int j = 0; j < shape.cols; ++j) F[static_cast<size_t>(j * shape.rows + j)] = Rational(1);
  return F;
}

Rational determinant(const std::vector<Rational>& a) {
  return a[0] * (a[4] * a[8] - a[5] * a[7]) - a[3] * (a[1] * a[8] - a[2] * a[7]) + a[6] * (a[1] * a[5] - a[2] * a[4]);
}

const Symbol* rest_position(const Energy& energy, const Symbol& dof) {
  std::string name = dof.name;
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  const Symbol* rest = energy.find(name);
  const bool fits = rest && rest->role == Role::rest && rest->shape == dof.shape && rest->unit == dof.unit;
  return fits ? rest : nullptr;
}

}  // namespace ergon
