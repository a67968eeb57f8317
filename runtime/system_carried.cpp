// Carried vertices: whose degrees of freedom they have, and the way of Hessians from pairs of vertices to the matrix,
// J^T H J, chunk by chunk. Chunks without carried vertices go the direct way.

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "runtime/error.h"
#include "runtime/system_data.h"

namespace ergon {
namespace {

using PairKey = std::uint64_t;

PairKey key_of(int high, int low) {
  return static_cast<PairKey>(high) << 32 | static_cast<PairKey>(static_cast<unsigned>(low));
}
int high_of(PairKey key) { return static_cast<int>(key >> 32); }
int low_of(PairKey key) { return static_cast<int>(key & 0xffffffffU); }

// Adds `scale` times a block, column by column.
void add_scaled(const double* block, double scale, double* place, int stride) {
  for (int c = 0; c < 3; ++c, block += 3, place += stride) {
    for (int r = 0; r < 3; ++r) place[r] += scale * block[r];
  }
}

struct Turnable {
  double as_it_is[9], turned[9];
  explicit Turnable(const double* block) {
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) as_it_is[3 * c + r] = turned[3 * r + c] = block[3 * c + r];
    }
  }
};

}  // namespace

VertexBlocks SystemNumbers::blocks_of(int number) const {
  if (carried(number)) {
    const CarriedVertex& vertex = carriers.carried()[static_cast<size_t>(number - free)];
    return {first_block[static_cast<size_t>(vertex.body)], 4, vertex.weights};
  }
  const int body = body_of_block[static_cast<size_t>(number)];
  if (body < 0) return {number, 1, {1, 0, 0, 0}};
  VertexBlocks control{first_block[static_cast<size_t>(body)], 4, {0, 0, 0, 0}};
  control.weights[static_cast<size_t>(number - control.first)] = 1;
  return control;
}

void System::set_carriers(Carriers carriers) {
  std::vector<char> taken(impl->fixed.begin(), impl->fixed.end());
  for (const CarriedVertex& v : carriers.carried()) {
    if (v.vertex < 0 || v.vertex >= vertices() || taken[static_cast<size_t>(v.vertex)] != 0) {
      throw InputError(fmt::format("vertex {} cannot be carried: it is fixed, carried or not there", v.vertex));
    }
    taken[static_cast<size_t>(v.vertex)] = 1;
  }
  for (int body = 0; body < carriers.bodies(); ++body) {
    for (int v = carriers.first_control(body); v < carriers.first_control(body) + 4; ++v) {
      if (v >= 0 && v < vertices() && taken[static_cast<size_t>(v)] == 0) continue;
      throw InputError(fmt::format("vertex {} cannot be a control point: it is fixed, carried or not there", v));
    }
  }
  impl->numbers.carriers = std::move(carriers);
  impl->number_vertices();
}

const Carriers& System::carriers() const { return impl->numbers.carriers; }

void System::Impl::number_vertices() {
  SystemNumbers& n = numbers;
  n.number.assign(fixed.size(), 0);
  for (const CarriedVertex& v : n.carriers.carried()) n.number[static_cast<size_t>(v.vertex)] = -1;
  n.free = 0;
  n.block_of.resize(fixed.size());
  for (size_t v = 0; v < fixed.size(); ++v) n.block_of[v] = fixed[v] != 0 || n.number[v] < 0 ? -1 : n.free++;
  n.number = n.block_of;
  n.lead.clear();
  n.first_block.clear();
  n.body_of_block.clear();
  if (!n.carriers.empty()) {
    n.body_of_block.assign(static_cast<size_t>(n.free), -1);
    n.lead.resize(fixed.size());
    for (size_t v = 0; v < fixed.size(); ++v) n.lead[v] = static_cast<int>(v);
    for (int body = 0; body < n.carriers.bodies(); ++body) {
      const int first = n.carriers.first_control(body);
      n.first_block.push_back(n.block_of[static_cast<size_t>(first)]);
      std::fill_n(n.lead.begin() + first, 4, first);
      std::fill_n(n.body_of_block.begin() + n.first_block.back(), 4, body);
    }
    int next = n.free;
    for (const CarriedVertex& v : n.carriers.carried()) {
      n.number[static_cast<size_t>(v.vertex)] = next++;
      n.lead[static_cast<size_t>(v.vertex)] = n.carriers.first_control(v.body);
    }
  }
  for (SystemTerm& term : terms) term.coloured_stencils = 0;
  ++fixed_version;
  pattern = nullptr;
  base_known = false;
}

// From `count` pairs of numbers in room.row and room.column to the matrix blocks that they become.
void SystemTerm::carry_pairs(const SystemRoom& room, int count, const SystemNumbers& numbers, SystemChunk& part) {
  std::vector<PairKey> together;  // first blocks of pairs, once each
  std::vector<int> sizes;
  const auto pairs = static_cast<size_t>(count);
  part.pairs.resize(pairs);
  std::vector<PairKey> keys(pairs);
  for (size_t i = 0; i < pairs; ++i) {
    const VertexBlocks u = numbers.blocks_of(room.row[i]), v = numbers.blocks_of(room.column[i]);
    const bool turned = u.first < v.first;
    const VertexBlocks &high = turned ? v : u, &low = turned ? u : v;
    part.pairs[i] = {
        0,          high.count, low.count, turned, high.first == low.first, room.row[i] == room.column[i], high.weights,
        low.weights};
    keys[i] = key_of(high.first, low.first);
  }
  together = keys;
  std::sort(together.begin(), together.end());
  together.erase(std::unique(together.begin(), together.end()), together.end());

  // Their matrix blocks, by column and then row, and where each is in that order.
  std::vector<int> first(together.size());
  std::vector<PairKey> blocks;
  for (size_t i = 0; i < pairs; ++i) {
    const auto at = std::lower_bound(together.begin(), together.end(), keys[i]) - together.begin();
    part.pairs[i].first = static_cast<int>(at);
    first[static_cast<size_t>(at)] = static_cast<int>(i);
  }
  for (size_t k = 0; k < together.size(); ++k) {
    const CarriedPair& pair = part.pairs[static_cast<size_t>(first[k])];
    first[k] = static_cast<int>(blocks.size());
    for (int a = 0; a < pair.rows; ++a) {
      for (int b = 0; b < (pair.triangle ? a + 1 : pair.columns); ++b) {
        blocks.push_back(key_of(low_of(together[k]) + b, high_of(together[k]) + a));
      }
    }
  }
  for (CarriedPair& pair : part.pairs) pair.first = first[static_cast<size_t>(pair.first)];
  std::vector<PairKey> sorted = blocks;
  std::sort(sorted.begin(), sorted.end());
  part.places.resize(blocks.size());
  for (size_t k = 0; k < blocks.size(); ++k) {
    part.places[k] = static_cast<int>(std::lower_bound(sorted.begin(), sorted.end(), blocks[k]) - sorted.begin());
  }
  part.row.clear();
  part.column.clear();
  for (const PairKey block : sorted) {
    part.row.push_back(low_of(block));
    part.column.push_back(high_of(block));
  }
}

void System::Impl::add_chunk(SystemTerm& term, int chunk, Projection projection, SystemRoom& room, double* gradients,
                             double* values, lanes::ChunkResult* result) {
  const SystemChunk& part = term.parts[static_cast<size_t>(chunk)];
  const bool direct = part.pairs.empty();
  const lanes::ChunkBlocks pairs{static_cast<int>(part.pairs.size()), pair_offset.data(), pair_stride.data()};
  term.operations->hessian(term.stencils, term.range(chunk), direct ? term.blocks(chunk) : pairs, points_of(term),
                           static_cast<int>(projection), room.view(), gradients,
                           direct ? values : room.pair_blocks.data(), result);
  if (direct) return;
  for (size_t k = 0; k < part.row.size(); ++k) {
    if (part.stride[k] >= 0) continue;
    for (int c = 0; c < 3; ++c)
      std::fill_n(values + part.offset[k] - static_cast<ptrdiff_t>(c) * part.stride[k], 3, 0.0);
  }
  for (size_t i = 0; i < part.pairs.size(); ++i) {
    const CarriedPair& pair = part.pairs[i];
    const Turnable block(room.pair_blocks.data() + 9 * i);
    const double* const straight = pair.turned ? block.turned : block.as_it_is;
    const double* const other = pair.turned ? block.as_it_is : block.turned;
    const int* place = part.places.data() + pair.first;
    for (size_t a = 0; a < static_cast<size_t>(pair.rows); ++a) {
      const size_t columns = pair.triangle ? a + 1 : static_cast<size_t>(pair.columns);
      for (size_t b = 0; b < columns; ++b, ++place) {
        const auto k = static_cast<size_t>(*place);
        double* const to = values + part.offset[k];
        const int stride = std::abs(part.stride[k]);
        add_scaled(straight, pair.row_weights[a] * pair.column_weights[b], to, stride);
        // Of two vertices of one body the matrix has both H and its transpose.
        if (pair.triangle && !pair.diagonal)
          add_scaled(other, pair.column_weights[a] * pair.row_weights[b], to, stride);
      }
    }
  }
}

double System::stiffness_at(int vertex, const BlockMatrix& matrix) const {
  const SystemNumbers& n = impl->numbers;
  const int number = n.number[static_cast<size_t>(vertex)];
  if (number < 0) return 0;
  const auto block = [&](int i, int j) -> Eigen::Matrix3d {
    const ptrdiff_t start = matrix.find(i, j);
    if (start < 0) return Eigen::Matrix3d::Zero();
    return Eigen::Map<const Eigen::Matrix3d, 0, Eigen::OuterStride<>>(matrix.values().data() + start,
                                                                      Eigen::OuterStride<>(matrix.column_stride(j)));
  };
  if (!n.carried(number)) return block(number, number).trace() / 3;
  // 1/(w' H^-1 w), H that of its body.
  const VertexBlocks body = n.blocks_of(number);
  Eigen::Matrix<double, 12, 12> own = Eigen::Matrix<double, 12, 12>::Zero();
  Eigen::Matrix<double, 12, 3> weights;
  for (int b = 0; b < 4; ++b) {
    weights.middleRows<3>(3 * b) = body.weights[static_cast<size_t>(b)] * Eigen::Matrix3d::Identity();
    for (int a = b; a < 4; ++a) own.block<3, 3>(3 * a, 3 * b) = block(body.first + a, body.first + b);
  }
  const Eigen::Matrix<double, 12, 12> symmetric = own.selfadjointView<Eigen::Lower>();
  return 3 / (weights.transpose() * symmetric.ldlt().solve(weights)).trace();
}

}  // namespace ergon
