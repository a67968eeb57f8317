#include "symbolic/expression_parser.h"

#include "symbolic/other_names.h"

namespace ergon {
namespace {

using Kind = Expression::Kind;

constexpr int nesting_limit = 200;

ExpressionPtr node(Kind kind, const Token& at, std::vector<ExpressionPtr> arguments, std::string text = "") {
  auto e = std::make_shared<Expression>();
  e->kind = kind;
  e->text = std::move(text);
  e->arguments = std::move(arguments);
  e->place = at.place;
  return e;
}

struct Operator {
  Kind kind;
  int precedence;
};

bool binary_operator(const Token& token, Operator& op) {
  if (token.is("+")) return op = {Kind::add, 1}, true;
  if (token.is("-")) return op = {Kind::subtract, 1}, true;
  if (token.is("*")) return op = {Kind::multiply, 2}, true;
  if (token.is("/")) return op = {Kind::divide, 2}, true;
  return false;
}

}  // namespace

Token ExpressionParser::take() {
  const Token token = tokens_[at_];
  if (token.kind != Token::Kind::end) ++at_;
  return token;
}

Token ExpressionParser::take_name(const char* what) {
  if (next().kind != Token::Kind::name)
    throw SourceError(next().place, std::string("expected ") + what + ", found " + to_string(next()));
  return take();
}

void ExpressionParser::take_sign(const char* sign, const char* where) {
  if (!next().is(sign))
    throw SourceError(next().place, std::string("expected '") + sign + "' " + where + ", found " + to_string(next()));
  take();
}

void ExpressionParser::finish() {
  const Token& token = next();
  if (token.kind == Token::Kind::end) return;
  std::string message = "expected an operator or the end of the statement, found " + to_string(token);
  message += token.kind != Token::Kind::sign ? "; products are written with '*'" : sign_elsewhere(token.text);
  if (token.is(")") || token.is("]")) message = "found " + to_string(token) + " without its opening bracket";
  if (token.is("=")) message += "; names are given by `let`";
  if (token.is("<") || token.is(">")) message += "; comparisons belong to `active` and `require`";
  throw SourceError(token.place, message);
}

ExpressionPtr ExpressionParser::expression() { return binary(1); }

ExpressionPtr ExpressionParser::binary(int least_precedence) {
  ExpressionPtr left = unary();
  Operator op;
  while (binary_operator(next(), op) && op.precedence >= least_precedence) {
    const Token token = take();
    ExpressionPtr right = binary(op.precedence + 1);
    left = node(op.kind, token, {left, right});
  }
  return left;
}

ExpressionPtr ExpressionParser::unary() {
  if (++depth_ > nesting_limit)
    throw SourceError(next().place, "more than " + std::to_string(nesting_limit) +
                                        " nested operations; name parts of the expression with `let`");
  ExpressionPtr result;
  if (next().is("-")) {
    const Token minus = take();
    result = node(Kind::negate, minus, {unary()});
  } else {
    result = postfix();
    if (next().is("^")) {
      const Token power = take();
      result = node(Kind::power, power, {result, unary()});
    }
  }
  --depth_;
  return result;
}

ExpressionPtr ExpressionParser::postfix() {
  ExpressionPtr result = primary();
  for (;;) {
    if (next().is("'")) {
      result = node(Kind::transpose, take(), {result});
    } else if (next().is("[")) {
      const Token open = take();
      auto index = std::make_shared<Expression>();
      index->kind = Kind::index;
      index->place = open.place;
      index->arguments = {result};
      index_list(*index);
      result = index;
    } else {
      return result;
    }
  }
}

void ExpressionParser::index_list(Expression& index) {
  for (;;) {
    const Token& token = next();
    if (token.kind != Token::Kind::number || token.text.find_first_not_of("0123456789") != std::string::npos ||
        token.text.size() > 3) {
      throw SourceError(token.place, "expected an index, a whole number counted from 0, found " +
                                         (token.kind == Token::Kind::number ? token.text : to_string(token)));
    }
    index.arguments.push_back(node(Kind::number, token, {}, token.text));
    take();
    if (index.arguments.size() == 3 || !next().is(",")) break;
    take();
  }
  take_sign("]", "to close the index");
}

ExpressionPtr ExpressionParser::primary() {
  const Token token = take();
  switch (token.kind) {
    case Token::Kind::number:
      return node(Kind::number, token, {}, token.text);
    case Token::Kind::name:
      return next().is("(") ? call(token) : node(Kind::name, token, {}, token.text);
    default:
      break;
  }
  if (token.is("(")) {
    ExpressionPtr inside = expression();
    take_sign(")", "to close the bracket");
    return inside;
  }
  if (token.is("[")) return bracket(token);
  throw SourceError(token.place, "expected a number, a name or '(', found " + to_string(token));
}

ExpressionPtr ExpressionParser::call(const Token& name) {
  take();  // "("
  std::vector<ExpressionPtr> arguments;
  if (!next().is(")")) {
    arguments.push_back(expression());
    while (next().is(",")) {
      take();
      arguments.push_back(expression());
    }
  }
  take_sign(")", ("to close the call of '" + name.text + "'").c_str());
  return node(Kind::call, name, std::move(arguments), name.text);
}

ExpressionPtr ExpressionParser::bracket(const Token& open) {
  auto literal = std::make_shared<Expression>();
  literal->kind = Kind::literal;
  literal->place = open.place;
  std::vector<int> rows = {0};
  for (;;) {
    literal->arguments.push_back(expression());
    ++rows.back();
    if (next().is(";")) {
      rows.push_back(0);
    } else if (!next().is(",")) {
      break;
    }
    const Token separator = take();
    if (rows.back() == 0 && rows.size() > 1 && rows[rows.size() - 2] != rows.front())
      throw SourceError(separator.place, "a row of " + std::to_string(rows[rows.size() - 2]) +
                                             " in a matrix whose first row has " + std::to_string(rows.front()));
  }
  if (rows.back() != rows.front())
    throw SourceError(next().place, "a row of " + std::to_string(rows.back()) + " in a matrix whose first row has " +
                                        std::to_string(rows.front()));
  take_sign("]", "to close the list");
  // A single row is a vector; so is a single column.
  literal->shape = rows.size() == 1 ? Shape{rows.front(), 1} : Shape{static_cast<int>(rows.size()), rows.front()};
  return literal;
}

}  // namespace ergon
