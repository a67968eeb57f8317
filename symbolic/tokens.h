#pragma once
// The words of an expression.

#include <string>
#include <vector>

#include "symbolic/statements.h"

namespace ergon {

struct Token {
  enum class Kind { number, name, sign, end };
  Kind kind;
  std::string text;  // "" at the end
  Place place;
  bool is(const char* sign) const { return kind == Kind::sign && text == sign; }
};

// How a token is called in a message: "'*'", "the number 2", "the end of the statement".
std::string to_string(const Token& token);

// The tokens of a statement from `offset` on, closed by one of kind `end`. Throws SourceError for characters that no
// expression has.
std::vector<Token> tokenise(const Statement& statement, size_t offset);

// The bytes of the UTF-8 character at `at`.
std::string character(std::string_view text, size_t at);

// The end of the identifier that starts at `offset`, or `offset` when none does.
size_t end_of_name(std::string_view text, size_t offset);

}  // namespace ergon
