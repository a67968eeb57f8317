#include "symbolic/material_axes.h"

#include <cln/dfloat.h>
#include <fmt/format.h>

#include <algorithm>

#include "symbolic/elaborate.h"
#include "symbolic/jet.h"
#include "symbolic/stretches.h"

namespace ergon {
namespace {

using cln::cl_F;

cl_F real(const cln::cl_R& x) { return cln::cl_float(x, cln::float_format(static_cast<uintptr_t>(axis_digits))); }

Axis unit(const Axis& a) {
  const cl_F length = cln::sqrt(singular::dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

Axis combined(const cl_F& c, const Axis& a, const cl_F& d, const Axis& b) {
  return {c * a[0] + d * b[0], c * a[1] + d * b[1], c * a[2] + d * b[2]};
}

bool small(const cl_F& x) { return cln::abs(x) < real(cln::rational(cln::cl_DF(axis_tolerance))); }

// By Rodrigues' formula.
std::vector<Rational> rotation_about(const Axis& n, const cl_F& cosine, const cl_F& sine) {
  std::vector<Rational> R;
  for (size_t j = 0; j < 3; ++j) {
    for (size_t i = 0; i < 3; ++i) {
      cl_F entry = (1 - cosine) * n[i] * n[j];
      if (i == j) entry = entry + cosine;
      if (i != j) entry = (i + 1) % 3 == j ? entry - sine * n[3 - i - j] : entry + sine * n[3 - i - j];
      R.push_back(cln::rational(entry));
    }
  }
  return R;
}

}  // namespace

bool parallel(const Axis& a, const Axis& b) {
  const Axis n = singular::cross(a, b);
  return small(cln::sqrt(singular::dot(n, n)));
}

bool perpendicular(const Axis& a, const Axis& b) { return small(singular::dot(a, b)); }

Axis across(const Axis& a, const Axis& b) { return unit(singular::cross(a, b)); }

Axis diagonal_of(const Axis& a, const Axis& b, const Axis& c) {
  return unit({a[0] + b[0] + c[0], a[1] + b[1] + c[1], a[2] + b[2] + c[2]});
}

Axis coordinate_axis(int i) { return {real(i == 0 ? 1 : 0), real(i == 1 ? 1 : 0), real(i == 2 ? 1 : 0)}; }

std::string numbers_of(const Axis& axis) {
  double sign = 0;
  std::vector<std::string> texts;
  for (const cl_F& x : axis) {
    const double component = small(x) ? 0 : cln::double_approx(x);
    if (sign == 0 && component != 0) sign = component > 0 ? 1 : -1;
    texts.push_back(fmt::format("{:.4g}", sign * component + 0.0));
  }
  return fmt::format("({})", fmt::join(texts, ", "));
}

std::vector<Rational> part_of_turn(const Axis& axis, int n) {
  const cl_F angle = real(cln::pi(real(1)) * real(2) / n);
  return rotation_about(axis, cln::cos(angle), cln::sin(angle));
}

std::vector<Rational> turn_by(const Axis& axis, const Rational& t) {
  return rotation_about(axis, real((1 - t * t) / (1 + t * t)), real(2 * t / (1 + t * t)));
}

void add_axis(NamedAxis axis, std::vector<NamedAxis>& axes) {
  const auto same = [&](const NamedAxis& other) { return parallel(other.axis, axis.axis); };
  if (std::none_of(axes.begin(), axes.end(), same)) axes.push_back(std::move(axis));
}

std::vector<NamedAxis> declared_axes(const Energy& energy, const ExactInputs& data) {
  const int columns = energy.find("F")->shape.cols;
  std::vector<NamedAxis> axes;
  for (const Symbol& symbol : energy.symbols) {
    if (symbol.role == Role::dof || symbol.shape.rows != columns || symbol.shape.cols != 1) continue;
    const auto& at = data.at(symbol.name);
    const Axis axis = {real(at[0]), real(at[1]), columns == 3 ? real(at[2]) : real(0)};
    if (!small(singular::dot(axis, axis))) add_axis({symbol.name, unit(axis)}, axes);
  }
  const size_t declared = axes.size();
  for (size_t i = 0; i < declared; ++i) {
    if (columns == 2) add_axis({"across " + axes[i].name, across(coordinate_axis(2), axes[i].axis)}, axes);
    for (size_t j = i + 1; j < declared; ++j) {
      const auto [a, u] = axes[i];
      const auto [b, v] = axes[j];
      if (columns == 3) add_axis({fmt::format("cross({}, {})", a, b), across(u, v)}, axes);
      add_axis({fmt::format("the bisector of {} and {}", a, b), unit(combined(real(1), u, real(1), v))}, axes);
      add_axis({fmt::format("the bisector of {} and -{}", a, b), unit(combined(real(1), u, real(-1), v))}, axes);
    }
  }
  return axes;
}

ScaledShape::ScaledShape(const Energy& energy, const std::string& case_name, const ExactInputs& data)
    : columns_(energy.find("F")->shape.cols) {
  for (const int scale : {9, 10, 8, 7}) {
    ExactInputs inputs = data;
    inputs["F"] = undeformed(energy.find("F")->shape);
    for (Rational& x : inputs["F"]) x = x * scale / 8;
    ClnAlgebra numbers(inputs, digits_for_derivatives(energy, axis_digits));
    JetAlgebra<ClnAlgebra> jets(energy, numbers);
    const Jet<ClnNumber> jet = elaborate(energy, case_name, jets).value;
    const auto defined = [](const ClnNumber& x) { return x.defined; };
    if (jet.hessian.empty() || !std::all_of(jet.gradient.begin(), jet.gradient.end(), defined) ||
        !std::all_of(jet.hessian.begin(), jet.hessian.end(), defined))
      continue;
    for (const ClnNumber& x : jet.gradient) gradient_.push_back(real(x.value));
    for (const ClnNumber& x : jet.hessian) hessian_.push_back(real(x.value));
    return;
  }
}

cl_F ScaledShape::stress(int i, int j) const { return gradient_[static_cast<size_t>(3 * j + i)]; }

cl_F ScaledShape::stiffness(int i, int j, int k, int l) const {
  const auto a = static_cast<size_t>(3 * j + i), b = static_cast<size_t>(3 * l + k);
  return hessian_[std::max(a, b) * (std::max(a, b) + 1) / 2 + std::min(a, b)];
}

void ScaledShape::add_axes_of_stress(std::vector<NamedAxis>& axes) const {
  if (hessian_.empty()) return;
  std::vector<cl_F> matrix(9, real(0));
  const auto entry = [&](int i, int j) -> cl_F& { return matrix[static_cast<size_t>(3 * j + i)]; };
  for (int i = 0; i < columns_; ++i) {
    for (int j = 0; j < columns_; ++j) {
      cl_F sum = stress(i, j) + stress(j, i);
      for (int k = 0; k < columns_; ++k)  // weighted by numbers that nothing else is likely to have
        sum = sum + 17 * stiffness(i, k, j, k) / 29 + 37 * stiffness(k, i, k, j) / 23 +
              (stiffness(i, j, k, k) + stiffness(j, i, k, k)) * 41 / 53;
      entry(i, j) = sum;
    }
  }
  if (columns_ == 2) {
    const cl_F half = (entry(0, 0) - entry(1, 1)) / 2;
    if (small(half) && small(entry(0, 1))) return;
    const cl_F angle = cln::atan(half, entry(0, 1)) / 2;
    add_axis({"", {cln::cos(angle), cln::sin(angle), real(0)}}, axes);
    add_axis({"", {-cln::sin(angle), cln::cos(angle), real(0)}}, axes);
    return;
  }
  cl_F size = real(1);
  for (const cl_F& x : matrix) size = size + cln::abs(x);
  for (int i = 0; i < 3; ++i) entry(i, i) = entry(i, i) + 2 * size;  // positive definite: V are eigenvectors
  const cl_F one = real(1);
  const long bits = static_cast<long>(cln::float_digits(one));
  for (const Axis& v : decompose<cl_F>(matrix, one, cln::scale_float(one, 8 - bits)).v) add_axis({"", unit(v)}, axes);
}

Axis ScaledShape::slope(const Axis& n) const {
  Axis sum = {real(0), real(0), real(0)};
  for (int i = 0; i < columns_; ++i)
    for (int j = 0; j < columns_; ++j)
      for (int k = 0; k < columns_; ++k)
        for (int l = 0; l < columns_; ++l)
          sum[static_cast<size_t>(i)] = sum[static_cast<size_t>(i)] + (stiffness(i, j, k, l) + stiffness(j, i, k, l)) /
                                                                          2 * n[static_cast<size_t>(j)] *
                                                                          n[static_cast<size_t>(k)] *
                                                                          n[static_cast<size_t>(l)];
  return sum;
}

cl_F ScaledShape::along(const Axis& n) const { return singular::dot(slope(n), n); }

// About an axis of order 4 the stiffness goes as a*cos(4 angle) + b*sin(4 angle).
void ScaledShape::add_axes_across(const Axis& n, std::vector<NamedAxis>& axes) const {
  const Axis u = singular::normal_to(n, real(1)), v = singular::cross(n, u);
  const auto at = [&](int eighths) {
    const cl_F angle = real(eighths * cln::pi(real(1)) / 8);
    return along(combined(cln::cos(angle), u, cln::sin(angle), v));
  };
  const cl_F a = at(0) - at(2), b = at(1) - at(3);
  if (small(a) && small(b)) return;
  const cl_F angle = cln::atan(a, b) / 4;
  for (const int eighths : {0, 2, 1, 3}) {  // the greatest, then the least
    const cl_F to = angle + eighths * cln::pi(real(1)) / 4;
    add_axis({"", unit(combined(cln::cos(to), u, cln::sin(to), v))}, axes);
  }
}

// By Newton's method on the sphere from the best of a few directions in general position.
Axis ScaledShape::extreme(bool greatest) const {
  Axis n = coordinate_axis(0);
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) {
      const Axis a = unit({real(Rational(2 * i + 1) / 7), real(Rational(2 * j + 1) / 8), real(Rational(5) / 6)});
      if (greatest ? along(a) > along(n) : along(a) < along(n)) n = a;
    }
  }
  for (int step = 0; step < 40; ++step) {
    const Axis u = singular::normal_to(n, real(1)), v = singular::cross(n, u);
    // On the sphere the derivative of c(n, n, n, n) along u is 4 c(n, n, n, u), the second one 12 c(n, n, u, u) - 4
    // c(n, n, n, n). The form of (n, n, a, b) follows from slopes at n + a and n - a.
    const auto mixed = [&](const Axis& a, const Axis& b) {
      const Axis plus = slope(combined(real(1), n, real(1), a)), minus = slope(combined(real(1), n, real(-1), a));
      return cl_F((singular::dot(plus, b) - singular::dot(minus, b)) / 2 - singular::dot(slope(a), b)) / 3;
    };
    const cl_F third = along(n) / 3, gu = singular::dot(slope(n), u) / 3, gv = singular::dot(slope(n), v) / 3;
    const cl_F huu = mixed(u, u) - third, hvv = mixed(v, v) - third, huv = mixed(u, v);
    const cl_F det = huu * hvv - huv * huv;
    if (cln::zerop(det)) break;
    const cl_F du = (huv * gv - hvv * gu) / det, dv = (huv * gu - huu * gv) / det;
    n = unit(combined(real(1), n, real(1), combined(du, u, dv, v)));
    if (small(du * du + dv * dv)) break;
  }
  return n;
}

void ScaledShape::add_axes_of_stiffness(std::vector<NamedAxis>& axes) const {
  if (hessian_.empty()) return;
  if (columns_ == 2) return add_axes_across(coordinate_axis(2), axes);
  for (const bool greatest : {true, false}) {
    const Axis n = extreme(greatest);
    add_axis({"", n}, axes);
    add_axes_across(n, axes);
  }
}

}  // namespace ergon
