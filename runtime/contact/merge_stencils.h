#pragma once
// Stencils found in any order and any number of times become lists in which each stands once, with the sum of its
// weights, in ascending order.

#include <algorithm>
#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace ergon {

// A stencil by two numbers; bins are few enough to be counted.
struct StencilKey {
  int bin;
  float weight;
  std::uint64_t key;
};

// One whose offset was lowered (runtime/contact/rest_offsets.h).
struct LoweredStencil {
  int bin;
  std::uint32_t offset;  // its number
  std::uint64_t key;
  float weight;
  bool operator<(const LoweredStencil& other) const {
    return std::tie(bin, offset, key, weight) < std::tie(other.bin, other.offset, other.key, other.weight);
  }
  bool is_same(const LoweredStencil& other) const {
    return bin == other.bin && offset == other.offset && key == other.key;
  }
};

// By case.
using LoweredStencils = std::array<std::vector<LoweredStencil>, 6>;
using FoundStencils = std::array<std::vector<StencilKey>, 6>;

// Room that is kept from one merge to the next.
struct MergeRoom {
  std::vector<size_t> starts;
  struct Weighted {
    std::uint64_t key;
    float weight;
    bool operator<(const Weighted& other) const { return std::tie(key, weight) < std::tie(other.key, other.weight); }
  };
  std::vector<Weighted> keys;
};

// Calls emit(bin, key, weight) for each stencil of a case that any of `found` has: bins in ascending order, keys within
// one. Weights are added in ascending order, whatever that in which they were found.
template <class Emit>
void merge_stencils(const std::vector<FoundStencils>& found, size_t which, size_t bins, MergeRoom& room,
                    const Emit& emit) {
  room.starts.assign(bins + 2, 0);
  for (const FoundStencils& part : found) {
    for (const StencilKey& each : part[which]) ++room.starts[static_cast<size_t>(each.bin) + 2];
  }
  for (size_t bin = 2; bin < bins + 2; ++bin) room.starts[bin] += room.starts[bin - 1];
  room.keys.resize(room.starts[bins + 1]);
  // Each start advances to its end while its bin is filled.
  for (const FoundStencils& part : found) {
    for (const StencilKey& each : part[which])
      room.keys[room.starts[static_cast<size_t>(each.bin) + 1]++] = {each.key, each.weight};
  }
  for (size_t bin = 0; bin < bins; ++bin) {
    MergeRoom::Weighted* const first = room.keys.data() + room.starts[bin];
    MergeRoom::Weighted* const last = room.keys.data() + room.starts[bin + 1];
    std::sort(first, last);
    for (const MergeRoom::Weighted* at = first; at != last;) {
      const std::uint64_t key = at->key;
      double weight = 0;
      for (; at != last && at->key == key; ++at) weight += at->weight;
      emit(static_cast<int>(bin), key, weight);
    }
  }
}

// The same of those with lowered offsets, few as they are: emit(bin, key, weight, number of the offset), each stencil
// once for each of its offsets, bins in ascending order.
template <class Emit>
void merge_lowered(const std::vector<LoweredStencils>& found, size_t which, std::vector<LoweredStencil>& room,
                   const Emit& emit) {
  room.clear();
  for (const LoweredStencils& part : found) room.insert(room.end(), part[which].begin(), part[which].end());
  std::sort(room.begin(), room.end());
  for (auto at = room.begin(); at != room.end();) {
    const LoweredStencil& stencil = *at;
    double weight = 0;
    for (; at != room.end() && at->is_same(stencil); ++at) weight += at->weight;
    emit(stencil.bin, stencil.key, weight, stencil.offset);
  }
}

}  // namespace ergon
