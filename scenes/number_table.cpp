#include "scenes/number_table.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include "scenes/comma_lines.h"

namespace ergon {
namespace {

NumberTable::Column named_column(const std::string& text, const Place& place) {
  const size_t open = text.find('(');
  NumberTable::Column out;
  out.name = trimmed(text.substr(0, open));
  if (open == std::string::npos) return out;
  if (text.back() != ')')
    throw SourceError(place, fmt::format("expected a column such as `E (kPa)`, found '{}'", text));
  out.unit_text = text.substr(open + 1, text.size() - open - 2);
  try {
    out.unit = parse_unit(out.unit_text);
  } catch (const std::invalid_argument& bad) {
    throw SourceError(place, fmt::format("column '{}': {}", out.name, bad.what()));
  }
  return out;
}

double number_in(const std::string& text, const Place& place) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    throw SourceError(place, fmt::format("expected a number, found '{}'", text));
  return value;
}

}  // namespace

const NumberTable::Column& NumberTable::column(const std::string& name) const {
  std::vector<std::string> names;
  for (const Column& column : columns) {
    if (column.name == name) return column;
    names.push_back(column.name);
  }
  throw SourceError({file, 1, 1}, fmt::format("there is no column '{}' (columns: {}){}", name, fmt::join(names, ", "),
                                              did_you_mean(name, names)));
}

NumberTable read_number_table(const std::string& file, const Place& place) {
  std::ifstream stream(file);
  if (!stream) throw SourceError(place, fmt::format("cannot open {}", file));
  NumberTable out;
  out.file = file;
  for (const CommaLine& line : comma_lines(stream)) {
    const Place at{file, line.number, 1};
    const std::vector<std::string>& words = line.cells;
    if (out.columns.empty()) {
      for (const std::string& word : words) out.columns.push_back(named_column(word, at));
      continue;
    }
    if (words.size() != out.columns.size())
      throw SourceError(at, fmt::format("expected {} values, found {}", out.columns.size(), words.size()));
    for (size_t i = 0; i < words.size(); ++i)
      out.columns[i].values.push_back(out.columns[i].unit.scale * number_in(words[i], at));
    out.lines.push_back(line.number);
  }
  if (out.lines.empty()) throw SourceError({file, 0, 0}, "holds no values");
  return out;
}

}  // namespace ergon
