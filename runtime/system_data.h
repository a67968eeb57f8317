#pragma once
// What a System holds. Included by system*.cpp only.

#include <atomic>
#include <thread>
#include <vector>

#include "runtime/aligned.h"
#include "runtime/potential_data.h"
#include "runtime/system.h"

namespace ergon {

// One potential of a system with what evaluation needs beside its own data. Its chunks are coloured so that no two of a
// colour share a vertex, and stand in order of colour. Of two that share a vertex the one that stands first is added
// first: this fixes the order of every sum, while all others may run at the same time.
struct SystemTerm {
  explicit SystemTerm(Potential added) : potential(std::move(added)) {}

  Potential potential;
  const lanes::LaneOperations* operations = nullptr;
  lanes::Stencils stencils{};

  unsigned long coloured_stencils = 0;  // stencil_version that the colouring is of
  std::vector<int> chunks;              // in order of colour
  std::vector<int> awaited_start;       // per place in chunks, into awaited
  std::vector<int> awaited;             // places of the chunks that were the last before to add to one of its vertices
  int next = 0;                         // place that the next free thread takes
  unsigned round = 0;                   // counts the evaluations that run in this order
  std::vector<unsigned> done;           // per place: the last round in which it was done
  std::vector<lanes::ChunkResult> results;

  unsigned long slotted_stencils = 0;  // stencil_version and pattern that the slots are of
  unsigned long slotted_pattern = 0;
  AlignedVector<int> slots;  // lanes::Stencils
  std::vector<unsigned char> turned;
  std::vector<int> block_start;  // per chunk, into the two below: lanes::ChunkBlocks
  std::vector<int> block_offset;
  std::vector<int> block_stride;

  // A constant Hessian: the versions that the assembled base is made of.
  unsigned long based_stencils = 0;
  unsigned long based_params = 0;
  unsigned long based_lags = 0;
  AlignedVector<double> q_hessians;  // kept when there is a lag that they might depend on
  long indefinite = 0;

  Potential::Impl& data() { return *potential.impl; }
  const Potential::Impl& data() const { return *potential.impl; }
  const ErgonKernel& kernel() const { return *potential.impl->kernel.table; }
  bool constant() const { return kernel().constant_hessian && !kernel().zero_hessian; }
  bool assembled() const { return !kernel().constant_hessian && !kernel().zero_hessian; }
  lanes::BlockRange range(int chunk) const;
  lanes::ChunkBlocks blocks(int chunk) const;
  int largest_chunk() const;  // in matrix blocks

  // Runs f(chunk) for all chunks, each once those that it awaits are done. Called by all threads of a team, once
  // start() was called by one.
  void start() {
    next = 0;
    ++round;
  }
  template <class F>
  void run(F f);

  // Colours the chunks if the stencils changed. `seen` is room for one mark per vertex.
  void colour(std::vector<int>& seen);
  // Finds the places of all blocks in the pattern; false when one is not in it.
  bool find_slots(const BlockMatrix& pattern, const std::vector<int>& block_of);
  // Whether the constant Hessian differs from that of the last call.
  bool constant_changed();
};

template <class F>
void SystemTerm::run(F f) {
  constexpr int kPatience = 1000;
  std::atomic_ref<int> ticket(next);
  for (;;) {
    const auto place = static_cast<size_t>(ticket.fetch_add(1, std::memory_order_relaxed));
    if (place >= chunks.size()) break;
    for (int k = awaited_start[place]; k < awaited_start[place + 1]; ++k) {
      const std::atomic_ref<unsigned> other(done[static_cast<size_t>(awaited[static_cast<size_t>(k)])]);
      for (int tries = 0; other.load(std::memory_order_acquire) != round; ++tries) {
        if (tries > kPatience) std::this_thread::yield();
      }
    }
    f(chunks[place]);
    std::atomic_ref<unsigned>(done[place]).store(round, std::memory_order_release);
  }
#pragma omp barrier
}

struct System::Impl {
  int vertices = 0;
  int free_vertices = 0;
  std::vector<int> block_of;
  std::vector<SystemTerm> terms;

  bool pattern_known = false;
  BlockMatrix pattern;  // without values

  // The sum of the constant Hessians: blocks that are not zero, in the order of the matrix.
  bool base_known = false;
  Projection base_projection = Projection::clamp;
  std::vector<int> base_start;      // per block column
  std::vector<int> base_row;        // of each block: scalar rows below the start of its column
  std::vector<double> base_values;  // 9 per block, column by column

  AlignedVector<double> x;         // 4 per vertex
  AlignedVector<double> gradient;  // 4 per vertex
  struct Room {
    AlignedVector<double> sums;
    AlignedVector<double> scratch;
    lanes::Workspace view() { return {sums.data(), scratch.data()}; }
  };
  std::vector<Room> rooms;  // per thread
  std::vector<int> seen;

  // Brings prepared data and colouring up to date for an evaluation at these positions.
  void prepare(const Eigen::Matrix3Xd& positions);
  // Brings pattern, slots and rooms up to date.
  void update_pattern();
  void size_rooms();
  void build_pattern();
  // Assembles the constant Hessians again if one of them changed; uses matrix as room.
  void update_base(const Eigen::Matrix3Xd& positions, Projection projection, BlockMatrix& matrix);
  // The next two are called by all threads of a team. The second zeroes the matrix but for the base.
  void load_positions(const Eigen::Matrix3Xd& positions);
  void start_matrix(BlockMatrix& matrix) const;
  bool worth_threads() const;
  Evaluation sum(bool margins) const;
};

}  // namespace ergon
