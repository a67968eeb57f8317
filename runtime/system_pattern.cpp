// What is made once per list of stencils: colouring, the matrix pattern and the places of all blocks in it.

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>

#include "runtime/error.h"
#include "runtime/system_data.h"

namespace ergon {
lanes::ChunkBlocks SystemTerm::blocks(int chunk) const {
  const int first = block_start[static_cast<size_t>(chunk)];
  return {block_start[static_cast<size_t>(chunk) + 1] - first, block_offset.data() + first,
          block_stride.data() + first};
}

int SystemTerm::largest_chunk() const {
  int largest = 0;
  for (size_t c = 1; c < block_start.size(); ++c) largest = std::max(largest, block_start[c] - block_start[c - 1]);
  return largest;
}

lanes::BlockRange SystemTerm::range(int chunk) const {
  return {chunk * data().chunk, std::min((chunk + 1) * data().chunk, data().blocks())};
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
  const int count = d.chunks();
  results.resize(static_cast<size_t>(count));
  chunks.clear();
  colour_start.assign(1, 0);
  std::fill(seen.begin(), seen.end(), 0);
  std::vector<int> waiting(static_cast<size_t>(count)), later;
  for (int c = 0; c < count; ++c) waiting[static_cast<size_t>(c)] = c;
  const size_t per_chunk = static_cast<size_t>(d.chunk * d.points * d.lanes);
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
  const auto vectors = static_cast<size_t>(d.blocks());
  slots.resize(vectors * pairs * width);
  turned.assign(d.ascending() ? 0 : vectors * pairs, 0);
  struct Found {
    int index, offset, stride;
  };
  std::vector<std::vector<Found>> found(results.size());
  bool missing = false;
#pragma omp parallel reduction(|| : missing) if (d.count > 4096)
  {
    std::vector<int> place(pattern.blocks(), -1);  // in the chunk, by index of the matrix block
    std::vector<int> wanted;                       // index of the matrix block, by slot
#pragma omp for schedule(static)
    for (size_t chunk = 0; chunk < results.size(); ++chunk) {
      const lanes::BlockRange r = range(static_cast<int>(chunk));
      const auto first = static_cast<size_t>(r.first), last = static_cast<size_t>(r.last);
      std::vector<Found>& list = found[chunk];
      wanted.assign((last - first) * pairs * width, -1);
      size_t slot = 0;
      for (size_t vector = first; vector < last; ++vector) {
        for (size_t a = 0; a < n; ++a) {
          for (size_t b = 0; b <= a; ++b) {
            for (size_t l = 0; l < width; ++l, ++slot) {
              if (static_cast<int>(l) >= d.lanes_in(static_cast<int>(vector))) continue;
              const int row = block_of[static_cast<size_t>(d.vertices[(vector * n + a) * width + l])];
              const int column = block_of[static_cast<size_t>(d.vertices[(vector * n + b) * width + l])];
              if (row < 0 || column < 0) continue;
              if (row < column) turned[vector * pairs + a * (a + 1) / 2 + b] |= static_cast<unsigned char>(1u << l);
              const int index = pattern.index_of(std::max(row, column), std::min(row, column));
              missing = missing || index < 0;
              wanted[slot] = index;
              if (index < 0 || place[static_cast<size_t>(index)] == 0) continue;
              place[static_cast<size_t>(index)] = 0;
              const int j = std::min(row, column);
              list.push_back({index, static_cast<int>(pattern.start_of(index, j)), pattern.column_stride(j)});
            }
          }
        }
      }
      std::sort(list.begin(), list.end(), [](const Found& p, const Found& q) { return p.index < q.index; });
      for (size_t i = 0; i < list.size(); ++i) place[static_cast<size_t>(list[i].index)] = static_cast<int>(i);
      for (size_t i = 0; i < wanted.size(); ++i) {
        const int in_chunk = wanted[i] < 0 ? static_cast<int>(list.size()) : place[static_cast<size_t>(wanted[i])];
        slots[first * pairs * width + i] = lanes::kSumDoubles * in_chunk;
      }
      for (const Found& f : list) place[static_cast<size_t>(f.index)] = -1;
    }
  }
  block_start.assign(1, 0);
  block_offset.clear();
  block_stride.clear();
  block_index.clear();
  for (const std::vector<Found>& list : found) {
    for (const Found& f : list) {
      block_offset.push_back(f.offset);
      block_stride.push_back(f.stride);
      block_index.push_back(f.index);
    }
    block_start.push_back(static_cast<int>(block_offset.size()));
  }
  slotted_stencils = d.stencil_version;
  slotted_pattern = missing ? 0 : pattern.pattern_id();
  stencils.slots = slots.data();
  stencils.turned = turned.data();
  return !missing;
}

void System::Impl::build_pattern() {
  std::vector<std::pair<int, int>> pairs;
  for (const SystemTerm& term : terms) {
    if (term.kernel().zero_hessian) continue;
    const std::vector<int>& stencils = term.data().stencils;
    const std::vector<int>& used = term.data().used;
    for (size_t first = 0; first < stencils.size(); first += static_cast<size_t>(term.data().listed)) {
      for (size_t a = 1; a < used.size(); ++a) {
        const int row = block_of[static_cast<size_t>(stencils[first + static_cast<size_t>(used[a])])];
        for (size_t b = 0; b < a && row >= 0; ++b) {
          const int column = block_of[static_cast<size_t>(stencils[first + static_cast<size_t>(used[b])])];
          if (column >= 0) pairs.emplace_back(row, column);
        }
      }
    }
  }
  pattern = BlockMatrix(free_vertices, pairs);
  pattern.values() = {};
  pattern_known = true;
  base_known = false;
  first_known = false;
}

void System::Impl::update_pattern() {
  if (!pattern_known) build_pattern();
  for (size_t t = 0; t < terms.size(); ++t) {
    SystemTerm& term = terms[t];
    if (term.kernel().zero_hessian) continue;
    if (term.slotted_stencils == term.data().stencil_version && term.slotted_pattern == pattern.pattern_id()) continue;
    first_known = false;
    if (term.find_slots(pattern, block_of)) continue;
    // A new coupling: all slots are to be found again in a pattern that has it.
    build_pattern();
    t = static_cast<size_t>(-1);
  }
  size_rooms();
}

void System::Impl::size_rooms() {
  int scratch = 0, blocks = 0;
  for (const SystemTerm& term : terms) {
    if (term.kernel().zero_hessian) continue;
    scratch = std::max(scratch, term.operations->scratch_size(term.stencils));
    blocks = std::max(blocks, term.largest_chunk());
  }
  rooms.resize(std::max(rooms.size(), static_cast<size_t>(omp_get_max_threads())));
  for (Room& room : rooms) {
    const size_t sums = static_cast<size_t>(blocks + 1) * lanes::kSumDoubles;
    if (room.sums.size() < sums) room.sums.resize(sums, 0.0);
    if (room.scratch.size() < static_cast<size_t>(scratch)) room.scratch.resize(static_cast<size_t>(scratch));
  }
}

}  // namespace ergon
