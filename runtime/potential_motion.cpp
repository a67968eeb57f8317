// What laws see of a motion beside positions: F at the start of a step, and lags that they renew themselves.

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "runtime/potential_data.h"

namespace ergon {
namespace {

// The components of q, or of F, in one lane of one point of quadrature: 3-vectors, one after the other.
using LaneVectors = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, lanes::kMaxVectors>;

// Positions of the points of one stencil.
Eigen::Matrix3Xd points_of(const Potential::Impl& d, size_t block, size_t lane, const Eigen::Matrix3Xd& x) {
  const auto width = static_cast<size_t>(d.lanes), n = static_cast<size_t>(d.points);
  Eigen::Matrix3Xd out(3, d.points);
  for (size_t a = 0; a < n; ++a)
    out.col(static_cast<Eigen::Index>(a)) = x.col(d.vertices[(block * n + a) * width + lane]);
  return out;
}

// sum_a w_ka x_a, of a density F.
LaneVectors weighted_points(const Potential::Impl& d, size_t block, size_t point, size_t lane,
                            const Eigen::Matrix3Xd& points) {
  const auto width = static_cast<size_t>(d.lanes), vectors = static_cast<size_t>(d.kernel->q_vectors);
  const auto n = static_cast<size_t>(d.points), place = block * static_cast<size_t>(d.quadrature) + point;
  const auto column = [](size_t k) { return static_cast<Eigen::Index>(k); };
  LaneVectors out = LaneVectors::Zero(3, d.kernel->q_vectors);
  if (!d.kernel->density) {
    const bool own = d.combined;
    for (size_t k = 0; k < vectors; ++k) {
      for (size_t a = 0; a < n; ++a) {
        const double weight =
            own ? d.weights[(block * vectors + k) * (n + 1) * width + a * width + lane] : d.weights[k * n + a];
        out.col(column(k)) += weight * points.col(column(a));
      }
    }
  } else if (d.table.empty()) {
    const double* weights = d.weights.data() + place * vectors * (n - 1) * width + lane;
    for (size_t k = 0; k < vectors; ++k) {
      for (size_t a = 0; a + 1 < n; ++a, weights += width)
        out.col(column(k)) += *weights * (points.col(column(a)) - points.col(column(n - 1)));
    }
  } else {
    const double* map = d.weights.data() + place * vectors * vectors * width + lane;
    for (size_t j = 0; j < vectors; ++j) {
      Eigen::Vector3d by_axis = Eigen::Vector3d::Zero();
      for (size_t a = 0; a < n; ++a) by_axis += d.table[(point * vectors + j) * n + a] * points.col(column(a));
      for (size_t k = 0; k < vectors; ++k) out.col(column(k)) += map[(j * vectors + k) * width] * by_axis;
    }
  }
  return out;
}

// q as the kernel wants it, of what weighted_points gave.
void to_kernel(const Potential::Impl& d, size_t block, size_t point, size_t lane, LaneVectors& q) {
  if (!d.kernel->displacement) return;
  if (!d.frames.empty()) {
    const auto width = static_cast<size_t>(d.lanes);
    const double* axis = d.frames.data() + (block * static_cast<size_t>(d.quadrature) + point) * 9 * width + lane;
    Eigen::Matrix3d axes;
    for (size_t i = 0; i < 9; ++i) axes.data()[i] = axis[i * width];
    q = (axes.transpose() * q).eval();
  }
  for (Eigen::Index k = 0; k < q.cols(); ++k) q(k, k) -= 1;
}

}  // namespace

std::vector<double> Potential::deformation(const Eigen::Matrix3Xd& x) const {
  const Impl& d = *impl;
  const auto points = static_cast<size_t>(d.quadrature), size = static_cast<size_t>(3 * d.kernel->q_vectors);
  std::vector<double> out(static_cast<size_t>(d.count) * points * size);
#pragma omp parallel for schedule(static) if (d.count > 4096)
  for (size_t i = 0; i < d.lane_stencil.size(); ++i) {
    const size_t block = i / static_cast<size_t>(d.lanes), lane = i % static_cast<size_t>(d.lanes);
    const Eigen::Matrix3Xd at = points_of(d, block, lane, x);
    for (size_t p = 0; p < points; ++p) {
      const LaneVectors F = weighted_points(d, block, p, lane, at);
      std::copy_n(F.data(), size, out.data() + (static_cast<size_t>(d.lane_stencil[i]) * points + p) * size);
    }
  }
  return out;
}

StencilData Potential::renewed(const Eigen::Matrix3Xd& x) const {
  Impl& d = *impl;
  d.prepare();
  const ErgonKernel& k = *d.kernel.table;
  const auto points = static_cast<size_t>(d.quadrature), width = static_cast<size_t>(d.lanes);
  const auto count = static_cast<size_t>(d.count), size = static_cast<size_t>(3 * k.q_vectors);
  StencilData out;
  std::vector<std::vector<double>*> values;
  std::vector<size_t> sizes;
  size_t all = 0;
  for (int i = 0; i < k.n_updates; ++i) {
    const ErgonInput& input = k.inputs[k.updates[i]];
    sizes.push_back(static_cast<size_t>(size_of(input)));
    all += sizes.back();
    values.push_back(&out[input.name]);
    values.back()->resize(count * points * sizes.back());
  }
#pragma omp parallel if (d.count > 4096)
  {
    AlignedVector<double> q(size * width), renewed(std::max<size_t>(all, 1) * width);
#pragma omp for schedule(static)
    for (size_t place = 0; place < static_cast<size_t>(d.blocks()) * points; ++place) {
      const size_t block = place / points, p = place % points;
      for (size_t l = 0; l < width; ++l) {
        LaneVectors at = weighted_points(d, block, p, l, points_of(d, block, l, x));
        to_kernel(d, block, p, l, at);
        for (size_t c = 0; c < size; ++c) q[c * width + l] = at.data()[c];
      }
      k.update(q.data(), d.elements.data() + place * static_cast<size_t>(k.elements) * width, d.uniforms.data(),
               renewed.data());
      for (size_t l = 0; l < width; ++l) {
        const size_t site = static_cast<size_t>(d.lane_stencil[block * width + l]) * points + p;
        const double* from = renewed.data() + l;
        for (size_t i = 0; i < values.size(); ++i) {
          for (size_t c = 0; c < sizes[i]; ++c, from += width) (*values[i])[site * sizes[i] + c] = *from;
        }
      }
    }
  }
  return out;
}

}  // namespace ergon
