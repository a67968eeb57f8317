#include "symbolic/tokens.h"

#include <string_view>

#include "symbolic/other_names.h"

namespace ergon {
namespace {

constexpr size_t token_limit = 4000;  // bounds the depth of the tree, and with it the stack that walking it takes

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

size_t skip_digits(std::string_view text, size_t at) {
  while (at < text.size() && is_digit(text[at])) ++at;
  return at;
}

size_t end_of_number(const Statement& statement, size_t start) {
  const std::string_view text = statement.text;
  size_t at = skip_digits(text, start);
  if (at < text.size() && text[at] == '.') {
    const size_t fraction = at + 1;
    at = skip_digits(text, fraction);
    if (at == fraction) throw SourceError(statement.place(start), "expected digits on both sides of the decimal point");
  }
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    size_t exponent = at + 1;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    const size_t end = skip_digits(text, exponent);
    if (end == exponent || end - exponent > 4)
      throw SourceError(statement.place(at), "expected a power of ten of one to four digits, such as 1e-6");
    at = end;
  }
  if (at < text.size() && is_letter(text[at])) {
    throw SourceError(statement.place(at), "expected an operator after the number " +
                                               std::string(text.substr(start, at - start)) + ", found '" +
                                               std::string(text.substr(at, end_of_name(text, at) - at)) +
                                               "'; products are written with '*'");
  }
  return at;
}

}  // namespace

std::string character(std::string_view text, size_t at) {
  size_t end = at + 1;
  while (end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) ++end;
  return std::string(text.substr(at, end - at));
}

size_t end_of_name(std::string_view text, size_t offset) {
  if (offset >= text.size() || !is_letter(text[offset])) return offset;
  while (offset < text.size() && (is_letter(text[offset]) || is_digit(text[offset]))) ++offset;
  return offset;
}

std::string to_string(const Token& token) {
  switch (token.kind) {
    case Token::Kind::number:
      return "the number " + token.text;
    case Token::Kind::end:
      return "the end of the statement";
    default:
      return "'" + token.text + "'";
  }
}

std::vector<Token> tokenise(const Statement& statement, size_t offset) {
  const std::string_view text = statement.text;
  std::vector<Token> tokens;
  size_t at = offset;
  while (at < text.size()) {
    const char c = text[at];
    if (c == ' ' || c == '\t') {
      ++at;
      continue;
    }
    const Place place = statement.place(at);
    if (tokens.size() == token_limit)
      throw SourceError(
          place, "the statement has more than " + std::to_string(token_limit) + " words; name parts of it with `let`");
    Token::Kind kind = Token::Kind::sign;
    size_t end = at + 1;
    if (is_digit(c)) {
      kind = Token::Kind::number;
      end = end_of_number(statement, at);
    } else if (is_letter(c)) {
      kind = Token::Kind::name;
      end = end_of_name(text, at);
    } else if (text.substr(at, 2) == "**") {
      throw SourceError(place, "found '**'; powers are written with '^'");
    } else if (text.substr(at, 2) == "<=" || text.substr(at, 2) == ">=") {
      throw SourceError(place,
                        "found '" + std::string(text.substr(at, 2)) + "'; conditions are strict, write '" + c + "'");
    } else if (c == '.') {
      throw SourceError(place, "expected digits on both sides of the decimal point");
    } else if (std::string_view("+-*/^'()[],;=<>").find(c) == std::string_view::npos) {
      const std::string found = character(text, at);
      throw SourceError(place, "found '" + found + "', which has no meaning in an expression" + sign_elsewhere(found));
    }
    tokens.push_back({kind, std::string(text.substr(at, end - at)), place});
    at = end;
  }
  tokens.push_back({Token::Kind::end, "", statement.place(text.size())});
  return tokens;
}

}  // namespace ergon
