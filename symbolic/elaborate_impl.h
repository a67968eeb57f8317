#pragma once
// The walk over an energy's expressions, in the order of their text.

#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <stdexcept>
#include <type_traits>

#include "symbolic/constant.h"
#include "symbolic/elaborate.h"
#include "symbolic/spline.h"
#include "symbolic/tensor_operations.h"

namespace ergon {

template <class A>
class Elaborator {
 public:
  using S = typename A::Scalar;
  using T = Tensor<S>;

  explicit Elaborator(A& algebra) : a_(algebra), op_(algebra) {}
  Elaborator(A& algebra, std::map<std::string, T> names) : a_(algebra), op_(algebra), names_(std::move(names)) {}

  T tensor(const Expression& e) {
    T t = evaluated(e);
    if constexpr (requires { a_.formed(e, t.at); }) a_.formed(e, t.at);
    return t;
  }

  Elaborated<S> run(const Energy& energy, const std::string& case_name) {
    if (energy.cases.empty() ? !case_name.empty()
                             : std::count(energy.cases.begin(), energy.cases.end(), case_name) == 0)
      throw std::invalid_argument("'" + energy.name + "' has no case '" + case_name + "'");
    for (const Symbol& symbol : energy.symbols) {
      T t{symbol.shape, {}};
      for (int i = 0; i < symbol.shape.size(); ++i) t.at.push_back(a_.input(symbol, i));
      names_.insert_or_assign(symbol.name, std::move(t));
    }
    for (const Let& let : energy.lets) {
      if (!let.case_name.empty() && let.case_name != case_name) continue;
      T t = tensor(*let.expression);
      for (int i = 0; i < t.shape.size(); ++i) {
        S& component = t.at[static_cast<size_t>(i)];
        if constexpr (std::is_void_v<decltype(a_.named(let.name, i, t.shape.size(), component))>)
          a_.named(let.name, i, t.shape.size(), component);
        else
          component = a_.named(let.name, i, t.shape.size(), component);
      }
      names_.insert_or_assign(let.name, std::move(t));
    }
    S value = scalar(*energy.value);
    Elaborated<S> result{std::move(value), {}, {}, {}};
    for (const Condition& c : energy.active) result.active.push_back(margin(c));
    for (const Condition& c : energy.require) result.require.push_back(margin(c));
    for (const Let& update : energy.updates) {
      const T t = tensor(*update.expression);
      result.update.insert(result.update.end(), t.at.begin(), t.at.end());
    }
    return result;
  }

 private:
  using Kind = Expression::Kind;

  S pi() {
    if constexpr (requires { a_.pi(); }) return a_.pi();
    return a_.number("3.14159265358979323846");  // more digits than a double holds
  }

  S margin(const Condition& c) {
    const S left = scalar(*c.left);
    const S right = scalar(*c.right);
    return a_.subtract(right, left);
  }

  S scalar(const Expression& e) { return tensor(e).at[0]; }

  // Tells an algebra that wants to know which expression the operations from here on belong to.
  void at(const Expression& e) {
    if constexpr (requires { a_.at(e); }) a_.at(e);
  }

  T evaluated(const Expression& e) {
    switch (e.kind) {
      case Kind::number:
        return op_.scalar(a_.number(e.text));
      case Kind::name:
        return e.text == "pi" ? op_.scalar(pi()) : names_.at(e.text);
      case Kind::negate:
        return op_.negate(tensor(*e.arguments[0]));
      case Kind::power:
        return op_.scalar(power(e));
      case Kind::transpose:
        return op_.transpose(tensor(*e.arguments[0]));
      case Kind::index:
        return op_.scalar(component(e));
      case Kind::literal:
        return literal(e);
      case Kind::call:
        return call(e);
      default:
        break;
    }
    const T left = tensor(*e.arguments[0]);
    const T right = tensor(*e.arguments[1]);
    at(e);
    switch (e.kind) {
      case Kind::add:
        return op_.add(left, right);
      case Kind::subtract:
        return op_.subtract(left, right);
      case Kind::multiply:
        return op_.multiply(left, right);
      default:
        return op_.divide(left, right.at[0]);
    }
  }

  S power(const Expression& e) {
    const S base = scalar(*e.arguments[0]);
    const Expression& exponent_text = *e.arguments[1];
    at(e);
    if (const auto constant = constant_exponent(exponent_text)) {
      if (*constant == Exponent{1, 1}) return base;
      if (constant->num == 0) return a_.number("1");
      return a_.power(base, static_cast<long>(constant->num), static_cast<long>(constant->den));
    }
    const S exponent = scalar(exponent_text);
    at(e);
    return a_.power(base, exponent);
  }

  static int whole(const Expression& e) { return std::atoi(e.text.c_str()); }

  S component(const Expression& e) {
    const T t = tensor(*e.arguments[0]);
    return t(whole(*e.arguments[1]), e.arguments.size() == 3 ? whole(*e.arguments[2]) : 0);
  }

  T literal(const Expression& e) {
    std::vector<S> by_rows;
    for (const ExpressionPtr& item : e.arguments) by_rows.push_back(scalar(*item));
    const Shape shape{e.shape.rows, e.shape.cols};
    T r{shape, {}};
    for (int j = 0; j < shape.cols; ++j)
      for (int i = 0; i < shape.rows; ++i) r.at.push_back(by_rows[static_cast<size_t>(i * shape.cols + j)]);
    return r;
  }

  T call(const Expression& e) {
    const std::string& f = e.text;
    const auto& text = e.arguments;
    if (f == "pow") return op_.scalar(power(e));
    if (f == "identity") return op_.identity(whole(*text[0]));
    if (f == "column") return op_.column(tensor(*text[0]), whole(*text[1]));
    if (f == "spline") return op_.scalar(spline(e));
    std::vector<T> t;
    for (const ExpressionPtr& argument : text) t.push_back(tensor(*argument));
    at(e);
    if (const auto function = function_named(f)) {
      std::vector<S> arguments;
      for (const T& x : t) arguments.push_back(x.at[0]);
      return op_.scalar(a_.call(*function, arguments));
    }
    if (f == "tr") return op_.scalar(op_.trace(t[0]));
    if (f == "det") return op_.scalar(op_.determinant(t[0]));
    if (f == "inverse") return op_.inverse(t[0]);
    if (f == "transpose") return op_.transpose(t[0]);
    if (f == "cross") return op_.cross(t[0], t[1]);
    if (f == "dot") return op_.scalar(op_.dot(t[0], t[1]));
    if (f == "outer") return op_.outer(t[0], t[1]);
    if (f == "norm") return op_.scalar(op_.norm(t[0]));
    if (f == "norm2") return op_.scalar(op_.norm2(t[0]));
    if (f == "columns") return op_.columns(t);
    if (f == "sym") return op_.symmetric_part(t[0]);
    if (f == "dev") return op_.deviator(t[0]);
    if (f == "stretches") return stretches(t[0]);
    if (f == "dihedral") return op_.scalar(op_.dihedral(t[0], t[1], t[2], t[3]));
    throw SourceError(e.place, "unknown function '" + f + "'");
  }

  S spline(const Expression& e) {
    const S x = scalar(*e.arguments[0]);
    const T values = tensor(*e.arguments[2]);
    std::vector<S> knots;
    for (const ExpressionPtr& knot : e.arguments[1]->arguments) knots.push_back(scalar(*knot));
    at(e);
    return NaturalSpline<A>(a_, knots, values.at).at(x);
  }

  T stretches(const T& F) {
    if constexpr (requires { a_.stretches(F); }) return {{F.shape.cols, 1}, a_.stretches(F)};
    throw std::domain_error("this algebra has no singular values");
  }

  A& a_;
  TensorOperations<A> op_;
  std::map<std::string, T> names_;
};

template <class A>
Elaborated<typename A::Scalar> elaborate(const Energy& energy, const std::string& case_name, A& algebra) {
  return Elaborator<A>(algebra).run(energy, case_name);
}

template <class A>
Tensor<typename A::Scalar> evaluate(const Expression& expression,
                                    const std::map<std::string, Tensor<typename A::Scalar>>& names, A& algebra) {
  return Elaborator<A>(algebra, names).tensor(expression);
}

}  // namespace ergon
