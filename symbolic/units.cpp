#include "symbolic/units.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "symbolic/diagnostic.h"

namespace ergon {
namespace {

constexpr long power_limit = 9999;

Exponent reduced(long num, long den) {
  const long divisor = std::gcd(num, den) * (den < 0 ? -1 : 1);
  num /= divisor;
  den /= divisor;
  if (std::abs(num) > power_limit || den > power_limit)
    throw std::invalid_argument(fmt::format("a power of a unit with more than four digits ({}/{})", num, den));
  return {static_cast<int>(num), static_cast<int>(den)};
}

enum Base { m, kg, s, K, A, mol, cd };

Unit si(std::initializer_list<std::pair<Base, int>> powers) {
  Unit unit;
  for (const auto& [base, power] : powers) unit.powers[base] = {power, 1};
  return unit;
}

struct Named {
  const char* name;
  ScaledUnit unit;
  const char* prefixes;  // each letter a prefix that is in common use
};

const std::vector<Named>& plain_units() {
  static const std::vector<Named> table = {
      {"1", {{}, 1}, ""},
      {"m", {si({{m, 1}}), 1}, "cmunk"},
      {"g", {si({{kg, 1}}), 1e-3}, "kmu"},
      {"t", {si({{kg, 1}}), 1e3}, ""},
      {"s", {si({{s, 1}}), 1}, "mun"},
      {"min", {si({{s, 1}}), 60}, ""},
      {"h", {si({{s, 1}}), 3600}, ""},
      {"Hz", {si({{s, -1}}), 1}, "kM"},
      {"N", {si({{kg, 1}, {m, 1}, {s, -2}}), 1}, "mkM"},
      {"J", {si({{kg, 1}, {m, 2}, {s, -2}}), 1}, "mkM"},
      {"W", {si({{kg, 1}, {m, 2}, {s, -3}}), 1}, "mkM"},
      {"Pa", {si({{kg, 1}, {m, -1}, {s, -2}}), 1}, "kMG"},
      {"K", {si({{K, 1}}), 1}, "m"},
      {"A", {si({{A, 1}}), 1}, "m"},
      {"mol", {si({{mol, 1}}), 1}, "m"},
      {"cd", {si({{cd, 1}}), 1}, ""},
      {"L", {si({{m, 3}}), 1e-3}, "m"},
      {"rad", {{}, 1}, "m"},
      {"deg", {{}, std::numbers::pi / 180}, ""},
  };
  return table;
}

double prefix_scale(char prefix) {
  switch (prefix) {
    case 'n':
      return 1e-9;
    case 'u':
      return 1e-6;
    case 'm':
      return 1e-3;
    case 'c':
      return 1e-2;
    case 'k':
      return 1e3;
    case 'M':
      return 1e6;
    default:
      return 1e9;
  }
}

struct Spelling {
  std::string name;
  ScaledUnit unit;
};

const std::vector<Spelling>& spellings() {
  static const std::vector<Spelling> table = [] {
    std::vector<Spelling> all;
    for (const Named& plain : plain_units()) {
      all.push_back({plain.name, plain.unit});
      for (const char* p = plain.prefixes; *p; ++p) {
        const double scale = std::string_view(plain.name) == "g" && *p == 'k' ? 1 : plain.unit.scale * prefix_scale(*p);
        all.push_back({std::string(1, *p) + plain.name, {plain.unit.unit, scale}});
      }
    }
    return all;
  }();
  return table;
}

[[noreturn]] void unknown(std::string_view name, std::string_view text) {
  std::vector<std::string> names;
  for (const Spelling& known : spellings()) names.push_back(known.name);
  std::string message = fmt::format("unknown unit '{}'", name);
  if (name != text) message += fmt::format(" in '{}'", text);
  // "m2" for m^2
  const size_t digits = name.find_first_of("0123456789");
  if (digits != std::string_view::npos && digits > 0) {
    for (const Spelling& known : spellings()) {
      if (known.name == name.substr(0, digits))
        throw std::invalid_argument(
            fmt::format("{}; powers are written with '^', as in {}^{}", message, known.name, name.substr(digits)));
    }
  }
  throw std::invalid_argument(message + did_you_mean(name, names));
}

class UnitReader {
 public:
  explicit UnitReader(std::string_view text) : text_(text) {}

  ScaledUnit read() {
    const ScaledUnit unit = product();
    if (at_ < text_.size()) fail("expected '*', '/' or '^'");
    return unit;
  }

 private:
  [[noreturn]] void fail(const std::string& expected) const {
    const std::string found = at_ < text_.size() ? fmt::format("'{}'", text_.substr(at_)) : "its end";
    throw std::invalid_argument(fmt::format("in the unit '{}': {}, found {}", text_, expected, found));
  }

  bool take(char c) {
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  ScaledUnit product() {
    ScaledUnit result = factor();
    for (;;) {
      if (take('*')) {
        const ScaledUnit right = factor();
        result = {result.unit * right.unit, result.scale * right.scale};
      } else if (take('/')) {
        const ScaledUnit right = factor();
        result = {result.unit / right.unit, result.scale / right.scale};
      } else {
        return result;
      }
    }
  }

  ScaledUnit factor() {
    ScaledUnit base;
    if (take('(')) {
      if (++depth_ > 20) fail("expected fewer brackets");
      base = product();
      --depth_;
      if (!take(')')) fail("expected ')'");
    } else {
      base = name();
    }
    if (!take('^')) return base;
    const Exponent e = exponent();
    return {pow(base.unit, e), std::pow(base.scale, static_cast<double>(e.num) / e.den)};
  }

  ScaledUnit name() {
    const size_t start = at_;
    while (at_ < text_.size() && std::string_view("*/^()").find(text_[at_]) == std::string_view::npos) ++at_;
    const std::string_view word = text_.substr(start, at_ - start);
    if (word.empty()) fail("expected the name of a unit");
    for (const Spelling& known : spellings())
      if (known.name == word) return known.unit;
    unknown(word, text_);
  }

  Exponent exponent() {
    const bool bracket = take('(');
    const int num = integer();
    const int den = bracket && take('/') ? integer() : 1;
    if (den == 0) fail("expected a denominator other than 0");
    if (bracket && !take(')')) fail("expected ')'");
    return reduced(num, den);
  }

  int integer() {
    const bool minus = take('-');
    const size_t start = at_;
    int value = 0;
    while (at_ < text_.size() && at_ - start < 3 && text_[at_] >= '0' && text_[at_] <= '9')
      value = 10 * value + (text_[at_++] - '0');
    if (at_ == start) fail("expected a whole power");
    return minus ? -value : value;
  }

  std::string_view text_;
  size_t at_ = 0;
  int depth_ = 0;
};

std::string spelled_power(const std::string& name, Exponent e) {
  if (e == Exponent{1, 1}) return name;
  return e.den == 1 ? fmt::format("{}^{}", name, e.num) : fmt::format("{}^({}/{})", name, e.num, e.den);
}

struct Factor {
  std::string name;
  Exponent power;
};

// "a*b/c" from powers; negative powers go below the line.
std::string spelled(const std::vector<Factor>& factors) {
  std::string above, below;
  int count_below = 0;
  for (const auto& [name, power] : factors) {
    if (power.num == 0) continue;
    std::string& side = power.num > 0 ? above : below;
    if (!side.empty()) side += '*';
    side += spelled_power(name, power.num > 0 ? power : Exponent{-power.num, power.den});
    if (power.num < 0) ++count_below;
  }
  if (above.empty()) above = "1";
  if (below.empty()) return above;
  return above + '/' + (count_below > 1 ? '(' + below + ')' : below);
}

}  // namespace

Exponent operator+(Exponent a, Exponent b) {
  return reduced(long{a.num} * b.den + long{b.num} * a.den, long{a.den} * b.den);
}
Exponent operator-(Exponent a, Exponent b) {
  return reduced(long{a.num} * b.den - long{b.num} * a.den, long{a.den} * b.den);
}
Exponent operator*(Exponent a, Exponent b) { return reduced(long{a.num} * b.num, long{a.den} * b.den); }

Unit operator*(const Unit& a, const Unit& b) {
  Unit result;
  for (size_t i = 0; i < a.powers.size(); ++i) result.powers[i] = a.powers[i] + b.powers[i];
  return result;
}

Unit operator/(const Unit& a, const Unit& b) {
  Unit result;
  for (size_t i = 0; i < a.powers.size(); ++i) result.powers[i] = a.powers[i] - b.powers[i];
  return result;
}

Unit pow(const Unit& a, Exponent e) {
  Unit result;
  for (size_t i = 0; i < a.powers.size(); ++i) result.powers[i] = a.powers[i] * e;
  return result;
}

ScaledUnit parse_unit(std::string_view text) {
  if (text.empty()) throw std::invalid_argument("expected a unit, found nothing; a pure number has the unit 1");
  return UnitReader(text).read();
}

std::string to_string(const Unit& unit) {
  // Mechanical units are told as forces, energies, powers and pressures where that is the custom.
  const Exponent metre = unit.powers[m], mass = unit.powers[kg], second = unit.powers[s];
  std::vector<Factor> factors;
  if (mass == Exponent{1, 1} && second == Exponent{-2, 1} && metre.den == 1) {
    const int p = metre.num;
    const char* head = p == -1 ? "Pa" : p == 0 || p == 1 ? "N" : "J";
    const int used = p == -1 ? -1 : p == 0 || p == 1 ? 1 : 2;
    factors = {{head, {1, 1}}, {"m", {p - used, 1}}};
  } else if (mass == Exponent{1, 1} && second == Exponent{-3, 1} && metre.den == 1) {
    factors = {{"W", {1, 1}}, {"m", {metre.num - 2, 1}}};
  } else if (mass == Exponent{1, 1} && second == Exponent{-1, 1} && metre == Exponent{-1, 1}) {
    factors = {{"Pa", {1, 1}}, {"s", {1, 1}}};
  } else {
    factors = {{"kg", mass}, {"m", metre}, {"s", second}};
  }
  factors.push_back({"K", unit.powers[K]});
  factors.push_back({"A", unit.powers[A]});
  factors.push_back({"mol", unit.powers[mol]});
  factors.push_back({"cd", unit.powers[cd]});
  return spelled(factors);
}

std::string describe(const Unit& unit) {
  static const std::vector<std::pair<const char*, const char*>> quantities = {
      {"1", "a pure number"}, {"m", "a length"},      {"m^2", "an area"},           {"m^3", "a volume"},
      {"kg", "a mass"},       {"s", "a time"},        {"m/s", "a speed"},           {"m/s^2", "an acceleration"},
      {"N", "a force"},       {"J", "an energy"},     {"Pa", "a stress"},           {"N/m", "a stiffness"},
      {"W", "a power"},       {"K", "a temperature"}, {"kg/m^3", "a mass density"}, {"1/m", "a curvature"},
      {"1/s", "a frequency"}, {"A", "a current"}};
  const std::string spelling = to_string(unit);
  for (const auto& [name, quantity] : quantities)
    if (spelling == name) return fmt::format("{} ({})", quantity, name);
  return spelling;
}

}  // namespace ergon
