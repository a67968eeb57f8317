#include "symbolic/function_types.h"

#include <fmt/format.h>

#include <cstdlib>
#include <limits>

#include "symbolic/constant.h"
#include "symbolic/functions.h"
#include "symbolic/other_names.h"

namespace ergon {
namespace {

class Call {
 public:
  Call(const Expression& call, const std::vector<Quantity>& arguments) : call_(call), q_(arguments) {}

  Quantity result() const {
    const std::string& f = call_.text;
    if (const auto scalar = function_named(f)) return of_scalars(*scalar);
    if (f == "pow") {
      count(2);
      return power(call_, q_[0], q_[1], *call_.arguments[1]);
    }
    if (f == "tr" || f == "det" || f == "inverse" || f == "sym" || f == "dev") return of_square();
    if (f == "transpose") {
      count(1);
      if (q_[0].shape.scalar()) refuse(0, "a vector or a matrix");
      return {{q_[0].shape.cols, q_[0].shape.rows}, q_[0].unit, q_[0].any_unit};
    }
    if (f == "norm" || f == "norm2") {
      count(1);
      if (q_[0].shape.scalar()) refuse(0, "a vector or a matrix", f == "norm" ? "; of a scalar take abs" : "");
      return {{}, f == "norm" ? q_[0].unit : q_[0].unit * q_[0].unit, q_[0].any_unit};
    }
    if (f == "cross" || f == "dot" || f == "outer") return of_vectors();
    if (f == "columns") return columns();
    if (f == "column") {
      count(2);
      if (q_[0].shape.cols == 1) refuse(0, "a matrix");
      const int j = whole_number(1, "the number of a column, counted from 0");
      if (j >= q_[0].shape.cols)
        throw SourceError(place(1), fmt::format("column {} is out of range: a {} has columns 0 to {}", j,
                                                to_string(q_[0].shape), q_[0].shape.cols - 1));
      return {{q_[0].shape.rows, 1}, q_[0].unit, q_[0].any_unit};
    }
    if (f == "identity") {
      count(1);
      const int n = whole_number(0, "the size of the matrix, 1 to 9");
      if (n < 1 || n > 9) throw SourceError(place(0), "'identity' expects the size of the matrix, 1 to 9");
      return {{n, n}, {}};
    }
    if (f == "stretches") {
      count(1);
      if (call_.arguments[0]->kind != Expression::Kind::name || call_.arguments[0]->text != "F")
        throw SourceError(place(0), "'stretches' is of F itself, the deformation gradient of a density");
      return {{q_[0].shape.cols, 1}, {}};
    }
    if (f == "dihedral") {
      count(4);
      for (size_t i = 0; i < 4; ++i) vector_of_3(i);
      for (size_t i = 1; i < 4; ++i) same_unit(0, i);
      return {};
    }
    if (f == "spline") return spline();
    const std::string elsewhere = function_elsewhere(f);
    throw SourceError(call_.place, fmt::format("unknown function '{}'", f) +
                                       (elsewhere.empty() ? did_you_mean(f, function_names()) : elsewhere));
  }

 private:
  Place place(size_t i) const { return start_of(*call_.arguments[i]); }

  void count(size_t expected) const {
    if (q_.size() == expected) return;
    throw SourceError(call_.place, fmt::format("'{}' takes {} argument{}, found {}", call_.text, expected,
                                               expected == 1 ? "" : "s", q_.size()));
  }

  [[noreturn]] void refuse(size_t i, const char* expected, const char* remedy = "") const {
    throw SourceError(place(i),
                      fmt::format("'{}' expects {}, found {}{}", call_.text, expected, to_string(q_[i].shape), remedy));
  }

  void vector_of_3(size_t i) const {
    if (q_[i].shape != Shape{3, 1}) refuse(i, "a vector of 3");
  }

  void same_unit(size_t i, size_t j) const {
    const std::string conflict = unit_conflict(q_[i], q_[j]);
    if (!conflict.empty())
      throw SourceError(place(j), fmt::format("'{}' needs arguments of the same unit: {}", call_.text, conflict));
  }

  int whole_number(size_t i, const char* what) const {
    const Expression& e = *call_.arguments[i];
    if (e.kind != Expression::Kind::number || e.text.size() > 3 ||
        e.text.find_first_not_of("0123456789") != std::string::npos)
      throw SourceError(place(i), fmt::format("'{}' expects {}, as a literal", call_.text, what));
    return std::atoi(e.text.c_str());
  }

  Quantity of_scalars(Function f) const {
    count(static_cast<size_t>(argument_count(f)));
    for (size_t i = 0; i < q_.size(); ++i)
      if (!q_[i].shape.scalar()) refuse(i, "a scalar");
    switch (f) {
      case Function::sqrt:
        return {{}, pow(q_[0].unit, {1, 2}), q_[0].any_unit};
      case Function::abs:
        return q_[0];
      case Function::min:
      case Function::max:
        same_unit(0, 1);
        return q_[0].any_unit ? q_[1] : q_[0];
      case Function::atan2:
        same_unit(0, 1);
        return {};
      default:
        if (!q_[0].any_unit && !q_[0].unit.dimensionless())
          throw SourceError(place(0),
                            fmt::format("'{}' expects a pure number (1), found {}", call_.text, to_string(q_[0].unit)));
        return {};
    }
  }

  Quantity of_square() const {
    count(1);
    const Quantity& a = q_[0];
    const int n = a.shape.rows;
    if (n != a.shape.cols || a.shape.scalar()) refuse(0, "a square matrix");
    const bool cofactors = call_.text == "det" || call_.text == "inverse";
    if (cofactors && n > 3) refuse(0, "a 2x2 or 3x3 matrix");
    if (call_.text == "tr") return {{}, a.unit, a.any_unit};
    if (call_.text == "det") return {{}, pow(a.unit, {n, 1}), a.any_unit};
    if (call_.text == "inverse") return {a.shape, pow(a.unit, {-1, 1}), false};
    return a;
  }

  Quantity of_vectors() const {
    count(2);
    const Unit unit = q_[0].unit * q_[1].unit;
    const bool any = q_[0].any_unit || q_[1].any_unit;
    if (call_.text == "cross") {
      vector_of_3(0);
      vector_of_3(1);
      return {{3, 1}, unit, any};
    }
    if (call_.text == "dot") {
      if (q_[0].shape.scalar()) refuse(0, "a vector or a matrix", "; products of scalars are written with '*'");
      if (q_[0].shape != q_[1].shape) refuse(1, ("a " + to_string(q_[0].shape) + " like its first argument").c_str());
      return {{}, unit, any};
    }
    for (size_t i = 0; i < 2; ++i)
      if (q_[i].shape.cols != 1 || q_[i].shape.scalar()) refuse(i, "a vector");
    return {{q_[0].shape.rows, q_[1].shape.rows}, unit, any};
  }

  Quantity columns() const {
    if (q_.empty()) throw SourceError(call_.place, "'columns' takes 1 or more vectors, found none");
    Quantity all = q_[0];
    for (size_t i = 0; i < q_.size(); ++i) {
      if (q_[i].shape.cols != 1 || q_[i].shape.scalar()) refuse(i, "a vector");
      if (q_[i].shape != q_[0].shape) refuse(i, ("a " + to_string(q_[0].shape) + " like its first argument").c_str());
      same_unit(0, i);
      if (all.any_unit) all = q_[i];
    }
    all.shape.cols = static_cast<int>(q_.size());
    return all;
  }

  // A table of literal knots, and of values that may be anything.
  Quantity spline() const {
    count(3);
    if (!q_[0].shape.scalar()) refuse(0, "a scalar");
    if (!q_[0].any_unit && !q_[0].unit.dimensionless())
      throw SourceError(place(0), fmt::format("'spline' expects a pure number (1), found {}; divide it by a value of "
                                              "its own unit",
                                              to_string(q_[0].unit)));
    const Expression& knots = *call_.arguments[1];
    if (knots.kind != Expression::Kind::literal || knots.shape.cols != 1)
      throw SourceError(place(1), "'spline' expects its knots as literal numbers, as in spline(x, [0, 1, 2], values)");
    double last = -std::numeric_limits<double>::infinity();
    for (const ExpressionPtr& knot : knots.arguments) {
      const std::optional<std::string> text = literal_number(*knot);
      if (!text) throw SourceError(start_of(*knot), "a knot of a spline is a literal number");
      const double value = std::strtod(text->c_str(), nullptr);
      if (value <= last)
        throw SourceError(start_of(*knot), fmt::format("the knots of a spline ascend, found {} after {}", value, last));
      last = value;
    }
    if (q_[2].shape.cols != 1 || q_[2].shape.scalar()) refuse(2, "a vector of values, one for each knot");
    if (q_[2].shape.rows != knots.shape.rows)
      throw SourceError(place(2),
                        fmt::format("'spline' has {} knots, and {} values", knots.shape.rows, q_[2].shape.rows));
    return {{}, q_[2].unit, q_[2].any_unit};
  }

  const Expression& call_;
  const std::vector<Quantity>& q_;
};

}  // namespace

Quantity type_of_call(const Expression& call, const std::vector<Quantity>& arguments) {
  return Call(call, arguments).result();
}

Quantity power(const Expression& at, const Quantity& base, const Quantity& exponent, const Expression& exponent_text) {
  if (!base.shape.scalar())
    throw SourceError(at.place, fmt::format("a power expects a scalar base, found {}", to_string(base.shape)) +
                                    (base.shape.rows == base.shape.cols ? "; products of matrices are written A*A"
                                     : base.shape.cols == 1             ? "; the square of a length is norm2(a)"
                                                                        : ""));
  if (!exponent.shape.scalar())
    throw SourceError(start_of(exponent_text),
                      fmt::format("a power expects a scalar exponent, found {}", to_string(exponent.shape)));
  if (!exponent.any_unit && !exponent.unit.dimensionless())
    throw SourceError(start_of(exponent_text),
                      fmt::format("an exponent expects a pure number (1), found {}", to_string(exponent.unit)));
  if (const auto constant = constant_exponent(exponent_text)) return {{}, pow(base.unit, *constant), false};
  if (!base.unit.dimensionless())
    throw SourceError(at.place, fmt::format("an exponent that is not written as a number expects a base that is a pure "
                                            "number (1), found {}",
                                            to_string(base.unit)));
  return {};
}

}  // namespace ergon
