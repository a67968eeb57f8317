#pragma once
// What a System holds. Included by system*.cpp only.

#include <vector>

#include "runtime/aligned.h"
#include "runtime/potential_data.h"
#include "runtime/system.h"

namespace ergon {

// Rest positions of some vertices of a system and how far the others moved from there, for densities whose q is F - I.
struct RestConfiguration {
  std::vector<char> known;  // per vertex
  Eigen::Matrix3Xd X;
  AlignedVector<double> displacement;  // x - X, 4 per vertex
};

// One potential of a system with what evaluation needs beside its own data. Its stencils are cut into chunks, and the
// chunks coloured so that no two of a colour share a vertex: colours follow one another, the chunks of one are
// independent.
struct SystemTerm {
  explicit SystemTerm(Potential added) : potential(std::move(added)) {}

  Potential potential;
  const lanes::LaneOperations* operations = nullptr;
  lanes::Stencils stencils{};
  int configuration = -1;  // among the system's rest configurations; -1: the kernel is given positions

  unsigned long coloured_stencils = 0;  // stencil_version that the colouring is of
  std::vector<int> chunks;              // in order of colour
  std::vector<int> colour_start;        // into chunks
  std::vector<lanes::ChunkResult> results;

  unsigned long slotted_stencils = 0;  // stencil_version and pattern that the slots are of
  unsigned long slotted_pattern = 0;
  AlignedVector<int> slots;  // lanes::Stencils
  std::vector<unsigned char> turned;
  std::vector<int> block_start;  // per chunk, into the two below: lanes::ChunkBlocks
  std::vector<int> block_offset;
  std::vector<int> block_stride;
  std::vector<int> block_index;  // of the block in the matrix

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

  // Cuts and colours the stencils if they changed. `seen` is room for one mark per vertex.
  void colour(std::vector<int>& seen);
  // Finds the places of all blocks in the pattern; false when one is not in it.
  bool find_slots(const BlockMatrix& pattern, const std::vector<int>& block_of);
  // Whether the constant Hessian differs from that of the last call.
  bool constant_changed();
};

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

  // Every block of the matrix is written by the base, stored by the chunk that comes to it first, or in neither and
  // cleared, so that the matrix is not zeroed beforehand. Known for one pattern and one set of base blocks.
  bool first_known = false;
  std::vector<int> first_base;      // the base's blocks, by index in the matrix
  std::vector<int> cleared_column;  // block columns and scalar rows, as base_row, of the cleared blocks
  std::vector<int> cleared_row;

  AlignedVector<double> x;  // 4 per vertex
  std::vector<RestConfiguration> configurations;
  AlignedVector<double> gradient;  // 4 per vertex
  struct Room {
    AlignedVector<double> sums;
    AlignedVector<double> scratch;
    lanes::Workspace view() { return {sums.data(), scratch.data()}; }
  };
  std::vector<Room> rooms;  // per thread
  std::vector<int> seen;

  // Brings prepared data and colouring up to date.
  void prepare();
  // Brings pattern, slots and rooms up to date.
  void update_pattern();
  void size_rooms();
  void build_pattern();
  // Assembles the constant Hessians again if one of them changed; uses matrix as room.
  void update_base(Projection projection, BlockMatrix& matrix);
  void load_positions(const Eigen::Matrix3Xd& positions);
  // What a term's kernel is evaluated at: positions or displacements, 4 per vertex.
  const double* points_of(const SystemTerm& term) const;
  // Gives a term whose q is F - I a configuration that agrees with its rest positions.
  void find_configuration(SystemTerm& term);
  // Finds who writes each block first, if pattern, slots or the base's blocks changed.
  void update_first();
  // Called by all threads of a team: writes the base and clears what no chunk stores.
  void start_matrix(BlockMatrix& matrix) const;
  bool worth_threads() const;
  Evaluation sum(bool margins) const;
};

}  // namespace ergon
