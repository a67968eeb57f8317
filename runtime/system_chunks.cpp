// What follows from a list of stencils alone: the vertices of each chunk, the colours, and the blocks of the matrix
// that each chunk adds to.

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>

#include "runtime/error.h"
#include "runtime/system_data.h"

namespace ergon {
namespace {

constexpr int kWorthThreads = 4096;  // stencils
constexpr int kColours = 64;         // told apart in one pass

}  // namespace

lanes::ChunkBlocks SystemTerm::blocks(int chunk) const {
  const SystemChunk& part = parts[static_cast<size_t>(chunk)];
  return {static_cast<int>(part.row.size()), part.offset.data(), part.stride.data()};
}

size_t SystemTerm::largest_chunk() const {
  const Potential::Impl& d = data();
  if (d.stencil_version > 1) return static_cast<size_t>(d.chunk * d.lanes * d.points * (d.points + 1) / 2);
  size_t largest = 0;
  for (size_t chunk = 0; chunk < results.size(); ++chunk) largest = std::max(largest, parts[chunk].sums());
  return largest;
}

lanes::BlockRange SystemTerm::range(int chunk) const {
  return {chunk * data().chunk, std::min((chunk + 1) * data().chunk, data().blocks())};
}

void SystemTerm::check(int vertices) {
  const Potential::Impl& d = data();
  if (checked_stencils == d.stencil_version) return;
  const auto largest = std::max_element(d.vertices.begin(), d.vertices.end());
  if (largest != d.vertices.end() && *largest >= vertices) {
    throw InputError(
        fmt::format("potential '{}' names vertex {}; the system has vertices 0 to {}", d.name, *largest, vertices - 1));
  }
  checked_stencils = d.stencil_version;
  const auto count = static_cast<size_t>(d.chunks());
  results.resize(count);
  if (parts.size() < count) parts.resize(count);
}

void SystemTerm::list_vertices(std::vector<SystemRoom>& rooms) {
  const Potential::Impl& d = data();
  const size_t width = static_cast<size_t>(d.points * d.lanes);
#pragma omp parallel if (d.count > kWorthThreads)
  {
    std::vector<int>& chunk_of = rooms[static_cast<size_t>(omp_get_thread_num())].place;  // by vertex
    std::fill(chunk_of.begin(), chunk_of.end(), -1);
#pragma omp for schedule(static)
    for (int chunk = 0; chunk < static_cast<int>(results.size()); ++chunk) {
      const lanes::BlockRange r = range(chunk);
      const int* vertex = d.vertices.data() + static_cast<size_t>(r.first) * width;
      const int* const last = d.vertices.data() + static_cast<size_t>(r.last) * width;
      std::vector<int>& found = parts[static_cast<size_t>(chunk)].vertices;
      found.clear();
      // Lists that change ask for no memory once they were as long.
      if (d.stencil_version > 1) found.reserve(std::min(chunk_of.size(), static_cast<size_t>(last - vertex)));
      for (; vertex != last; ++vertex) {
        int& marked = chunk_of[static_cast<size_t>(*vertex)];
        if (marked == chunk) continue;
        marked = chunk;
        found.push_back(*vertex);
      }
      std::sort(found.begin(), found.end());
    }
  }
}

void SystemTerm::colour(std::vector<SystemRoom>& rooms, std::vector<unsigned long long>& taken,
                        const std::vector<int>& lead) {
  if (coloured_stencils == data().stencil_version) return;
  coloured_stencils = data().stencil_version;
  list_vertices(rooms);
  // Every chunk gets the first colour that no chunk before it has at one of its vertices, or at another of a body.
  const auto mark = [&](int v) -> unsigned long long& {
    return taken[static_cast<size_t>(lead.empty() ? v : lead[static_cast<size_t>(v)])];
  };
  const size_t count = results.size();
  colour_of.assign(count, -1);
  int colours = 0;
  size_t left = count;
  for (int first = 0; left > 0; first += kColours) {
    std::fill(taken.begin(), taken.end(), 0);
    for (size_t chunk = 0; chunk < count; ++chunk) {
      if (colour_of[chunk] >= 0) continue;
      unsigned long long mask = 0;
      for (const int v : parts[chunk].vertices) mask |= mark(v);
      if (~mask == 0) continue;
      const int colour = __builtin_ctzll(~mask);
      for (const int v : parts[chunk].vertices) mark(v) |= 1ULL << colour;
      colour_of[chunk] = first + colour;
      colours = std::max(colours, first + colour + 1);
      --left;
    }
  }
  colour_start.assign(static_cast<size_t>(colours) + 2, 0);
  for (const int colour : colour_of) ++colour_start[static_cast<size_t>(colour) + 2];
  for (size_t c = 2; c < colour_start.size(); ++c) colour_start[c] += colour_start[c - 1];
  chunks.resize(count);
  for (size_t chunk = 0; chunk < count; ++chunk) {
    chunks[static_cast<size_t>(colour_start[static_cast<size_t>(colour_of[chunk]) + 1]++)] = static_cast<int>(chunk);
  }
  colour_start.pop_back();
}

bool SystemTerm::number(std::vector<SystemRoom>& rooms, const SystemNumbers& numbers, unsigned long fixed) {
  const Potential::Impl& d = data();
  if (numbered_stencils == d.stencil_version && numbered_fixed == fixed) return false;
  numbered_stencils = d.stencil_version;
  numbered_fixed = fixed;
  const auto points = static_cast<size_t>(d.points), pairs = points * (points + 1) / 2;
  slots.resize(d.lane_stencil.size() * pairs);
  turned.assign(d.ascending() ? 0 : static_cast<size_t>(d.blocks()) * pairs, 0);
#pragma omp parallel if (d.count > kWorthThreads)
  {
    SystemRoom& room = rooms[static_cast<size_t>(omp_get_thread_num())];
#pragma omp for schedule(static)
    for (int chunk = 0; chunk < static_cast<int>(results.size()); ++chunk) {
      SystemChunk& part = parts[static_cast<size_t>(chunk)];
      room.block.clear();
      bool carried = false;
      for (const int v : part.vertices) {
        const int number = numbers.number[static_cast<size_t>(v)];
        room.place[static_cast<size_t>(v)] = number < 0 ? -1 : static_cast<int>(room.block.size());
        if (number >= 0) room.block.push_back(number);
        carried = carried || numbers.carried(number);
      }
      const lanes::BlockRange r = range(chunk);
      const size_t lanes_in = static_cast<size_t>((r.last - r.first) * d.lanes), free = room.block.size();
      const size_t most_free = std::min(numbers.number.size(), lanes_in * points),
                   words = most_free * ((most_free + 63) / 64);
      const auto grow = [](auto& list, size_t size) {
        if (list.size() < size) list.resize(size, 0);
      };
      grow(room.places, lanes_in * points);
      grow(room.bits, words);
      grow(room.rank, words);
      grow(room.row, lanes_in * pairs);
      grow(room.column, lanes_in * pairs);
      const int count = operations->number_blocks(
          stencils, r,
          {static_cast<int>(free), room.place.data(), room.block.data(), room.places.data(), room.bits.data(),
           room.rank.data(), slots.data(), turned.data(), room.row.data(), room.column.data()});
      part.pairs.clear();
      if (carried) {
        carry_pairs(room, count, numbers, part);
        continue;
      }
      if (d.stencil_version > 1) {
        for (std::vector<int>* list : {&part.row, &part.column, &part.index, &part.offset, &part.stride}) {
          list->reserve(lanes_in * pairs);
        }
      }
      part.row.assign(room.row.begin(), room.row.begin() + count);
      part.column.assign(room.column.begin(), room.column.begin() + count);
    }
  }
  stencils.slots = slots.data();
  stencils.turned = turned.data();
  return true;
}

}  // namespace ergon
