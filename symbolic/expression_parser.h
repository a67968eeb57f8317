#pragma once
// Expressions by operator precedence (Pratt): postfix ' and [ ], then ^ (to the right), unary -, * and /, + and -.

#include <vector>

#include "symbolic/expression.h"
#include "symbolic/tokens.h"

namespace ergon {

class ExpressionParser {
 public:
  explicit ExpressionParser(std::vector<Token> tokens) : tokens_(std::move(tokens)) {}

  // All of these throw SourceError saying what was found and what was expected.
  ExpressionPtr expression();
  Token take_name(const char* what);  // `what` completes "expected ..."
  void take_sign(const char* sign, const char* where);
  void finish();  // nothing may follow

  const Token& next() const { return tokens_[at_]; }
  Token take();

 private:
  ExpressionPtr binary(int least_precedence);
  ExpressionPtr unary();
  ExpressionPtr postfix();
  ExpressionPtr primary();
  ExpressionPtr call(const Token& name);
  ExpressionPtr bracket(const Token& open);
  void index_list(Expression& node);

  std::vector<Token> tokens_;
  size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace ergon
