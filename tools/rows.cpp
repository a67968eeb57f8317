#include "tools/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>

namespace ergon {
namespace {

std::string cell(const Row& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_float()) return fmt::format("{:.4g}", value.get<double>());
  return value.dump();
}

}  // namespace

void Rows::add(const Row& row) {
  if (json_) {
    out_ << row.dump() << std::endl;
    return;
  }
  const bool first = widths_.empty();
  std::string head, line;
  size_t column = 0;
  for (const auto& [name, value] : row.items()) {
    const std::string text = cell(value);
    if (first) widths_.push_back(std::max({name.size(), text.size(), value.is_string() && column == 0 ? 24ul : 8ul}));
    const size_t width = widths_[column++];
    head += value.is_string() ? fmt::format("{:<{}}  ", name, width) : fmt::format("{:>{}}  ", name, width);
    line += value.is_string() ? fmt::format("{:<{}}  ", text, width) : fmt::format("{:>{}}  ", text, width);
  }
  if (first) out_ << head.substr(0, head.find_last_not_of(' ') + 1) << '\n';
  out_ << line.substr(0, line.find_last_not_of(' ') + 1) << std::endl;
}

}  // namespace ergon
