// The three evaluations of a range of blocks, for one vector width.

#include "runtime/lanes/evaluate_differences.h"
#include "runtime/lanes/evaluate_hessian.h"
#include "runtime/lanes/evaluate_isotropic.h"
#include "runtime/lanes/evaluate_parts.h"
#include "runtime/lanes/number_blocks.h"
#include "runtime/lanes/stretch_frame.h"

namespace ergon::lanes {

#define ERGON_JOIN(a, b) a##b
#ifdef ERGON_SINGLE
#define ERGON_OPERATIONS(width) ERGON_JOIN(single_operations_, width)
#else
#define ERGON_OPERATIONS(width) ERGON_JOIN(operations_, width)
#endif
const LaneOperations& ERGON_OPERATIONS(ERGON_LANES)();

namespace {

constexpr double kInfinity = __builtin_inf();

constexpr int kAhead = 3;  // blocks

// Sums values and finds the smallest margin over the real lanes.
struct Tally {
  double value = 0;
  double require = kInfinity;

  void add(Real values, int count) {
    alignas(64) Scalar lane[kWidth];
    store(lane, values);
    for (int l = 0; l < count; ++l) value += lane[l];
  }
  void limit(const Scalar* margins, int count) {
    for (int l = 0; l < count; ++l) {
      if (!(margins[l] >= require)) require = margins[l] == margins[l] ? margins[l] : -kInfinity;
    }
  }
  ChunkResult result(long indefinite) const {
    const bool finite = __builtin_isfinite(value);
    return {value, finite ? require : -kInfinity, indefinite};
  }
};

#ifdef ERGON_SINGLE
using Entries = ErgonSingle;
#else
using Entries = ErgonKernel;
#endif

// At point p of quadrature of a block, where the kernel is a density in principal stretches.
template <class S>
auto stretch_kernel(const Stencils& s, int block, int p) {
  static_assert(S::kDensity);
  return StretchKernel<Entries, S::kVectors>{entries_of(s), s.kernel->displacement != 0, data_of(s, block, p),
                                             uniforms_of(s)};
}

template <class S>
bool in_stretches(const Stencils& s) {
  return S::kDensity && s.kernel->stretches != 0;
}

template <class S>
void kernel_value(const Stencils& s, int block, int p, const Scalar* q, Scalar* value, Scalar* margin) {
  if constexpr (S::kDensity) {
    if (in_stretches<S>(s)) return stretch_kernel<S>(s, block, p).value(q, value, margin);
  }
  entries_of(s).value(q, data_of(s, block, p), uniforms_of(s), value, margin);
}

template <class S>
void kernel_gradient(const Stencils& s, int block, int p, const Scalar* q, Scalar* value, Scalar* by_q) {
  if constexpr (S::kDensity) {
    if (in_stretches<S>(s)) return stretch_kernel<S>(s, block, p).gradient(q, value, by_q);
  }
  entries_of(s).gradient(q, data_of(s, block, p), uniforms_of(s), value, by_q);
}

template <class S>
void value_of(const Stencils& s, BlockRange range, const double* x, ChunkResult* result) {
  Tally tally;
  alignas(64) Scalar q[S::kSize * kWidth], value[kWidth], margin[kWidth];
  Vector3 points[S::kMost];
  for (int block = range.first; block < range.last; ++block) {
    const int count = lanes_of(s, block);
    if (block + kAhead < range.last) prefetch_block<S>(s, block + kAhead);
    gather_points<S>(s, block, x, points);
    Real sum = splat(0);
    for (int p = 0; p < s.quadrature; ++p) {
      const Weights<S> w(s, block, p);
      form_q<S>(s, w, points, q);
      Frame<S>(s, block, p).to_element(q);
      kernel_value<S>(s, block, p, q, value, margin);
      sum += w.times_volume(load(value));
      if (s.kernel->requires_ > 0) tally.limit(margin, count);
    }
    tally.add(sum, count);
  }
  *result = tally.result(0);
}

template <class S>
void gradient_of(const Stencils& s, BlockRange range, const double* x, double* gradient, ChunkResult* result) {
  Tally tally;
  alignas(64) Scalar q[S::kSize * kWidth], value[kWidth], by_q[S::kSize * kWidth];
  Vector3 points[S::kMost], by_point[S::kMost];
  const int n = S::points(s);
  for (int block = range.first; block < range.last; ++block) {
    const int count = lanes_of(s, block);
    if (block + kAhead < range.last) prefetch_block<S>(s, block + kAhead);
    gather_points<S>(s, block, x, points);
    for (int a = 0; a < n; ++a) by_point[a] = {};
    Real sum = splat(0);
    for (int p = 0; p < s.quadrature; ++p) {
      const Weights<S> w(s, block, p);
      form_q<S>(s, w, points, q);
      const Frame<S> frame(s, block, p);
      frame.to_element(q);
      kernel_gradient<S>(s, block, p, q, value, by_q);
      frame.to_space(by_q);
      sum += w.times_volume(load(value));
      chain_gradient<S>(s, w, by_q, by_point);
    }
    tally.add(sum, count);
    scatter_points<S>(s, block, count, by_point, gradient);
  }
  *result = tally.result(0);
}

// Numbers of q-Hessians that are worked on at a time: they stay in the second-level cache.
constexpr int kBatch = 98304 / sizeof(Scalar);

template <class S>
int batch_of(const Stencils& s) {
  int blocks = kBatch / (S::kPacked * kWidth * s.quadrature);
  if (blocks * s.quadrature > ProjectionBatch<S::kSize>::kCapacity) {
    blocks = ProjectionBatch<S::kSize>::kCapacity / s.quadrature;
  }
  return blocks < 1 ? 1 : blocks;
}

template <class S>
int scratch_of(const Stencils& s) {
  const int n = S::points(s);
  return batch_of<S>(s) * s.quadrature * S::kPacked * kWidth + 9 * kWidth * (n * (n + 1) / 2) + element_room<S>(s);
}

template <class S>
void hessian_of(const Stencils& s, BlockRange range, const ChunkBlocks& blocks, const double* x, int projection,
                const Workspace& room, double* gradient, double* values, ChunkResult* result) {
  Tally tally;
  alignas(64) Scalar q[S::kSize * kWidth], value[kWidth], by_q[S::kSize * kWidth];
  Vector3 points[S::kMost], by_point[S::kMost];
  const int n = S::points(s), pairs = n * (n + 1) / 2, batch = batch_of<S>(s);
  const Parts parts = parts_of<S>(s);
  const int size = (parts.count > 0 ? parts.first[parts.count] : S::kPacked) * kWidth;
  const bool known = projection != kProjectNone && entries_of(s).projected != nullptr;
  const bool project = projection != kProjectNone && !s.kernel->psd_hessian && !known;
  const bool closed_form = project && entries_of(s).principal != nullptr;
  const Negative mode = projection == kProjectAbsolute ? Negative::absolute : Negative::clamp;
  ProjectionBatch<S::kSize> indefinite(mode);
  PartProjection indefinite_parts(mode);
  const Differences differences = find_differences<S>(s);
  alignas(64) Scalar replaced[kWidth];
  long changed = 0;
  Scalar* const scratch = reinterpret_cast<Scalar*>(room.scratch);
  Scalar* element = scratch + static_cast<long>(batch) * s.quadrature * size;
  for (int first = range.first; first < range.last; first += batch) {
    const int last = first + batch < range.last ? first + batch : range.last;
    Scalar* packed = scratch;
    for (int block = first; block < last; ++block) {
      const int count = lanes_of(s, block);
      if (block + kAhead < range.last) prefetch_block<S>(s, block + kAhead);
      gather_points<S>(s, block, x, points);
      for (int a = 0; a < n; ++a) by_point[a] = {};
      Real sum = splat(0);
      for (int p = 0; p < s.quadrature; ++p, packed += size) {
        const Weights<S> w(s, block, p);
        form_q<S>(s, w, points, q);
        const Frame<S> frame(s, block, p);
        frame.to_element(q);
        if (known) {
          const Scalar negative = mode == Negative::absolute ? 1 : 0;
          entries_of(s).projected(q, data_of(s, block, p), uniforms_of(s), negative, value, by_q, packed, replaced);
          changed += __builtin_popcount(bits(less(splat(0), load(replaced))) & ((1u << count) - 1));
        } else if (in_stretches<S>(s)) {
          if constexpr (S::kDensity)
            changed += __builtin_popcount(
                stretch_kernel<S>(s, block, p).hessian(q, project, mode, value, by_q, packed) & ((1u << count) - 1));
          frame.hessian_to_space(parts, packed);
        } else if (closed_form) {
          entries_of(s).gradient(q, data_of(s, block, p), uniforms_of(s), value, by_q);
          changed += closed_form_hessian<S>(s, block, p, count, frame, q, mode, packed);
        } else {
          entries_of(s).hessian(q, data_of(s, block, p), uniforms_of(s), value, by_q, packed);
          frame.hessian_to_space(parts, packed);
          if (project && parts.count > 0) {
            indefinite_parts.add(parts, packed, (1u << count) - 1);
          } else if (project) {
            indefinite.add(packed, ~definite<S::kSize>(packed) & ((1u << count) - 1));
          }
        }
        sum += w.times_volume(load(value));
        frame.to_space(by_q);
        chain_gradient<S>(s, w, by_q, by_point);
      }
      tally.add(sum, count);
      if (gradient != nullptr) scatter_points<S>(s, block, count, by_point, gradient);
    }
    indefinite.run();
    if (parts.count > 0) indefinite_parts.run();
    packed = scratch;
    for (int block = first; block < last; ++block, packed += s.quadrature * size) {
      if (block + 1 < last) prefetch(s.slots + (block + 1L) * pairs * kWidth, 4L * kWidth * pairs);
      if (parts.count > 0) {
        part_matrix<S>(s, parts, block, packed, element, element + 9L * kWidth * pairs);
      } else if (differences.apply) {
        difference_matrix<S>(differences, packed, element);
      } else {
        element_matrix<S>(s, block, packed, element, element + 9L * kWidth * pairs);
      }
      add_element<S>(s, block, element, room.sums);
    }
  }
  flush_sums(room.sums, blocks, values);
  *result = tally.result(changed + indefinite.changed() + indefinite_parts.changed());
}

template <int Q>
void evaluate_stretches(const ErgonKernel& k, const Scalar* q, const Scalar* e, const Scalar* u, Scalar* value,
                        Scalar* margin, Scalar* by_q, Scalar* packed) {
#ifdef ERGON_SINGLE
  const StretchKernel<Entries, Q> kernel{*k.single, k.displacement != 0, e, u};
#else
  const StretchKernel<Entries, Q> kernel{k, k.displacement != 0, e, u};
#endif
  kernel.value(q, value, margin);
  kernel.hessian(q, false, Negative::clamp, value, by_q, packed);
}

void evaluate_at(const ErgonKernel& k, const void* q_, const void* e_, const void* u_, void* value_, void* margin_,
                 void* by_q_, void* packed_) {
  const auto *q = static_cast<const Scalar*>(q_), *e = static_cast<const Scalar*>(e_),
             *u = static_cast<const Scalar*>(u_);
  auto *value = static_cast<Scalar*>(value_), *margin = static_cast<Scalar*>(margin_),
       *by_q = static_cast<Scalar*>(by_q_), *packed = static_cast<Scalar*>(packed_);
  if (k.stretches != 0) {
    if (k.q_vectors == 3) return evaluate_stretches<3>(k, q, e, u, value, margin, by_q, packed);
    if (k.q_vectors == 2) return evaluate_stretches<2>(k, q, e, u, value, margin, by_q, packed);
    return evaluate_stretches<1>(k, q, e, u, value, margin, by_q, packed);
  }
#ifdef ERGON_SINGLE
  const Entries& entries = *k.single;
#else
  const Entries& entries = k;
#endif
  entries.value(q, e, u, value, margin);
  entries.hessian(q, e, u, value, by_q, packed);
}

const LaneOperations kOperations = {
    kWidth,
    [](const Stencils& s) { return with_shape(s, [&]<class S>(S) { return scratch_of<S>(s); }); },
    [](const Stencils& s, BlockRange range, const double* x, ChunkResult* result) {
      with_shape(s, [&]<class S>(S) { value_of<S>(s, range, x, result); });
    },
    [](const Stencils& s, BlockRange range, const double* x, double* gradient, ChunkResult* result) {
      with_shape(s, [&]<class S>(S) { gradient_of<S>(s, range, x, gradient, result); });
    },
    [](const Stencils& s, BlockRange range, const ChunkBlocks& blocks, const double* x, int projection,
       const Workspace& room, double* gradient, double* values, ChunkResult* result) {
      with_shape(s,
                 [&]<class S>(S) { hessian_of<S>(s, range, blocks, x, projection, room, gradient, values, result); });
    },
    number_chunk_blocks,
    evaluate_at};

}  // namespace

const LaneOperations& ERGON_OPERATIONS(ERGON_LANES)() { return kOperations; }

}  // namespace ergon::lanes
