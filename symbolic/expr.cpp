#include "symbolic/expr.h"

#include <fmt/format.h>

#include <cmath>

namespace ergon {

Place place_of(const SourceLine& where) { return {where.file, where.line, 0}; }

// A text that is put together.
class Text {
 public:
  using Level = Expr::Level;

  // What follows is written at `where`.
  Text& add(const std::string& words, const SourceLine& where) {
    written_.emplace_back(text_.size(), place_of(where));
    text_ += words;
    return *this;
  }

  // In brackets where it binds less than `least`.
  Text& add(const Operand& operand, Level least = Level::sum) {
    const bool brackets = operand.expr.level_ < least;
    add(brackets ? "(" : "", operand.where);
    for (const auto& [offset, place] : operand.expr.written()) written_.emplace_back(text_.size() + offset, place);
    text_ += operand.expr.text();
    if (brackets) text_ += ')';
    return *this;
  }

  Text& list(std::initializer_list<Operand> operands) {
    bool first = true;
    for (const Operand& operand : operands) {
      if (!first) text_ += ", ";
      add(operand);
      first = false;
    }
    return *this;
  }

  Expr as(Level level) const { return {text_, level, written_}; }

 private:
  std::string text_;
  Written written_;
};

using Level = Text::Level;

Expr Expr::of(long long number, Where where) {
  return Text().add(fmt::format("{}", number), where).as(number < 0 ? Level::unary : Level::atom);
}

Expr Expr::of(double number, Where where) {
  if (!std::isfinite(number))
    throw SourceError(place_of(where), fmt::format("expected a finite number in an expression, found {}", number));
  return Text().add(fmt::format("{}", number), where).as(std::signbit(number) ? Level::unary : Level::atom);
}

Expr Expr::named(std::string name) { return {std::move(name), Level::atom, {}}; }

Expr Expr::operator[](int row) const {
  const std::string text = level_ < Level::postfix ? "(" + text_ + ")" : text_;
  Expr out{text + fmt::format("[{}]", row), Level::postfix, written_};
  if (level_ < Level::postfix)
    for (auto& [offset, place] : out.written_) ++offset;
  return out;
}

Expr Expr::operator()(int row, int column) const {
  Expr out = (*this)[row];
  out.text_.back() = ',';
  out.text_ += fmt::format(" {}]", column);
  return out;
}

namespace {

Text binary(const Operand& a, Level left, const char* sign, const Operand& b, Level right) {
  return Text().add(a, left).add(sign, a.where).add(b, right);
}

}  // namespace

Expr operator+(const Operand& a, const Operand& b) {
  return binary(a, Level::sum, " + ", b, Level::product).as(Level::sum);
}
Expr operator-(const Operand& a, const Operand& b) {
  return binary(a, Level::sum, " - ", b, Level::product).as(Level::sum);
}
Expr operator*(const Operand& a, const Operand& b) {
  return binary(a, Level::product, "*", b, Level::unary).as(Level::product);
}
Expr operator/(const Operand& a, const Operand& b) {
  return binary(a, Level::product, "/", b, Level::unary).as(Level::product);
}
Expr operator-(const Operand& a) { return Text().add("-", a.where).add(a, Level::unary).as(Level::unary); }
Expr pow(const Operand& base, const Operand& exponent) {
  return binary(base, Level::postfix, "^", exponent, Level::unary).as(Level::power);
}
Expr transpose(const Operand& a) { return Text().add(a, Level::postfix).add("'", a.where).as(Level::postfix); }

Inequality operator<(const Operand& a, const Operand& b) {
  return {binary(a, Level::sum, " < ", b, Level::sum).as(Level::sum)};
}
Inequality operator>(const Operand& a, const Operand& b) {
  return {binary(a, Level::sum, " > ", b, Level::sum).as(Level::sum)};
}

Expr call(const std::string& function, std::initializer_list<Operand> arguments, SourceLine where) {
  return Text().add(function + "(", where).list(arguments).add(")", where).as(Level::atom);
}

Expr vector(std::initializer_list<Operand> components, SourceLine where) {
  return Text().add("[", where).list(components).add("]", where).as(Level::atom);
}

Expr matrix(std::initializer_list<std::initializer_list<Operand>> rows, SourceLine where) {
  Text text;
  text.add("[", where);
  bool first = true;
  for (const auto& row : rows) {
    if (!first) text.add("; ", where);
    text.list(row);
    first = false;
  }
  return text.add("]", where).as(Level::atom);
}

}  // namespace ergon
