#include "tools/matrix_market.h"

#include <fmt/format.h>
#include <iterator>

#include "runtime/output/atomic_file.h"

namespace ergon {

void write_matrix_market(const std::string& path, const Eigen::Matrix3Xd& vectors) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "%%MatrixMarket matrix array real general\n{} 1\n", vectors.size());
  for (Eigen::Index i = 0; i < vectors.size(); ++i) fmt::format_to(out, "{}\n", vectors.data()[i]);
  write_file(path, std::string_view(text.data(), text.size()));
}

void write_matrix_market(const std::string& path, const BlockMatrix& matrix) {
  const std::vector<int>& start = matrix.column_start();
  const std::vector<int>& rows = matrix.row_index();
  fmt::memory_buffer entries;
  auto out = std::back_inserter(entries);
  long count = 0;
  for (int column = 0; column < matrix.rows(); ++column) {
    for (int k = start[static_cast<size_t>(column)]; k < start[static_cast<size_t>(column) + 1]; ++k) {
      const int row = rows[static_cast<size_t>(k)];
      if (row < column) continue;  // above the diagonal in a diagonal block
      fmt::format_to(out, "{} {} {}\n", row + 1, column + 1, matrix.values()[static_cast<size_t>(k)]);
      ++count;
    }
  }
  fmt::memory_buffer text;
  fmt::format_to(std::back_inserter(text), "%%MatrixMarket matrix coordinate real symmetric\n{} {} {}\n", matrix.rows(),
                 matrix.rows(), count);
  text.append(entries);
  write_file(path, std::string_view(text.data(), text.size()));
}

}  // namespace ergon
