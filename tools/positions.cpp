#include "tools/positions.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "runtime/error.h"

namespace ergon {

Eigen::Matrix3Xd read_positions(const std::string& path, int vertices) {
  std::ifstream file(path);
  if (!file)
    throw InputError(fmt::format("{}: cannot be read; a text file with one 'x y z' per vertex is wanted", path));
  Eigen::Matrix3Xd x(3, vertices);
  std::string text;
  int count = 0;
  for (int line = 1; std::getline(file, text); ++line) {
    text.erase(std::min(text.find('#'), text.size()));
    std::istringstream words(text);
    std::string word;
    int column = 0;
    for (; words >> word; ++column) {
      size_t used = 0;
      double value = std::nan("");
      try {
        value = std::stod(word, &used);
      } catch (const std::exception&) {
        used = 0;
      }
      if (used != word.size() || !std::isfinite(value)) {
        throw InputError(fmt::format("{}:{}: '{}' is not a finite number", path, line, word));
      }
      if (column < 3 && count < vertices) x(column, count) = value;
    }
    if (column == 0) continue;
    if (column != 3) throw InputError(fmt::format("{}:{}: {} numbers, a vertex has 3", path, line, column));
    ++count;
  }
  if (count != vertices) throw InputError(fmt::format("{}: {} vertices, the mesh has {}", path, count, vertices));
  return x;
}

}  // namespace ergon
