#pragma once
// Evaluation of one potential, vector block by vector block. The files in this folder are compiled once per vector
// width; they see the runtime only through the plain structs below, so that no code built for a wide machine is ever
// linked into code that runs on a narrow one.
//
// A block is W stencils, one per lane. Positions and gradients are padded to four doubles per vertex.

#include "runtime/kernel.h"

namespace ergon::lanes {

constexpr int kMaxPoints = 27;    // of a stencil or element
constexpr int kMaxVectors = 4;    // 3-vectors in q
constexpr int kFixedSlot = -1;    // a pair with a fixed vertex
constexpr int kProjectClamp = 0;  // what is done to negative eigenvalues; the order of ergon::Projection
constexpr int kProjectAbsolute = 1;
constexpr int kProjectNone = 2;

// All stencils of one potential, padded to whole blocks by repeating the last one.
struct Stencils {
  const ErgonKernel* kernel;
  int count;       // real stencils
  int points;      // per stencil
  int quadrature;  // points of quadrature per stencil
  const int* vertices;     // [block][points][W]; a density's points stand in ascending order of vertex
  const double* weights;   // density: [block][quadrature][q_vectors][points - 1][W]; the last is minus their sum
  const double* volumes;   // density: [block][quadrature][W]
  const double* elements;  // [block][kernel->elements][W]
  const double* uniforms;  // [kernel->uniforms]
  // Where the 3x3 block of points (a, b <= a) is added, at a*(a + 1)/2 + b of [block][pairs][W]: kFixedSlot, or
  // 2*(offset/3) + t, where t = 1 when the block's row in the matrix is that of b.
  const int* slots;
  const int* strides;  // [block][points][W]: doubles from column to column of the point's block column
};

struct BlockRange {
  int first;
  int last;
};

struct ChunkResult {
  double value;
  double require;   // smallest margin; -inf where a margin or the value is not finite; +inf without conditions
  long indefinite;  // Hessians that projection changed
};

struct LaneOperations {
  int lanes;
  // Doubles of scratch (aligned to 64 bytes) that `hessian` needs.
  int (*scratch_size)(const Stencils&);
  void (*value)(const Stencils&, BlockRange, const double* x, ChunkResult*);
  void (*gradient)(const Stencils&, BlockRange, const double* x, double* gradient, ChunkResult*);
  // Adds to gradient (unless it is null) and to the matrix values.
  void (*hessian)(const Stencils&, BlockRange, const double* x, int projection, double* scratch, double* gradient,
                  double* values, ChunkResult*);
};

// The widest vectors this machine has.
int best_lanes();
// Throws std::invalid_argument when this machine or build lacks that width.
const LaneOperations& lane_operations(int lanes);

}  // namespace ergon::lanes
