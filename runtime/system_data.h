#pragma once
// What a System holds. Included by system*.cpp only.

#include <array>
#include <cstdint>
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

// The blocks of the matrix that a vertex moves with, and its weights among them: one of its own, or the four of a body.
struct VertexBlocks {
  int first = 0;
  int count = 1;
  std::array<double, 4> weights{1, 0, 0, 0};
};

// Whose degrees of freedom the vertices have. Numbers stand for vertices: its block row for one that is free, behind
// all of these for one that is carried.
struct SystemNumbers {
  std::vector<int> block_of;  // per vertex; -1 when it is fixed or carried
  std::vector<int> number;    // per vertex; -1 when it is fixed
  int free = 0;
  Carriers carriers;
  // The rest is empty where nothing is carried.
  std::vector<int> lead;           // per vertex: one vertex for all that have blocks in common
  std::vector<int> first_block;    // per body
  std::vector<int> body_of_block;  // -1: not of a control point

  bool carried(int number) const { return number >= free; }
  VertexBlocks blocks_of(int number) const;
};

// The way of a chunk's Hessian from pairs of vertices to the matrix, J^T H J, of which sums over the vertices of a body
// are taken first on the one side, then on the other. All counts are in blocks of kSumDoubles.
struct CarriedPair {  // a sum over stencils, of two vertices
  int half = 0;       // where it goes to: `columns` blocks
  int columns = 1;
  bool turned = false;  // its transpose
  bool stored = false;  // not added: the first that goes there
  std::array<double, 4> weights{};
};
struct CarriedHalf {  // of a vertex and a body
  int from = 0;
  int whole = 0;  // rows*columns blocks
  int rows = 1, columns = 1;
  bool stored = false;
  std::array<double, 4> weights{};
};
struct CarriedWhole {  // of two bodies, or of one: then half of it, to which the transpose is added
  int from = 0;
  int rows = 1, columns = 1;
  bool symmetric = false;
  int places = 0;  // into SystemChunk::places: of all blocks, or of those with column <= row
};

// Room for finding where carried pairs go: pairs of numbers, two in each word.
struct CarryRoom {
  using Pairs = std::vector<std::uint64_t>;
  Pairs halves, half_keys, wholes, whole_keys, blocks, block_keys;
  std::vector<char> reached;
};

// Room of one thread.
struct SystemRoom {
  AlignedVector<double> sums;
  AlignedVector<double> pairs, halves, wholes;  // blocks on the way of carried vertices
  AlignedVector<double> scratch;
  std::vector<int> place;  // per vertex of the system
  std::vector<int> block, places, rank, row, column;
  std::vector<unsigned long long> bits;
  CarryRoom carry;
  lanes::Workspace view() { return {sums.data(), scratch.data()}; }
};

// What one chunk of a term's stencils touches.
struct SystemChunk {
  std::vector<int> vertices;        // of the system, ascending, each once
  std::vector<int> row, column;     // of the matrix blocks it adds to, by column and then row; each once
  std::vector<int> index;           // of these in the pattern
  std::vector<int> offset, stride;  // lanes::ChunkBlocks
  // Where it has carried vertices, else empty: what is summed is the blocks of pairs of vertices.
  std::vector<CarriedPair> pairs;
  std::vector<CarriedHalf> halves;
  std::vector<CarriedWhole> wholes;
  std::vector<int> places;  // into row and column
  size_t sums() const { return pairs.empty() ? row.size() : pairs.size(); }
};

// One potential of a system with what evaluation needs beside its own data. Its stencils are cut into chunks, and the
// chunks coloured so that no two of a colour share a vertex: colours follow one another, the chunks of one are
// independent. What depends on the list of stencils alone is made apart from what depends on the pattern.
struct SystemTerm {
  explicit SystemTerm(Potential added) : potential(std::move(added)) {}

  Potential potential;
  // A potential whose Hessian is that of a kernel of its own (Kernel::curvature) is two terms.
  bool gives_gradient = true;
  bool gives_hessian = true;
  const lanes::LaneOperations* operations = nullptr;
  lanes::Stencils stencils{};
  int configuration = -1;                   // among the system's rest configurations; -1: the kernel is given positions
  std::vector<lanes::ChunkResult> results;  // per chunk
  std::vector<SystemChunk> parts;           // per chunk; more when there once were

  unsigned long checked_stencils = 0;   // stencil_version whose vertices are known to be the system's
  unsigned long coloured_stencils = 0;  // stencil_version that the colouring is of
  std::vector<int> chunks;              // in order of colour
  std::vector<int> colour_start;        // into chunks
  std::vector<int> colour_of;           // per chunk

  unsigned long numbered_stencils = 0;  // stencil_version and fixed vertices that the slots are of
  unsigned long numbered_fixed = 0;
  AlignedVector<int> slots;  // lanes::Stencils
  std::vector<unsigned short> turned;
  unsigned long placed_pattern = 0;  // that the chunks' blocks were found in

  // A constant Hessian: the versions that the assembled base is made of.
  unsigned long based_stencils = 0;
  unsigned long based_params = 0;
  unsigned long based_lags = 0;
  AlignedVector<double> q_hessians;  // kept when there is a lag that they might depend on
  long indefinite = 0;

  Potential::Impl& data() { return *potential.impl; }
  const Potential::Impl& data() const { return *potential.impl; }
  const ErgonKernel& kernel() const { return *potential.impl->kernel.table; }
  bool in_matrix() const { return gives_hessian && !kernel().zero_hessian; }
  bool constant() const { return in_matrix() && kernel().constant_hessian && kernel().single == nullptr; }
  bool assembled() const { return in_matrix() && !constant(); }
  lanes::BlockRange range(int chunk) const;
  lanes::ChunkBlocks blocks(int chunk) const;
  size_t largest_chunk() const;  // in matrix blocks; what it may be at most where lists change

  // Takes a changed list over. Throws InputError for a vertex that is not one of the system's.
  void check(int vertices);
  // Colours the chunks if the list changed. `lead`: SystemNumbers.
  void colour(std::vector<SystemRoom>& rooms, std::vector<unsigned long long>& taken, const std::vector<int>& lead);
  // Numbers the matrix blocks of every chunk if the list or the fixed vertices changed; whether it did.
  bool number(std::vector<SystemRoom>& rooms, const SystemNumbers& numbers, unsigned long fixed);
  // Finds the places of all blocks in the pattern; how many are not in it.
  long find(const BlockPattern& pattern);
  // Whether the constant Hessian differs from that of the last call.
  bool constant_changed();

 private:
  void list_vertices(std::vector<SystemRoom>& rooms);
  static void carry_pairs(SystemRoom& room, int count, const SystemNumbers& numbers, SystemChunk& part);
};

// A potential that resists motion in proportion to its stiffness.
struct StiffnessDamping {
  // A 3x3 block of free vertices in the values of the two matrices.
  struct Block {
    ptrdiff_t from = 0;
    int from_stride = 0;
    ptrdiff_t to = 0;
    int to_stride = 0;
  };

  double time;  // s
  // The potential by itself, over all vertices that are not carried: its matrix has the columns of fixed ones too.
  System alone;
  std::vector<int> vertex_of;  // per block row of it
  BlockMatrix stiffness = {};  // N/m; without rows until it has been lagged
  std::vector<Block> places = {};
  unsigned long placed_pattern = 0, placed_stiffness = 0;  // that the blocks were found in

  void find(const System::Impl& whole);
};

// Coupled mass with its lags, and where its entries go in the matrix.
struct CoupledInertia {
  struct Block {
    ptrdiff_t at = 0;
    int stride = 0;
    double mass = 0, drag = 0;  // kg, kg/s
  };

  CoupledMass of;
  Eigen::Matrix3Xd xhat, xlag;  // m
  double dt = 0, lag_dt = 0;    // s; 0: not lagged
  std::vector<Block> blocks = {};
  unsigned long numbered_fixed = 0;       // that the pattern is of
  double based_dt = 0, based_lag_dt = 0;  // that the assembled base is made of

  bool renumbered(unsigned long fixed_version);
  void add_blocks(const SystemNumbers& numbers, PatternBuilder& builder) const;
  void find(const SystemNumbers& numbers, const BlockPattern& pattern);
  bool rescaled();
  void assemble(BlockMatrix& base) const;
};

struct System::Impl {
  int vertices = 0;
  std::vector<char> fixed;
  SystemNumbers numbers;
  std::vector<Guide> guides;
  unsigned long fixed_version = 1;  // of both
  std::vector<SystemTerm> terms;
  std::vector<size_t> first_terms;  // of each potential

  // Couplings that a list of stencils no longer has stay in the pattern for a while: they may come back, and a new
  // pattern is a new analysis for the linear solver.
  std::shared_ptr<BlockPattern> pattern;  // null: not known
  std::shared_ptr<BlockPattern> spare;    // room of the next one
  PatternBuilder builder;
  std::vector<char> recent;  // per block: used since the pattern was made
  int unused_for = 0;        // changes of lists since when some block was not

  // The sum of the constant Hessians.
  bool base_known = false;
  Projection base_projection = Projection::clamp;
  std::shared_ptr<BlockPattern> base_pattern;  // null without such Hessians
  BlockMatrix base;
  std::vector<int> base_row, base_column;  // of its blocks
  std::vector<int> base_index;             // of its blocks in the pattern

  // Every block of the matrix is written by the base, stored by the chunk that comes to it first, or in neither and
  // cleared, so that the matrix is not zeroed beforehand.
  bool first_known = false;
  std::vector<char> used;           // per block: in the base or in some chunk
  std::vector<int> cleared_column;  // block columns and numbers of the cleared blocks
  std::vector<int> cleared_index;

  CoupledInertia coupled;

  std::vector<StiffnessDamping> damping;
  Eigen::Matrix3Xd damped_from;  // m
  double damped_dt = 0;          // s; 0: no motion has been lagged

  AlignedVector<double> x;  // 4 per vertex
  std::vector<RestConfiguration> configurations;
  AlignedVector<double> gradient;             // 4 per vertex
  std::vector<SystemRoom> rooms;              // per thread
  std::vector<int> pair_offset, pair_stride;  // lanes::ChunkBlocks of SystemRoom::pairs
  std::vector<unsigned long long> taken;      // per vertex: room of the colouring

  // Brings prepared data up to date, and the colouring where it is `coloured`.
  void prepare(bool coloured);
  // Brings patterns, slots and rooms up to date.
  void update_pattern();
  void update_base_pattern();
  long find_blocks(bool everywhere);
  void make_pattern(bool forget);
  void size_rooms();
  // Assembles the constant Hessians again if one of them changed.
  void update_base(Projection projection);
  void load_positions(const Eigen::Matrix3Xd& positions);
  // The gradient of the terms t with wanted(t), 3 x vertices.
  template <class F>
  void sum_gradients(const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& sum, F wanted);
  // What a term's kernel is evaluated at: positions or displacements, 4 per vertex.
  const double* points_of(const SystemTerm& term) const;
  // Gives a term whose q is F - I a configuration that agrees with its rest positions.
  void find_configuration(SystemTerm& term);
  // Adds the Hessians of a chunk to the values of a matrix in whose pattern its blocks were found, and the gradients
  // (unless null).
  void add_chunk(SystemTerm& term, int chunk, Projection projection, SystemRoom& room, double* gradients,
                 double* values, lanes::ChunkResult* result);
  void number_vertices();
  // Finds who writes each block first, if pattern or slots changed.
  void update_first();
  // Called by all threads of a team: writes the base and clears what no chunk stores.
  void start_matrix(BlockMatrix& matrix) const;
  void guide_matrix(BlockMatrix& matrix) const;
  void damp_matrix(BlockMatrix& matrix);
  bool worth_threads() const;
  void add_term(Potential potential, bool gives_gradient, bool gives_hessian);
  Evaluation sum(bool margins, bool hessians = false) const;
};

}  // namespace ergon
