// The matrix pattern. It follows the lists of stencils: a list that brings no new coupling leaves it as it is, one that
// does has it made anew from the old one.

#include <omp.h>

#include <algorithm>

#include "runtime/system_data.h"

namespace ergon {
namespace {

// Changes of lists after which blocks that are no longer used leave the pattern, when nothing else renews it.
constexpr int kPatience = 32;

// One mark for each block of a pattern, with room for those of a somewhat larger one.
void clear_marks(std::vector<char>& marks, size_t blocks) {
  if (marks.capacity() < blocks) marks.reserve(blocks + blocks / 8);
  marks.assign(blocks, 0);
}

}  // namespace

long SystemTerm::find(const BlockPattern& pattern) {
  long missing = 0;
#pragma omp parallel for schedule(static) reduction(+ : missing) if (data().count > 4096)
  for (size_t chunk = 0; chunk < results.size(); ++chunk) {
    SystemChunk& part = parts[chunk];
    const size_t count = part.row.size();
    part.index.resize(count);
    part.offset.resize(count);
    part.stride.resize(count);
    missing += pattern.find(part.row.data(), part.column.data(), static_cast<int>(count), part.index.data());
    for (size_t k = 0; k < count; ++k) {
      part.offset[k] = static_cast<int>(pattern.start_of(part.index[k], part.column[k]));
      part.stride[k] = pattern.column_stride(part.column[k]);
    }
  }
  placed_pattern = pattern.id;
  return missing;
}

// Makes the pattern of all blocks that are used and, unless they are to be forgotten, of those that were used since the
// last one was made.
void System::Impl::make_pattern(bool forget) {
  if (forget) std::fill(recent.begin(), recent.end(), char{0});
  const auto take = [&](int index, int row, int column) {
    if (pattern != nullptr && index >= 0) {
      recent[static_cast<size_t>(index)] = 1;
    } else {
      builder.add(row, column);
    }
  };
  for (const SystemTerm& term : terms) {
    if (!term.assembled()) continue;
    for (size_t chunk = 0; chunk < term.results.size(); ++chunk) {
      const SystemChunk& part = term.parts[chunk];
      for (size_t k = 0; k < part.row.size(); ++k) {
        take(pattern != nullptr ? part.index[k] : -1, part.row[k], part.column[k]);
      }
    }
  }
  for (size_t k = 0; k < base_row.size(); ++k) {
    take(pattern != nullptr ? base_index[k] : -1, base_row[k], base_column[k]);
  }
  if (spare == nullptr || spare.use_count() > 1) spare = std::make_shared<BlockPattern>();
  builder.build(numbers.free, pattern.get(), recent, *spare);
  std::swap(pattern, spare);
  clear_marks(recent, pattern->blocks());
  unused_for = 0;
}

long System::Impl::find_blocks(bool everywhere) {
  long missing = 0;
  for (SystemTerm& term : terms) {
    if (term.assembled() && (everywhere || term.placed_pattern != pattern->id)) missing += term.find(*pattern);
  }
  base_index.resize(base_row.size());
  missing += pattern->find(base_row.data(), base_column.data(), static_cast<int>(base_row.size()), base_index.data());
  return missing;
}

void System::Impl::update_base_pattern() {
  for (const SystemTerm& term : terms) {
    for (size_t chunk = 0; term.constant() && chunk < term.results.size(); ++chunk) {
      const SystemChunk& part = term.parts[chunk];
      for (size_t k = 0; k < part.row.size(); ++k) builder.add(part.row[k], part.column[k]);
    }
  }
  coupled.add_blocks(numbers, builder);
  base_pattern = std::make_shared<BlockPattern>();
  builder.build(numbers.free, nullptr, {}, *base_pattern);
  base.set_pattern(base_pattern);
  base_known = false;
  base_row = base_pattern->block_row;
  base_column.clear();
  for (int j = 0; j < numbers.free; ++j) base_column.resize(static_cast<size_t>(base_pattern->block_start[j + 1]), j);
  for (SystemTerm& term : terms) {
    if (term.constant()) term.find(*base_pattern);
  }
  coupled.find(numbers, *base_pattern);
}

void System::Impl::update_pattern() {
  bool base_changed = coupled.renumbered(fixed_version), changed = false;
  for (SystemTerm& term : terms) {
    if (!term.in_matrix() || !term.number(rooms, numbers, fixed_version)) continue;
    (term.constant() ? base_changed : changed) = true;
    term.placed_pattern = 0;
  }
  if (base_changed) update_base_pattern();
  if (changed || base_changed || pattern == nullptr) {
    first_known = false;
    if (pattern == nullptr || find_blocks(false) > 0 || unused_for > kPatience) {
      make_pattern(unused_for > kPatience);
      find_blocks(true);
    }
  }
  size_rooms();
}

void System::Impl::size_rooms() {
  size_t scratch = 0, blocks = 0;
  for (const SystemTerm& term : terms) {
    if (!term.in_matrix()) continue;
    scratch = std::max(scratch, static_cast<size_t>(term.operations->scratch_size(term.stencils)));
    blocks = std::max(blocks, term.largest_chunk());
  }
  for (SystemRoom& room : rooms) {
    const size_t sums = (blocks + 1) * lanes::kSumDoubles;
    if (room.sums.size() < sums) room.sums.resize(sums, 0.0);
    if (room.scratch.size() < scratch) room.scratch.resize(scratch);
    const size_t pairs = lanes::kSumDoubles * blocks;
    if (!numbers.carriers.empty() && room.pairs.size() < pairs) room.pairs.resize(pairs, 0.0);
  }
  for (size_t k = pair_offset.size(); k < blocks && !numbers.carriers.empty(); ++k) {
    pair_offset.push_back(static_cast<int>(lanes::kSumDoubles * k));
    pair_stride.push_back(-4);
  }
}

void System::Impl::update_first() {
  if (first_known) return;
  first_known = true;
  clear_marks(used, pattern->blocks());
  for (const int index : base_index) used[static_cast<size_t>(index)] = 1;
  for (SystemTerm& term : terms) {
    if (!term.assembled()) continue;
    for (const int chunk : term.chunks) {  // those of one colour share no block
      SystemChunk& part = term.parts[static_cast<size_t>(chunk)];
      for (size_t k = 0; k < part.index.size(); ++k) {
        char& before = used[static_cast<size_t>(part.index[k])];
        part.stride[k] = before != 0 ? std::abs(part.stride[k]) : -std::abs(part.stride[k]);
        before = 1;
      }
    }
  }
  cleared_column.clear();
  cleared_index.clear();
  bool coupling_unused = false;
  for (int j = 0; j < pattern->block_rows; ++j) {
    const int last = pattern->block_start[static_cast<size_t>(j) + 1];
    for (int k = pattern->block_start[static_cast<size_t>(j)]; k < last; ++k) {
      if (used[static_cast<size_t>(k)] != 0) {
        recent[static_cast<size_t>(k)] = 1;
        continue;
      }
      coupling_unused = coupling_unused || pattern->block_row[static_cast<size_t>(k)] != j;
      cleared_column.push_back(j);
      cleared_index.push_back(k);
    }
  }
  unused_for = coupling_unused ? unused_for + 1 : 0;
}

}  // namespace ergon
