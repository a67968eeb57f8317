#pragma once
// Projection of small symmetric matrices to positive semi-definite ones, one matrix per lane. Included only by files in
// runtime/lanes. It establishes that a projected matrix has no negative eigenvalue beyond rounding and that a matrix
// which had none comes back bit by bit.
//
// A matrix is N(N+1)/2 entries, the lower triangle packed by rows: entry (i, j <= i) is the ERGON_LANES adjacent
// numbers from (i*(i+1)/2 + j)*ERGON_LANES on. Arrays are aligned to 64 bytes. N is 1 to 12.

#include "runtime/lanes/projection_vector.h"

namespace ergon::lanes {
namespace {

// Replaces an eigenvalue x < 0 by zero or by -x.
enum class Negative { clamp, absolute };

// A matrix that `definite` accepts has no eigenvalue below -definite_tolerance(N) times its largest diagonal entry.
constexpr double definite_tolerance(int n) { return 4 * kShift * n; }

// Bit l is set when the matrix in lane l is certainly positive semi-definite to within definite_tolerance. A matrix
// that is not finite, or that the test cannot decide, is not set. The test is an LDL^T factorisation without pivoting
// of A + s I, s = kShift N max(A_ii): when all pivots are positive the backward error of the factorisation bounds the
// smallest eigenvalue from below (Higham 2002, Accuracy and Stability of Numerical Algorithms, theorem 10.3 and 10.7).
template <int N>
unsigned definite(const Scalar* packed);

// Replaces the negative eigenvalues of the matrices in the given lanes (bit l for lane l) and keeps the eigenvectors.
// The result is within 1e-14 (of floats 1e-5) of the exact one, and its eigenvalues are not below minus that, both
// times the norm of the matrix. Other lanes keep their bits and cost nothing, so pass only the lanes that `definite`
// did not accept. A matrix with an entry that is not finite is left as it is.
template <int N>
void project_lanes(Scalar* packed, Negative mode, unsigned lanes = kAllLanes);

// The same for two vectors of matrices, in less time than one after the other.
template <int N>
void project_lanes(Scalar* first, unsigned first_lanes, Scalar* second, unsigned second_lanes, Negative mode);

}  // namespace
}  // namespace ergon::lanes

#include "runtime/lanes/projection_definite.h"
#ifdef ERGON_SINGLE
#include "runtime/lanes/projection_single.h"
#else
#include "runtime/lanes/projection_spectrum.h"
#endif
