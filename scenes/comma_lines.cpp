#include "scenes/comma_lines.h"

#include <algorithm>

namespace ergon {

std::string trimmed(const std::string& text) {
  constexpr const char* around = " \t\r\"";
  const size_t first = text.find_first_not_of(around);
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(around) - first + 1);
}

std::vector<CommaLine> comma_lines(std::istream& stream) {
  std::vector<CommaLine> out;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const std::string content = trimmed(line.substr(0, line.find('#')));
    if (content.empty()) continue;
    out.push_back({number, {}});
    for (size_t at = 0; at <= content.size();) {
      const size_t end = std::min(content.find(',', at), content.size());
      out.back().cells.push_back(trimmed(content.substr(at, end - at)));
      at = end + 1;
    }
  }
  return out;
}

}  // namespace ergon
