#pragma once
// The projection of floats, declared in projection.h: small matrices by their closed forms; larger ones in doubles,
// half of the lanes at a time, by the code for vectors of as many bytes.

#include "runtime/lanes/projection_small.h"
#include "runtime/lanes/projection_table.h"

namespace ergon::lanes {
namespace {

template <int N>
inline void project_in_doubles(float* packed, bool absolute, unsigned lanes) {
  constexpr int kEntries = N * (N + 1) / 2, kParts = kWidth == 1 ? 1 : 2, kHalf = kWidth / kParts;
  alignas(64) double parts[kParts][kEntries * kHalf];
  for (int part = 0; part < kParts; ++part) {
    for (int e = 0; e < kEntries; ++e) {
      for (int l = 0; l < kHalf; ++l) parts[part][e * kHalf + l] = packed[e * kWidth + part * kHalf + l];
    }
  }
  const ProjectionTable& doubles = projection_table(kHalf);
  if (kParts == 1) {
    doubles.project[N](parts[0], absolute, lanes);
  } else {
    doubles.project_two[N](parts[0], lanes & ((1u << kHalf) - 1), parts[kParts - 1], lanes >> kHalf, absolute);
  }
  for (unsigned rest = lanes; rest != 0; rest &= rest - 1) {
    const int l = __builtin_ctz(rest);
    for (int e = 0; e < kEntries; ++e) {
      packed[e * kWidth + l] = static_cast<float>(parts[l / kHalf][e * kHalf + l % kHalf]);
    }
  }
}

template <int N>
void project_lanes(Scalar* packed, Negative mode, unsigned lanes) {
  const bool absolute = mode == Negative::absolute;
  if (lanes == 0) return;
  if constexpr (N == 1) {
    project_1(packed, absolute, lanes);
  } else if constexpr (N == 2) {
    project_2(packed, absolute, lanes);
  } else if constexpr (N == 3) {
    project_3(packed, absolute, lanes);
  } else {
    project_in_doubles<N>(packed, absolute, lanes);
  }
}

template <int N>
void project_lanes(Scalar* first, unsigned first_lanes, Scalar* second, unsigned second_lanes, Negative mode) {
  project_lanes<N>(first, mode, first_lanes);
  project_lanes<N>(second, mode, second_lanes);
}

}  // namespace
}  // namespace ergon::lanes
