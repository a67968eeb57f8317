#include <algorithm>
#include <cstdint>
#include <numeric>

#include "runtime/mesh/mesh_tools.h"

namespace ergon {
namespace {

constexpr int kBits = 16;  // per axis: 48-bit keys

// Position along the Hilbert curve of a point of the 2^kBits grid. Skilling 2004, Programming the Hilbert curve,
// AIP Conference Proceedings 707, 381: axes to transposed index, then interleaved.
std::uint64_t hilbert_key(std::array<std::uint32_t, 3> x) {
  const std::uint32_t top = 1U << (kBits - 1);
  for (std::uint32_t q = top; q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (std::uint32_t& coordinate : x) {
      if (coordinate & q) {
        x[0] ^= p;
      } else {
        const std::uint32_t t = (x[0] ^ coordinate) & p;
        x[0] ^= t;
        coordinate ^= t;
      }
    }
  }
  x[1] ^= x[0];
  x[2] ^= x[1];
  std::uint32_t t = 0;
  for (std::uint32_t q = top; q > 1; q >>= 1) {
    if (x[2] & q) t ^= q - 1;
  }
  for (std::uint32_t& coordinate : x) coordinate ^= t;
  std::uint64_t key = 0;
  for (int bit = kBits - 1; bit >= 0; --bit) {
    for (const std::uint32_t coordinate : x) key = (key << 1) | ((coordinate >> bit) & 1U);
  }
  return key;
}

}  // namespace

ReorderedMesh spatial_order(const Mesh& mesh) {
  const size_t nodes = static_cast<size_t>(nodes_of(mesh.element));
  const size_t cells = mesh.cells.size() / nodes;
  Eigen::Matrix3Xd centres(3, static_cast<Eigen::Index>(cells));
  for (size_t c = 0; c < cells; ++c) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (size_t i = 0; i < nodes; ++i) sum += mesh.X.col(mesh.cells[c * nodes + i]);
    centres.col(static_cast<Eigen::Index>(c)) = sum / static_cast<double>(nodes);
  }
  std::vector<std::uint64_t> keys(cells, 0);
  if (cells > 0) {
    const Eigen::Vector3d lower = centres.rowwise().minCoeff();
    const double extent = (centres.rowwise().maxCoeff() - lower).maxCoeff();
    const double scale = extent > 0 ? ((1U << kBits) - 1) / extent : 0;
    for (size_t c = 0; c < cells; ++c) {
      const Eigen::Vector3d grid = (centres.col(static_cast<Eigen::Index>(c)) - lower) * scale;
      keys[c] = hilbert_key({static_cast<std::uint32_t>(grid.x()), static_cast<std::uint32_t>(grid.y()),
                             static_cast<std::uint32_t>(grid.z())});
    }
  }
  ReorderedMesh result;
  result.cell_from.resize(cells);
  std::iota(result.cell_from.begin(), result.cell_from.end(), 0);
  std::stable_sort(result.cell_from.begin(), result.cell_from.end(),
                   [&](int a, int b) { return keys[static_cast<size_t>(a)] < keys[static_cast<size_t>(b)]; });

  std::vector<int> new_number(static_cast<size_t>(mesh.vertices()), -1);
  const auto visit = [&](int vertex) {
    int& number = new_number[static_cast<size_t>(vertex)];
    if (number < 0) {
      number = static_cast<int>(result.vertex_from.size());
      result.vertex_from.push_back(vertex);
    }
    return number;
  };
  result.mesh.element = mesh.element;
  result.mesh.source = mesh.source;
  result.mesh.cells.reserve(mesh.cells.size());
  for (const int cell : result.cell_from) {
    for (size_t i = 0; i < nodes; ++i) {
      result.mesh.cells.push_back(visit(mesh.cells[static_cast<size_t>(cell) * nodes + i]));
    }
  }
  for (int vertex = 0; vertex < mesh.vertices(); ++vertex) visit(vertex);
  result.mesh.X.resize(3, mesh.vertices());
  for (int i = 0; i < mesh.vertices(); ++i)
    result.mesh.X.col(i) = mesh.X.col(result.vertex_from[static_cast<size_t>(i)]);
  return result;
}

}  // namespace ergon
