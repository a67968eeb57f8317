#include "symbolic/declaration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "symbolic/tokens.h"

namespace ergon {
namespace {

constexpr int dimension_limit = 9;

struct Word {
  std::string_view text;
  size_t offset;
};

class DeclarationReader {
 public:
  DeclarationReader(const Statement& statement, size_t offset, Role role)
      : statement_(statement), text_(statement.text), at_(offset), role_(role) {}

  std::vector<Symbol> read() {
    std::vector<Symbol> symbols = {name()};
    for (;;) {
      const Word word = peek();
      if (word.text.empty()) fail(word.offset, no_unit(symbols.back().name, "the end of the statement"));
      if (reads_as_unit(word.text)) break;
      if (!reads_as_name(word.text)) explain_unit(word);
      if (!unit_follows(word)) explain_unit(intended_unit());
      symbols.push_back(name());
    }
    const Word unit_word = take();
    check_ambiguity(unit_word);
    const Unit unit = si_unit(unit_word);
    Range range;
    if (at_ < text_.size() && (text_[at_] == '(' || text_[at_] == '[')) range = this->range();
    const std::string help(text_.substr(at_));
    if (!help.empty() && std::string_view("<>=").find(help[0]) != std::string_view::npos)
      fail(at_, fmt::format("expected a range such as (0, inf), [0, 1] or (-1, 1/2), found '{}'", peek().text));
    for (Symbol& symbol : symbols) {
      symbol.unit = unit;
      symbol.range = range;
      symbol.help = help;
    }
    return symbols;
  }

 private:
  [[noreturn]] void fail(size_t offset, const std::string& message) const {
    throw SourceError(statement_.place(offset), message);
  }

  std::string no_unit(const std::string& name, const std::string& found) const {
    return fmt::format("expected the unit of '{}', found {}; a pure number has the unit 1", name, found);
  }

  void skip_blanks() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }

  Word word_at(size_t offset) const {
    while (offset < text_.size() && (text_[offset] == ' ' || text_[offset] == '\t')) ++offset;
    size_t end = std::min(text_.find_first_of(" \t", offset), text_.size());
    const size_t shape = text_.find('[', offset);  // "A[3, 3]" is one word
    if (shape < end && shape > offset) end = std::max(end, std::min(text_.find(']', shape), text_.size() - 1) + 1);
    return {text_.substr(offset, end - offset), offset};
  }

  Word peek() const { return word_at(at_); }

  Word take() {
    const Word word = peek();
    at_ = word.offset + word.text.size();
    skip_blanks();
    return word;
  }

  static bool reads_as_unit(std::string_view word) {
    try {
      parse_unit(word);
      return true;
    } catch (const std::invalid_argument&) {
      return false;
    }
  }

  static bool reads_as_name(std::string_view word) {
    const size_t end = end_of_name(word, 0);
    return end > 0 && (end == word.size() || word[end] == '[');
  }

  static bool opens_range(std::string_view word) { return word.starts_with("(") || word.starts_with("["); }

  // Where no word reads as a unit: the one before the range, else the one behind the first name.
  Word intended_unit() const {
    const Word first = word_at(first_end_);
    for (Word word = first; reads_as_name(word.text);) {
      const Word next = word_at(word.offset + word.text.size());
      if (opens_range(next.text)) return word;
      word = next;
    }
    return first;
  }

  // Whether a unit stands behind this word before anything that is neither name nor unit.
  bool unit_follows(Word word) const {
    while (!word.text.empty()) {
      word = word_at(word.offset + word.text.size());
      if (reads_as_unit(word.text)) return true;
      if (!reads_as_name(word.text)) return false;
    }
    return false;
  }

  [[noreturn]] void explain_unit(const Word& word) const {
    if (opens_range(word.text))
      fail(word.offset, no_unit(std::string(text_.substr(start_, end_of_name(text_, start_) - start_)),
                                fmt::format("'{}'", word.text)));
    try {
      parse_unit(word.text);
    } catch (const std::invalid_argument& error) {
      const std::string message = error.what();
      const bool told = message.find(';') != std::string::npos || message.find("expected") != std::string::npos;
      fail(word.offset, told ? message : message + "; a declaration is written NAMES UNIT [RANGE] [HELP]");
    }
    throw std::logic_error("a unit was expected to be unknown");
  }

  Symbol name() {
    skip_blanks();
    const size_t start = at_;
    const size_t end = end_of_name(text_, start);
    if (end == start) {
      const Word word = peek();
      fail(start, word.text.empty() ? "expected a name to declare, found the end of the statement"
                                    : fmt::format("expected a name to declare, found '{}'", word.text));
    }
    Symbol symbol;
    symbol.name = text_.substr(start, end - start);
    symbol.role = role_;
    symbol.shape = role_ == Role::dof ? Shape{3, 1} : Shape{};
    symbol.place = statement_.place(start);
    at_ = end;
    if (at_ < text_.size() && text_[at_] == '[') {
      ++at_;
      symbol.shape.rows = dimension();
      skip_blanks();
      symbol.shape.cols = 1;
      if (at_ < text_.size() && text_[at_] == ',') {
        ++at_;
        symbol.shape.cols = dimension();
        skip_blanks();
      }
      if (at_ >= text_.size() || text_[at_] != ']') fail(at_, "expected ']' to close the shape");
      ++at_;
    }
    if (at_ < text_.size() && text_[at_] != ' ' && text_[at_] != '\t')
      fail(at_, fmt::format("expected a blank after the name '{}', found '{}'", symbol.name, character(text_, at_)));
    skip_blanks();
    if (first_end_ == 0) {
      start_ = start;
      first_end_ = at_;
    }
    return symbol;
  }

  int dimension() {
    skip_blanks();
    int value = 0;
    const size_t start = at_;
    while (at_ < text_.size() && at_ - start < 2 && text_[at_] >= '0' && text_[at_] <= '9')
      value = 10 * value + (text_[at_++] - '0');
    if (value < 1 || value > dimension_limit)
      fail(start, fmt::format("expected a dimension from 1 to {}, as in [3] or [3,3]", dimension_limit));
    return value;
  }

  Unit si_unit(const Word& word) const {
    const ScaledUnit unit = parse_unit(word.text);
    if (unit.scale != 1)
      fail(word.offset, fmt::format("expected an SI unit without prefix, found '{}'; write '{}' (values in a scene may "
                                    "still be given in {})",
                                    word.text, to_string(unit.unit), word.text));
    return unit.unit;
  }

  Range range() {
    const size_t start = at_;
    Range range;
    range.lower_open = text_[at_++] == '(';
    range.lower = bound(start);
    if (at_ >= text_.size() || text_[at_] != ',') bad_range(start);
    ++at_;
    range.upper = bound(start);
    if (at_ >= text_.size() || (text_[at_] != ')' && text_[at_] != ']')) bad_range(start);
    range.upper_open = text_[at_++] == ')';
    const std::string written(text_.substr(start, at_ - start));
    if (range.lower == range.upper) fail(start, fmt::format("the range {} is empty", written));
    if (range.lower > range.upper) fail(start, fmt::format("the range {} is reversed", written));
    skip_blanks();
    return range;
  }

  [[noreturn]] void bad_range(size_t start) const {
    fail(start, "expected a range such as (0, inf), [0, 1] or (-1, 1/2); a help text does not start with a bracket");
  }

  double number(size_t start) {
    skip_blanks();
    const std::string rest(text_.substr(at_, 64));
    const bool minus = rest.starts_with("-");
    if (rest.substr(minus, 3) == "inf") {
      at_ += minus ? 4 : 3;
      return minus ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
    }
    if (rest.size() <= static_cast<size_t>(minus) || rest[minus] < '0' || rest[minus] > '9') bad_range(start);
    char* end = nullptr;
    const double value = std::strtod(rest.c_str(), &end);
    at_ += static_cast<size_t>(end - rest.c_str());
    skip_blanks();
    return value;
  }

  double bound(size_t start) {
    double value = number(start);
    if (at_ < text_.size() && text_[at_] == '/') {
      ++at_;
      value /= number(start);
    }
    skip_blanks();
    return value;
  }

  // `dof s t m`: "t" (tonne) would be taken as the unit.
  void check_ambiguity(const Word& unit) const {
    const Word next = peek();
    if (next.text.empty() || !reads_as_name(unit.text) || !reads_as_unit(next.text)) return;
    const Word behind = word_at(next.offset + next.text.size());
    if (!behind.text.empty() && !opens_range(behind.text)) return;
    fail(unit.offset,
         fmt::format("'{}' may be a name or the unit; declare each name in a statement of its own", unit.text));
  }

  const Statement& statement_;
  std::string_view text_;
  size_t at_;
  size_t start_ = 0;      // of the first name
  size_t first_end_ = 0;  // behind the first name
  Role role_;
};

}  // namespace

std::string_view to_string(Role role) {
  switch (role) {
    case Role::dof:
      return "dof";
    case Role::param:
      return "param";
    case Role::rest:
      return "rest";
    default:
      return "lag";
  }
}

std::vector<Symbol> parse_declaration(const Statement& statement, size_t offset, Role role) {
  return DeclarationReader(statement, offset, role).read();
}

}  // namespace ergon
