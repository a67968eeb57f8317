#pragma once
// Expressions of the language as values of C++. An Expr is text of the language that knows the lines of C++ its parts
// were written in: `k/2*norm2(x1 - x0)` with Exprs k, x0 and x1 is that text, with as few brackets as it needs, and a
// fault in it is told at its line. Nothing is checked or simplified here; whoever reads the text does
// (symbolic/energy_parser.h).
//
// A double is the shortest decimal number that reads as it, so 0.1 is one tenth; a third is Expr(1)/3.

#include <concepts>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "symbolic/diagnostic.h"

namespace ergon {

template <class T>
concept Number = (std::integral<T> && !std::same_as<T, bool>) || std::floating_point<T>;

// A line of C++; as a default argument that of the call. (std::source_location is not known to every Clang that reads
// the headers of GCC.)
struct SourceLine {
  const char* file;
  int line;
  static constexpr SourceLine here(const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
    return {file, line};
  }
};

// Where each part of a text starts, and the line of C++ it was written in.
using Written = std::vector<std::pair<size_t, Place>>;

Place place_of(const SourceLine& where);

class Expr {
 public:
  using Where = SourceLine;
  // Throws SourceError where the number is not finite.
  template <Number T>
  Expr(T number, Where where = Where::here()) : Expr(of(number, where)) {}

  // A component, counted from 0: of a vector, of a matrix.
  Expr operator[](int row) const;
  Expr operator()(int row, int column) const;

  const std::string& text() const { return text_; }
  const Written& written() const { return written_; }

  // A name as it stands; whether it is known is found where the expression is read.
  static Expr named(std::string name);

 private:
  friend class Text;
  // How strongly the outermost operation binds.
  enum class Level { sum, product, unary, power, postfix, atom };
  Expr(std::string text, Level level, Written written)
      : text_(std::move(text)), level_(level), written_(std::move(written)) {}
  static Expr of(long long number, Where where);
  static Expr of(double number, Where where);
  template <Number T>
  static Expr of(T number, Where where) {
    if constexpr (std::integral<T>)
      return of(static_cast<long long>(number), where);
    else
      return of(static_cast<double>(number), where);
  }

  std::string text_;
  Level level_;
  Written written_;
};

// An expression or number, and the line of the operation that takes it: what is converted implicitly knows it.
struct Operand {
  Operand(Expr e, SourceLine at = SourceLine::here()) : expr(std::move(e)), where(at) {}
  template <Number T>
  Operand(T number, SourceLine at = SourceLine::here()) : expr(number, at), where(at) {}
  Expr expr;
  SourceLine where;
};

Expr operator+(const Operand& a, const Operand& b);
Expr operator-(const Operand& a, const Operand& b);
Expr operator*(const Operand& a, const Operand& b);
Expr operator/(const Operand& a, const Operand& b);
Expr operator-(const Operand& a);
Expr pow(const Operand& base, const Operand& exponent);  // `^`

// left < right, for `active` and `require`.
struct Inequality {
  Expr text;
};
Inequality operator<(const Operand& a, const Operand& b);
Inequality operator>(const Operand& a, const Operand& b);

// [a, b, c] and [a, b; c, d]
Expr vector(std::initializer_list<Operand> components, Expr::Where where = Expr::Where::here());
Expr matrix(std::initializer_list<std::initializer_list<Operand>> rows, Expr::Where where = Expr::Where::here());

// Any function of the language by its name, and each as a function of C++.
Expr call(const std::string& function, std::initializer_list<Operand> arguments,
          Expr::Where where = Expr::Where::here());

inline Expr tr(const Operand& a) { return call("tr", {a}, a.where); }
inline Expr det(const Operand& a) { return call("det", {a}, a.where); }
inline Expr inverse(const Operand& a) { return call("inverse", {a}, a.where); }
inline Expr sym(const Operand& a) { return call("sym", {a}, a.where); }
inline Expr dev(const Operand& a) { return call("dev", {a}, a.where); }
inline Expr norm(const Operand& a) { return call("norm", {a}, a.where); }
inline Expr norm2(const Operand& a) { return call("norm2", {a}, a.where); }
inline Expr sqrt(const Operand& a) { return call("sqrt", {a}, a.where); }
inline Expr log(const Operand& a) { return call("log", {a}, a.where); }
inline Expr exp(const Operand& a) { return call("exp", {a}, a.where); }
inline Expr log1p(const Operand& a) { return call("log1p", {a}, a.where); }
inline Expr expm1(const Operand& a) { return call("expm1", {a}, a.where); }
inline Expr sin(const Operand& a) { return call("sin", {a}, a.where); }
inline Expr cos(const Operand& a) { return call("cos", {a}, a.where); }
inline Expr tan(const Operand& a) { return call("tan", {a}, a.where); }
inline Expr asin(const Operand& a) { return call("asin", {a}, a.where); }
inline Expr acos(const Operand& a) { return call("acos", {a}, a.where); }
inline Expr atan(const Operand& a) { return call("atan", {a}, a.where); }
inline Expr abs(const Operand& a) { return call("abs", {a}, a.where); }
inline Expr stretches(const Operand& a) { return call("stretches", {a}, a.where); }
inline Expr dot(const Operand& a, const Operand& b) { return call("dot", {a, b}, a.where); }
inline Expr outer(const Operand& a, const Operand& b) { return call("outer", {a, b}, a.where); }
inline Expr cross(const Operand& a, const Operand& b) { return call("cross", {a, b}, a.where); }
inline Expr atan2(const Operand& a, const Operand& b) { return call("atan2", {a, b}, a.where); }
inline Expr min(const Operand& a, const Operand& b) { return call("min", {a, b}, a.where); }
inline Expr max(const Operand& a, const Operand& b) { return call("max", {a, b}, a.where); }
Expr transpose(const Operand& a);  // `'`
inline Expr columns(std::initializer_list<Operand> vectors, Expr::Where where = Expr::Where::here()) {
  return call("columns", vectors, where);
}
inline Expr column(const Operand& matrix, const Operand& number) {
  return call("column", {matrix, number}, matrix.where);
}
inline Expr identity(const Operand& size) { return call("identity", {size}, size.where); }
inline Expr spline(const Operand& x, const Operand& knots, const Operand& values) {
  return call("spline", {x, knots, values}, x.where);
}
inline Expr dihedral(const Operand& x0, const Operand& x1, const Operand& x2, const Operand& x3) {
  return call("dihedral", {x0, x1, x2, x3}, x0.where);
}

}  // namespace ergon
