#include "symbolic/cln_algebra.h"

#include <cln/dfloat.h>
#include <cln/exception.h>
#include <cln/integer.h>
#include <cln/integer_ring.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace ergon {
namespace {

using cln::cl_DF;
using cln::cl_F;
using cln::cl_I;
using cln::cl_R;
using cln::cl_RA;

struct NotReal {};

// Runs an operation; what has no real and finite result is marked so.
template <class F>
ClnNumber guarded(bool defined, F&& operation) {
  if (defined) {
    try {
      return {operation(), true};
    } catch (const cln::runtime_exception&) {
    } catch (const NotReal&) {
    }
  }
  return {cl_I(0), false};
}

// Bits by which x lies below 1; a sum 1 + x needs that many more than x has.
uintptr_t bits_below_one(const cl_F& x) {
  const auto exponent = cln::float_exponent(x);
  return exponent < 0 ? static_cast<uintptr_t>(std::min<decltype(-exponent)>(-exponent, 100000)) : 0;
}

cl_F widened(const cl_F& x) {
  return cln::cl_float(x, static_cast<cln::float_format_t>(cln::float_digits(x) + bits_below_one(x) + 64));
}

}  // namespace

cl_RA exact_decimal(const std::string& text) {
  const size_t e = text.find_first_of("eE");
  std::string digits = text.substr(0, e);
  long exponent = e == std::string::npos ? 0 : std::stol(text.substr(e + 1));
  if (const size_t point = digits.find('.'); point != std::string::npos) {
    exponent -= static_cast<long>(digits.size() - point - 1);
    digits.erase(point, 1);
  }
  return cl_I(digits.c_str()) * cln::expt(cl_RA(10), cl_I(exponent));
}

const cl_RA& exact_input(const ExactInputs& inputs, const Symbol& symbol, int component) {
  const auto found = inputs.find(symbol.name);
  if (found == inputs.end()) throw std::invalid_argument("no value is given for '" + symbol.name + "'");
  if (found->second.size() != static_cast<size_t>(symbol.shape.size()))
    throw std::invalid_argument("'" + symbol.name + "' has " + std::to_string(symbol.shape.size()) +
                                " components, found " + std::to_string(found->second.size()));
  return found->second[static_cast<size_t>(component)];
}

double to_double(const ClnNumber& number) {
  if (!number.defined) return std::numeric_limits<double>::quiet_NaN();
  return cln::double_approx(number.value);
}

// The integer 0 stays exact: it marks what is zero by structure.
ClnNumber ClnAlgebra::number(const std::string& decimal) const {
  const cl_RA exact = exact_decimal(decimal);
  if (cln::zerop(exact)) return {cl_I(0)};
  return {rounded(exact)};
}

ClnNumber ClnAlgebra::input(const Symbol& symbol, int component) const {
  return {rounded(exact_input(inputs_, symbol, component))};
}

bool ClnAlgebra::is_zero(const ClnNumber& a) const {
  // clang-format off
  return a.defined && cln::instanceof(a.value, cln::cl_I_ring) && cln::zerop(a.value);
  // clang-format on
}

ClnNumber ClnAlgebra::add(const ClnNumber& a, const ClnNumber& b) const {
  return guarded(a.defined && b.defined, [&] { return a.value + b.value; });
}

ClnNumber ClnAlgebra::subtract(const ClnNumber& a, const ClnNumber& b) const {
  return guarded(a.defined && b.defined, [&] { return a.value - b.value; });
}

ClnNumber ClnAlgebra::multiply(const ClnNumber& a, const ClnNumber& b) const {
  return guarded(a.defined && b.defined, [&] { return a.value * b.value; });
}

ClnNumber ClnAlgebra::divide(const ClnNumber& a, const ClnNumber& b) const {
  return guarded(a.defined && b.defined, [&] {
    if (cln::zerop(b.value)) throw NotReal{};
    return a.value / b.value;
  });
}

ClnNumber ClnAlgebra::power(const ClnNumber& a, long num, long den) const {
  return guarded(a.defined, [&]() -> cl_R {
    if (cln::zerop(a.value)) {
      if (num < 0) throw NotReal{};
      return num == 0 ? rounded(cl_I(1)) : rounded(cl_I(0));
    }
    if (den == 1) return cln::expt(a.value, cl_I(num));
    if (cln::minusp(a.value)) throw NotReal{};
    if (den == 2) return cln::expt(cln::sqrt(rounded(a.value)), cl_I(num));
    return cln::exp(rounded(cl_RA(num) / cl_RA(den)) * cln::ln(rounded(a.value)));
  });
}

ClnNumber ClnAlgebra::power(const ClnNumber& a, const ClnNumber& b) const {
  return guarded(a.defined && b.defined, [&]() -> cl_R {
    if (cln::zerop(a.value)) {
      if (!cln::plusp(b.value)) throw NotReal{};
      return rounded(cl_I(0));
    }
    if (cln::minusp(a.value)) {
      const cl_I whole = cln::round1(b.value);
      if (whole != b.value) throw NotReal{};
      return cln::expt(a.value, whole);
    }
    return cln::exp(rounded(b.value) * cln::ln(rounded(a.value)));
  });
}

ClnNumber ClnAlgebra::call(Function f, const std::vector<ClnNumber>& arguments) const {
  const ClnNumber& x = arguments[0];
  if (f == Function::abs) return guarded(x.defined, [&] { return cln::abs(x.value); });
  if (arguments.size() == 1) return guarded(x.defined, [&] { return function(f, rounded(x.value)); });
  const ClnNumber& y = arguments[1];
  return guarded(x.defined && y.defined, [&]() -> cl_R {
    if (f == Function::min) return y.value < x.value ? y.value : x.value;
    if (f == Function::max) return x.value < y.value ? y.value : x.value;
    if (cln::zerop(x.value) && cln::zerop(y.value)) throw NotReal{};
    return cln::atan(rounded(y.value), rounded(x.value));
  });
}

cl_R ClnAlgebra::function(Function f, const cl_F& x) const {
  switch (f) {
    case Function::sqrt:
      if (cln::minusp(x)) throw NotReal{};
      return cln::sqrt(x);
    case Function::log:
      if (!cln::plusp(x)) throw NotReal{};
      return cln::ln(x);
    case Function::log1p:
      return log1p(x);
    case Function::exp:
      return cln::exp(x);
    case Function::expm1:
      return expm1(x);
    case Function::sin:
      return cln::sin(x);
    case Function::cos:
      return cln::cos(x);
    case Function::tan:
      return cln::tan(x);
    case Function::atan:
      return cln::atan(x);
    default: {  // asin, acos: angles of points on the unit circle
      const cl_R square = (1 - x) * (1 + x);
      if (cln::minusp(square)) throw NotReal{};
      const cl_R other = cln::sqrt(square);
      return f == Function::asin ? cln::atan(other, x) : cln::atan(x, other);
    }
  }
}

std::vector<ClnNumber> ClnAlgebra::stretches(const Tensor<ClnNumber>& F) const { return decomposed(F.at, false).s; }

Decomposed<ClnNumber> ClnAlgebra::decompose_apart(const std::vector<ClnNumber>& F) const { return decomposed(F, true); }

Decomposed<ClnNumber> ClnAlgebra::decomposed(const std::vector<ClnNumber>& F, bool apart) const {
  const cl_F one = cln::cl_float(1, format_);
  const long bits = static_cast<long>(cln::float_digits(one));
  const cl_F little = cln::scale_float(one, -bits / 2);
  std::vector<cl_F> f;
  bool defined = true;
  for (const ClnNumber& x : F) {
    defined = defined && x.defined;
    f.push_back(rounded(x.value));
    if (apart) f.back() = f.back() + little * cln::cl_float(cl_DF(general_position[f.size() - 1]), format_);
  }
  const Decomposed<cl_F> found = decompose<cl_F>(f, one, cln::scale_float(one, 8 - bits));
  Decomposed<ClnNumber> out;
  for (const cl_F& s : found.s) out.s.push_back({s, defined});
  for (const auto& [from, to] : {std::pair(&found.u, &out.u), std::pair(&found.v, &out.v)})
    for (const Triple<cl_F>& a : *from)
      to->push_back({ClnNumber{a[0], defined}, ClnNumber{a[1], defined}, ClnNumber{a[2], defined}});
  return out;
}

cl_R ClnAlgebra::log1p(const cl_F& x) const {
  const cl_F sum = cln::cl_float(1, widened(x)) + widened(x);
  if (!cln::plusp(sum)) throw NotReal{};
  return rounded(cln::ln(sum));
}

cl_R ClnAlgebra::expm1(const cl_F& x) const {
  const cl_F power = cln::exp(widened(x));
  return rounded(power - cln::cl_float(1, power));
}

}  // namespace ergon
