// Carried vertices: whose degrees of freedom they have, and the way of Hessians from pairs of vertices to the matrix,
// J^T H J, chunk by chunk. Chunks without carried vertices go the direct way.

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>

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

// Blocks are columns of four, of which the last is zero.
constexpr size_t kBlock = lanes::kSumDoubles;

typedef double Two __attribute__((vector_size(16)));  // a column is two of them, aligned

void put_scaled(const double* block, double scale, double* to, bool stored) {
  const Two* from = reinterpret_cast<const Two*>(block);
  Two* place = reinterpret_cast<Two*>(to);
  for (size_t i = 0; i < kBlock / 2; ++i) place[i] = stored ? scale * from[i] : place[i] + scale * from[i];
}

void transpose(const double* block, double* to) {
  for (size_t c = 0; c < 3; ++c) {
    for (size_t r = 0; r < 3; ++r) to[4 * r + c] = block[4 * c + r];
    to[4 * c + 3] = 0;
  }
}

void make_room(AlignedVector<double>& room, int blocks) {
  const size_t size = kBlock * static_cast<size_t>(blocks);
  if (room.size() < size) room.resize(size, 0.0);
}

void each_once(const std::vector<PairKey>& keys, std::vector<PairKey>& sorted) {
  sorted = keys;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
}

size_t place_in(const std::vector<PairKey>& sorted, PairKey key) {
  return static_cast<size_t>(std::lower_bound(sorted.begin(), sorted.end(), key) - sorted.begin());
}

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
void SystemTerm::carry_pairs(SystemRoom& room, int count, const SystemNumbers& numbers, SystemChunk& part) {
  auto& [halves, half_keys, wholes, whole_keys, blocks, block_keys, reached] = room.carry;
  const auto pairs = static_cast<size_t>(count);
  part.pairs.resize(pairs);
  halves.resize(pairs);
  for (size_t i = 0; i < pairs; ++i) {
    const int row = room.row[i], column = room.column[i];
    const VertexBlocks u = numbers.blocks_of(row), v = numbers.blocks_of(column);
    const bool turned = u.first < v.first;
    const VertexBlocks& low = turned ? u : v;
    part.pairs[i] = {0, low.count, turned, false, low.weights};
    // Of one vertex with itself, what is added to its transpose is a half.
    if (row == column && low.count > 1) {
      for (double& weight : part.pairs[i].weights) weight /= 2;
    }
    halves[i] = key_of(turned ? column : row, low.first);
  }
  each_once(halves, half_keys);
  part.halves.resize(half_keys.size());
  wholes.resize(half_keys.size());
  for (size_t h = 0, from = 0; h < half_keys.size(); ++h) {
    const VertexBlocks high = numbers.blocks_of(high_of(half_keys[h]));
    const int low = low_of(half_keys[h]), columns = numbers.blocks_of(low).count;
    part.halves[h] = {static_cast<int>(from), 0, high.count, columns, false, high.weights};
    wholes[h] = key_of(high.first, low);
    from += static_cast<size_t>(columns);
  }
  reached.assign(half_keys.size(), 0);
  for (size_t i = 0; i < pairs; ++i) {
    const size_t h = place_in(half_keys, halves[i]);
    part.pairs[i].half = part.halves[h].from;
    part.pairs[i].stored = std::exchange(reached[h], char{1}) == 0;
  }

  each_once(wholes, whole_keys);
  part.wholes.resize(whole_keys.size());
  reached.assign(whole_keys.size(), 0);
  for (size_t h = 0; h < half_keys.size(); ++h) {
    const CarriedHalf& half = part.halves[h];
    const size_t w = place_in(whole_keys, wholes[h]);
    part.halves[h].whole = static_cast<int>(w);
    part.halves[h].stored = std::exchange(reached[w], char{1}) == 0;
    part.wholes[w] = {0, half.rows, half.columns, high_of(whole_keys[w]) == low_of(whole_keys[w]) && half.rows > 1, 0};
  }
  // The matrix blocks, by column and then row, and where each is in that order.
  blocks.clear();
  int from = 0;
  for (size_t w = 0; w < whole_keys.size(); ++w) {
    CarriedWhole& whole = part.wholes[w];
    whole.from = from;
    whole.places = static_cast<int>(blocks.size());
    from += whole.rows * whole.columns;
    for (int a = 0; a < whole.rows; ++a) {
      for (int b = 0; b < (whole.symmetric ? a + 1 : whole.columns); ++b) {
        blocks.push_back(key_of(low_of(whole_keys[w]) + b, high_of(whole_keys[w]) + a));
      }
    }
  }
  for (CarriedHalf& half : part.halves) half.whole = part.wholes[static_cast<size_t>(half.whole)].from;
  each_once(blocks, block_keys);
  part.places.clear();
  part.row.clear();
  part.column.clear();
  for (const PairKey block : blocks) part.places.push_back(static_cast<int>(place_in(block_keys, block)));
  for (const PairKey block : block_keys) {
    part.row.push_back(low_of(block));
    part.column.push_back(high_of(block));
  }
}

namespace {

// J^T H J of what is in room.pairs, to the values of the matrix.
void carry(const SystemChunk& part, SystemRoom& room, double* values) {
  alignas(Two) double turned[kBlock];
  make_room(room.halves, part.halves.back().from + part.halves.back().columns);
  const double* block = room.pairs.data();
  for (const CarriedPair& pair : part.pairs) {
    if (pair.turned) transpose(block, turned);
    double* to = room.halves.data() + kBlock * static_cast<size_t>(pair.half);
    for (int b = 0; b < pair.columns; ++b, to += kBlock) {
      put_scaled(pair.turned ? turned : block, pair.weights[static_cast<size_t>(b)], to, pair.stored);
    }
    block += kBlock;
  }
  const CarriedWhole& last = part.wholes.back();
  make_room(room.wholes, last.from + last.rows * last.columns);
  for (const CarriedHalf& half : part.halves) {
    double* to = room.wholes.data() + kBlock * static_cast<size_t>(half.whole);
    for (int a = 0; a < half.rows; ++a) {
      const double* from = room.halves.data() + kBlock * static_cast<size_t>(half.from);
      for (int b = 0; b < half.columns; ++b, from += kBlock, to += kBlock) {
        put_scaled(from, half.weights[static_cast<size_t>(a)], to, half.stored);
      }
    }
  }
  const auto add_to_matrix = [&](const double* from, int place) {
    const auto k = static_cast<size_t>(place);
    const bool stored = part.stride[k] < 0;
    double* to = values + part.offset[k];
    for (int c = 0; c < 3; ++c, from += 4, to += std::abs(part.stride[k])) {
      for (int r = 0; r < 3; ++r) to[r] = (stored ? 0 : to[r]) + from[r];
    }
  };
  for (const CarriedWhole& whole : part.wholes) {
    const double* const blocks = room.wholes.data() + kBlock * static_cast<size_t>(whole.from);
    const int* place = part.places.data() + whole.places;
    for (int a = 0; a < whole.rows; ++a) {
      for (int b = 0; b < (whole.symmetric ? a + 1 : whole.columns); ++b, ++place) {
        const double* const here = blocks + kBlock * static_cast<size_t>(a * whole.columns + b);
        if (!whole.symmetric) {
          add_to_matrix(here, *place);
          continue;
        }
        transpose(blocks + kBlock * static_cast<size_t>(b * whole.columns + a), turned);
        put_scaled(here, 1, turned, false);
        add_to_matrix(turned, *place);
      }
    }
  }
}

}  // namespace

void System::Impl::add_chunk(SystemTerm& term, int chunk, Projection projection, SystemRoom& room, double* gradients,
                             double* values, lanes::ChunkResult* result) {
  const SystemChunk& part = term.parts[static_cast<size_t>(chunk)];
  const bool direct = part.pairs.empty();
  const lanes::ChunkBlocks pairs{static_cast<int>(part.pairs.size()), pair_offset.data(), pair_stride.data()};
  term.operations->hessian(term.stencils, term.range(chunk), direct ? term.blocks(chunk) : pairs, points_of(term),
                           static_cast<int>(projection), room.view(), gradients, direct ? values : room.pairs.data(),
                           result);
  if (!direct) carry(part, room, values);
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
