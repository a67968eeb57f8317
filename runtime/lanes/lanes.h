#pragma once
// Evaluation of one potential, vector block by vector block. The files in this folder are compiled once per vector
// width; they see the runtime only through the plain structs below, so that no code built for a wide machine is ever
// linked into code that runs on a narrow one.
//
// A block is W stencils, one per lane. Positions and gradients are padded to four doubles per vertex.

#include "runtime/kernel.h"

namespace ergon::lanes {

constexpr int kMaxPoints = 27;    // of a stencil or element
constexpr int kMaxCombined = 12;  // points of a stencil with weights of its own
constexpr int kMaxVectors = 5;    // 3-vectors in q
constexpr int kMaxCombinedVectors = 4;
constexpr int kProjectClamp = 0;  // what is done to negative eigenvalues; the order of ergon::Projection
constexpr int kProjectAbsolute = 1;
constexpr int kProjectNone = 2;

// All stencils of one potential, in chunks of `chunk` blocks. Within a chunk of n blocks, stencil i is in lane i/n of
// block i%n; lanes left over repeat the last stencil.
struct Stencils {
  const ErgonKernel* kernel;
  int chunk;
  int count;            // real stencils
  int points;           // per stencil
  int quadrature;       // points of quadrature per stencil
  const int* vertices;  // [block][points][W]; without a table, a density's stand in ascending order
  // A density: gradients of the shape functions in the reference element, [quadrature][q_vectors][points]; null where
  // they are constant.
  const double* table;
  // Where the table is a product over three axes with three points each, else null: [2][3][3], at point p and node i of
  // an axis the gradient at p of the polynomial that is 1 at point i and 0 at the others, then the value at p of the
  // shape function of node i; and the node of the element at i + 3*j + 9*k.
  const double* axis;
  const int* axis_nodes;
  // A density. With a table: the inverse of the map to the rest shape, [block][quadrature][q_vectors of the reference
  // element][q_vectors][W]. Without: gradients at rest, [block][quadrature][q_vectors][points - 1][W]; the last is
  // minus the sum of the others. A stencil energy: [q_vectors][points], or, where each stencil has weights of its own,
  // [block][q_vectors][points + 1][W]; the last is the sum of the others.
  const double* weights;
  // Of a membrane or line whose q is F - I: its three axes at rest, the first its tangents, [block][quadrature][9][W];
  // else null.
  const double* frames;
  const double* volumes;   // density: [block][quadrature][W]
  const double* elements;  // [block][quadrature][kernel->elements][W]
  const double* uniforms;  // [kernel->uniforms]
  // Where among the sums of its chunk the 3x3 block of points (a, b <= a) is added, at a*(a + 1)/2 + b of
  // [block][pairs][W], in doubles; behind the last for a pair with a fixed vertex and for padding.
  const int* slots;
  // [block][pairs]: bit l is set when in lane l the block's row in the matrix is that of b. Null where points ascend.
  const unsigned short* turned;
  bool combined;  // each stencil has weights of its own
  // Of a kernel in single precision, in place of elements and uniforms.
  const float* single_elements;
  const float* single_uniforms;
};

struct BlockRange {
  int first;
  int last;
};

// The blocks of the matrix that a chunk adds to, in the order of the matrix.
struct ChunkBlocks {
  int count;
  const int* offset;  // of the block's first value
  const int* stride;  // from one of its columns to the next; negative where the values are stored, not added
};

constexpr int kSumDoubles = 12;  // of one matrix block while a chunk is summed: three columns of four

// Room of one thread, aligned to 64 bytes.
struct Workspace {
  double* sums;     // kSumDoubles for each matrix block of a chunk and one more; zero before and after
  double* scratch;  // scratch_size
};

struct ChunkResult {
  double value;
  double require;   // smallest margin; -inf where a margin or the value is not finite; +inf without conditions
  long indefinite;  // Hessians that projection changed
};

// Numbers the matrix blocks that a chunk adds to.
struct ChunkNumbering {
  int free;                  // vertices of the chunk that are not fixed
  const int* place;          // by vertex: its place among these in ascending order, -1 when fixed
  const int* block;          // by place: its block row in the matrix
  int* places;               // room: [block][points][W] of one chunk
  unsigned long long* bits;  // room: free*(free + 63)/64 words, zero before and after
  int* rank;                 // room: as many
  int* slots;                // of all stencils: as in Stencils
  unsigned short* turned;    // likewise; zero before
  int* row;                  // block row and column in the matrix of every block, by column and then row
  int* column;
};

struct LaneOperations {
  int lanes;
  int (*scratch_size)(const Stencils&);  // doubles
  void (*value)(const Stencils&, BlockRange, const double* x, ChunkResult*);
  void (*gradient)(const Stencils&, BlockRange, const double* x, double* gradient, ChunkResult*);
  // Adds to gradient (unless it is null) and to the matrix values.
  void (*hessian)(const Stencils&, BlockRange, const ChunkBlocks&, const double* x, int projection, const Workspace&,
                  double* gradient, double* values, ChunkResult*);
  // Returns how many blocks there are.
  int (*number_blocks)(const Stencils&, BlockRange, const ChunkNumbering&);
  // A kernel at one vector of q (F - I where it is one of displacements), whatever it is a function of: value, smallest
  // margin, gradient and packed Hessian by q, as it is. Arrays as in runtime/kernel.h, over the kernel's numbers.
  void (*evaluate_at)(const ErgonKernel&, const void* q, const void* elements, const void* uniforms, void* value,
                      void* margin, void* gradient, void* hessian);
};

// Those there is code for, ascending. Two lanes are what every x86-64 processor has (SSE2), and ARM ones (NEON).
#if defined(__x86_64__)
constexpr int kWidths[] = {1, 2, 4, 8};
#else
constexpr int kWidths[] = {1, 2};
#endif
// The widest vectors this machine has.
int best_lanes();
// The same of floats: 1, 4, 8 or 16.
int best_single_lanes();
// Throws std::invalid_argument when this machine or build lacks that width.
const LaneOperations& lane_operations(int lanes);
// Of kernels in single precision.
const LaneOperations& single_lane_operations(int lanes);

}  // namespace ergon::lanes
