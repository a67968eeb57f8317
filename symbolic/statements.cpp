#include "symbolic/statements.h"

namespace ergon {
namespace {

constexpr std::string_view blanks = " \t\r\f\v";

std::string_view trim(std::string_view s) {
  const size_t first = s.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(blanks) - first + 1);
}

}  // namespace

Place Statement::place(size_t offset) const {
  size_t line = 0;
  while (line + 1 < lines.size() && lines[line + 1].first <= offset) ++line;
  Place p = lines[line].second;
  if (p.column == 0) return p;
  for (size_t i = lines[line].first; i < offset; ++i) {
    const bool inside_a_character = i < text.size() && (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80;
    p.column += inside_a_character ? 0 : 1;
  }
  return p;
}

Statements split_statements(std::string_view text, const std::string& file) {
  Statements result;
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  for (int line = 1; !text.empty(); ++line) {
    const size_t end = text.find('\n');
    const std::string_view full = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);

    const size_t hash = full.find('#');
    if (hash != std::string_view::npos && result.all.empty() && trim(full.substr(0, hash)).empty()) {
      const std::string_view comment = trim(full.substr(hash + 1));
      if (!result.summary.empty() && !comment.empty()) result.summary += ' ';
      result.summary += comment;
    }
    const std::string_view content = trim(full.substr(0, hash));
    if (content.empty()) continue;

    const Place place{file, line, static_cast<int>(content.data() - full.data()) + 1};
    if (place.column == 1) {
      result.all.push_back({});
    } else if (result.all.empty()) {
      throw SourceError(place,
                        "an indented line continues the statement above it, and there is none; start it in the first "
                        "column");
    } else {
      result.all.back().text += ' ';
    }
    Statement& statement = result.all.back();
    statement.lines.emplace_back(statement.text.size(), place);
    statement.text += content;
  }
  return result;
}

}  // namespace ergon
