// What is made once per list of stencils: colouring, the matrix pattern and the places of all blocks in it.

#include <fmt/format.h>

#include <algorithm>

#include "runtime/error.h"
#include "runtime/system_data.h"

namespace ergon {
namespace {

// Enough chunks to keep many cores busy, each large enough for its vertices to be used many times.
constexpr int kChunks = 512;
constexpr int kSmallestChunk = 32;  // stencils
constexpr int kLargestChunk = 512;

}  // namespace

lanes::BlockRange SystemTerm::range(int chunk) const {
  return {chunk * chunk_blocks, std::min((chunk + 1) * chunk_blocks, data().blocks())};
}

void SystemTerm::colour(std::vector<int>& seen) {
  const Potential::Impl& d = data();
  if (coloured_stencils == d.stencil_version) return;
  const auto largest = std::max_element(d.vertices.begin(), d.vertices.end());
  if (largest != d.vertices.end() && static_cast<size_t>(*largest) >= seen.size()) {
    throw InputError(fmt::format("potential '{}' names vertex {}; the system has vertices 0 to {}", d.name, *largest,
                                 seen.size() - 1));
  }
  coloured_stencils = d.stencil_version;
  const int size = std::clamp(d.count / kChunks, kSmallestChunk, kLargestChunk);
  chunk_blocks = std::max(1, size / d.lanes);
  const int count = (d.blocks() + chunk_blocks - 1) / chunk_blocks;
  results.resize(static_cast<size_t>(count));
  chunks.clear();
  colour_start.assign(1, 0);
  std::fill(seen.begin(), seen.end(), 0);
  std::vector<int> waiting(static_cast<size_t>(count)), later;
  for (int c = 0; c < count; ++c) waiting[static_cast<size_t>(c)] = c;
  const size_t per_chunk = static_cast<size_t>(chunk_blocks * d.points * d.lanes);
  for (int colour = 1; !waiting.empty(); ++colour) {
    later.clear();
    for (const int chunk : waiting) {
      const size_t first = static_cast<size_t>(chunk) * per_chunk;
      const size_t last = std::min(first + per_chunk, d.vertices.size());
      const auto taken = [&](int vertex) { return seen[static_cast<size_t>(vertex)] == colour; };
      const int* begin = d.vertices.data() + first;
      const int* end = d.vertices.data() + last;
      if (std::any_of(begin, end, taken)) {
        later.push_back(chunk);
        continue;
      }
      for (const int* v = begin; v != end; ++v) seen[static_cast<size_t>(*v)] = colour;
      chunks.push_back(chunk);
    }
    colour_start.push_back(static_cast<int>(chunks.size()));
    waiting.swap(later);
  }
}

bool SystemTerm::find_slots(const BlockMatrix& pattern, const std::vector<int>& block_of) {
  const Potential::Impl& d = data();
  const auto n = static_cast<size_t>(d.points), width = static_cast<size_t>(d.lanes), pairs = n * (n + 1) / 2;
  const auto blocks = static_cast<size_t>(d.blocks());
  slots.resize(blocks * pairs * width);
  strides.resize(blocks * n * width);
  bool missing = false;
#pragma omp parallel for schedule(static) reduction(|| : missing) if (d.count > 4096)
  for (size_t block = 0; block < blocks; ++block) {
    for (size_t l = 0; l < width; ++l) {
      for (size_t a = 0, pair = block * pairs; a < n; ++a) {
        const int row = block_of[static_cast<size_t>(d.vertices[(block * n + a) * width + l])];
        strides[(block * n + a) * width + l] = row < 0 ? 0 : pattern.column_stride(row);
        for (size_t b = 0; b <= a; ++b, ++pair) {
          const int column = block_of[static_cast<size_t>(d.vertices[(block * n + b) * width + l])];
          int& slot = slots[pair * width + l];
          slot = lanes::kFixedSlot;
          if (row < 0 || column < 0) continue;
          const ptrdiff_t place = pattern.find(std::max(row, column), std::min(row, column));
          missing = missing || place < 0;
          slot = 2 * static_cast<int>(place / 3) + (row < column ? 1 : 0);
        }
      }
    }
  }
  slotted_stencils = d.stencil_version;
  slotted_pattern = missing ? 0 : pattern.pattern_id();
  stencils.slots = slots.data();
  stencils.strides = strides.data();
  return !missing;
}

void System::Impl::build_pattern() {
  std::vector<std::pair<int, int>> pairs;
  for (const SystemTerm& term : terms) {
    if (term.kernel().zero_hessian) continue;
    const std::vector<int>& stencils = term.data().stencils;
    const auto n = static_cast<size_t>(term.data().points);
    for (size_t first = 0; first < stencils.size(); first += n) {
      for (size_t a = 1; a < n; ++a) {
        const int row = block_of[static_cast<size_t>(stencils[first + a])];
        for (size_t b = 0; b < a && row >= 0; ++b) {
          const int column = block_of[static_cast<size_t>(stencils[first + b])];
          if (column >= 0) pairs.emplace_back(row, column);
        }
      }
    }
  }
  pattern = BlockMatrix(free_vertices, pairs);
  pattern.values() = {};
  pattern_known = true;
  base_known = false;
}

void System::Impl::update_pattern() {
  if (!pattern_known) build_pattern();
  for (size_t t = 0; t < terms.size(); ++t) {
    SystemTerm& term = terms[t];
    if (term.kernel().zero_hessian) continue;
    if (term.slotted_stencils == term.data().stencil_version && term.slotted_pattern == pattern.pattern_id()) continue;
    if (term.find_slots(pattern, block_of)) continue;
    // A new coupling: all slots are to be found again in a pattern that has it.
    build_pattern();
    t = static_cast<size_t>(-1);
  }
}

}  // namespace ergon
