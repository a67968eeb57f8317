#include "tools/matrix_market.h"

#include <fmt/format.h>
#include <cstdio>
#include <filesystem>
#include <iterator>

#include "runtime/error.h"

namespace ergon {
namespace {

// Writes beside the path and moves it there when it is complete.
void write_whole(const std::string& path, const fmt::memory_buffer& text) {
  const std::string part = path + ".part";
  std::FILE* file = std::fopen(part.c_str(), "w");
  bool good = file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size();
  if (file != nullptr) good = std::fclose(file) == 0 && good;
  std::error_code error;
  if (good) std::filesystem::rename(part, path, error);
  if (good && !error) return;
  std::filesystem::remove(part, error);
  throw InputError(fmt::format("{}: cannot be written; is the folder there, writable, and not full?", path));
}

}  // namespace

void write_matrix_market(const std::string& path, const Eigen::Matrix3Xd& vectors) {
  fmt::memory_buffer text;
  auto out = std::back_inserter(text);
  fmt::format_to(out, "%%MatrixMarket matrix array real general\n{} 1\n", vectors.size());
  for (Eigen::Index i = 0; i < vectors.size(); ++i) fmt::format_to(out, "{}\n", vectors.data()[i]);
  write_whole(path, text);
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
  write_whole(path, text);
}

}  // namespace ergon
