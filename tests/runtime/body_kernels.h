#pragma once
// Kernels of energies/bodies, rods/spring and contact/ground_*, written by hand in lanes of 1, so that the runtime is
// tested without the compiler. The formulas are those of the energy files.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/potential.h"

namespace ergon::body_kernels {

using Eigen::Matrix3d;
using Eigen::Vector3d;

inline Vector3d vector(const double* from) { return {from[0], from[1], from[2]}; }

inline void write(const Vector3d& from, double* to) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

inline void write_lower(const Matrix3d& from, double* to) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j <= i; ++j) to[i * (i + 1) / 2 + j] = from(i, j);
  }
}

struct Derivatives {
  double value = 0;
  Vector3d gradient = Vector3d::Zero();
  Matrix3d hessian = Matrix3d::Zero();
  double require = std::numeric_limits<double>::infinity();
};

// A law is a function (q, elements, uniforms) -> Derivatives; raw data and params are handed through as they are.
template <Derivatives (*law)(const Vector3d&, const double*, const double*), int n_raw, int n_params>
void fill(ErgonKernel& kernel) {
  kernel.abi = ERGON_KERNEL_ABI;
  kernel.lanes = 1;
  kernel.case_name = "";
  kernel.q_vectors = 1;
  kernel.params = kernel.uniforms = n_params;
  kernel.raw = kernel.elements = n_raw;
  kernel.prepare_uniforms = [](const double* params, double* u) { std::copy(params, params + n_params, u); };
  kernel.prepare_elements = [](const double* raw, const double*, double* e) { std::copy(raw, raw + n_raw, e); };
  kernel.conditions = [](const double* q, const double* e, const double* u, double* active, double* require) {
    if (active) *active = 1;
    if (require) *require = law(vector(q), e, u).require;
  };
  kernel.value = [](const double* q, const double* e, const double* u, double* value, double* require) {
    const Derivatives d = law(vector(q), e, u);
    *value = d.value;
    *require = d.require;
  };
  kernel.gradient = [](const double* q, const double* e, const double* u, double* value, double* gradient) {
    const Derivatives d = law(vector(q), e, u);
    *value = d.value;
    write(d.gradient, gradient);
  };
  kernel.hessian = [](const double* q, const double* e, const double* u, double* value, double* gradient,
                      double* hessian) {
    const Derivatives d = law(vector(q), e, u);
    *value = d.value;
    write(d.gradient, gradient);
    write_lower(d.hessian, hessian);
  };
}

inline void set_point(ErgonKernel& kernel) {
  static const double weight[] = {1};
  static const char* const names[] = {"x"};
  kernel.geometry = "point";
  kernel.points = 1;
  kernel.weights = weight;
  kernel.point_names = names;
}

inline Derivatives inertia_law(const Vector3d& x, const double* e, const double*) {
  const double stiffness = e[0] / (e[1] * e[1]);
  const Vector3d d = x - vector(e + 2);
  return {
      .value = stiffness / 2 * d.squaredNorm(), .gradient = stiffness * d, .hessian = stiffness * Matrix3d::Identity()};
}

inline Kernel inertia() {
  static const ErgonInput inputs[] = {
      {"mass", ERGON_REST, 1, 1, 0}, {"dt", ERGON_LAG, 1, 1, 1}, {"xhat", ERGON_LAG, 3, 1, 2}};
  static const ErgonKernel kernel = [] {
    ErgonKernel k{};
    fill<inertia_law, 5, 0>(k);
    set_point(k);
    k.energy = "inertia";
    k.n_inputs = 3;
    k.inputs = inputs;
    k.constant_hessian = k.psd_hessian = 1;
    return k;
  }();
  return {nullptr, &kernel};
}

inline Derivatives gravity_law(const Vector3d& x, const double* e, const double* u) {
  return {.value = -e[0] * vector(u).dot(x), .gradient = -e[0] * vector(u)};
}

inline Kernel gravity() {
  static const ErgonInput inputs[] = {{"mass", ERGON_REST, 1, 1, 0}, {"g", ERGON_PARAM, 3, 1, 0}};
  static const ErgonKernel kernel = [] {
    ErgonKernel k{};
    fill<gravity_law, 1, 3>(k);
    set_point(k);
    k.energy = "gravity";
    k.n_inputs = 2;
    k.inputs = inputs;
    k.constant_gradient = k.constant_hessian = k.zero_hessian = k.psd_hessian = 1;
    return k;
  }();
  return {nullptr, &kernel};
}

// q is x1 - x0.
inline Derivatives spring_law(const Vector3d& q, const double* e, const double* u) {
  const double k = u[0], rest = (vector(e + 3) - vector(e)).norm(), length = q.norm();
  const Vector3d n = q / length;
  const Matrix3d along = n * n.transpose();
  return {.value = k / 2 * (length - rest) * (length - rest),
          .gradient = k * (length - rest) * n,
          .hessian = k * along + k * (1 - rest / length) * (Matrix3d::Identity() - along),
          .require = rest};
}

inline Kernel spring() {
  static const double weights[] = {-1, 1};
  static const char* const names[] = {"x0", "x1"};
  static const ErgonInput inputs[] = {
      {"X0", ERGON_REST, 3, 1, 0}, {"X1", ERGON_REST, 3, 1, 3}, {"k", ERGON_PARAM, 1, 1, 0}};
  static const ErgonKernel kernel = [] {
    ErgonKernel k{};
    fill<spring_law, 6, 1>(k);
    k.energy = "spring";
    k.geometry = "edge";
    k.points = 2;
    k.weights = weights;
    k.point_names = names;
    k.n_inputs = 3;
    k.inputs = inputs;
    k.requires_ = 1;
    return k;
  }();
  return {nullptr, &kernel};
}

inline Derivatives ground_barrier_law(const Vector3d& x, const double* e, const double* u) {
  const Vector3d n = vector(u);
  const double dhat = u[4], kappa = e[0], gap = n.dot(x) - u[3], d = gap - dhat, log_ratio = std::log(gap / dhat);
  return {.value = -kappa * d * d * log_ratio,
          .gradient = -kappa * (2 * d * log_ratio + d * d / gap) * n,
          .hessian = -kappa * (2 * log_ratio + 4 * d / gap - d * d / (gap * gap)) * n * n.transpose(),
          .require = gap};
}

inline Kernel ground_barrier() {
  static const ErgonInput inputs[] = {{"n", ERGON_PARAM, 3, 1, 0},
                                      {"height", ERGON_PARAM, 1, 1, 3},
                                      {"dhat", ERGON_PARAM, 1, 1, 4},
                                      {"kappa", ERGON_LAG, 1, 1, 0}};
  static const ErgonKernel kernel = [] {
    ErgonKernel k{};
    fill<ground_barrier_law, 1, 5>(k);
    set_point(k);
    k.energy = "log_barrier:half_space";
    k.n_inputs = 4;
    k.inputs = inputs;
    k.requires_ = k.actives = 1;
    k.psd_hessian = 1;
    return k;
  }();
  return {nullptr, &kernel};
}

inline Derivatives ground_friction_law(const Vector3d& x, const double* e, const double* u) {
  const Vector3d n = vector(e + 5);
  const double mu = e[8], force = e[0], eps = u[0] * e[1];
  const Matrix3d tangent = Matrix3d::Identity() - n * n.transpose();
  const Vector3d slip = tangent * (x - vector(e + 2));
  const double s = slip.norm() / eps, scale = mu * force;
  if (s < 1e-12)
    return {.value = scale * eps / 3, .gradient = 2 * scale / eps * slip, .hessian = 2 * scale / eps * tangent};
  const Vector3d t = slip / slip.norm();
  const Matrix3d along = t * t.transpose();
  if (s >= 1) {
    return {.value = scale * eps * s, .gradient = scale * t, .hessian = scale / (eps * s) * (tangent - along)};
  }
  return {.value = scale * eps * (s * s - s * s * s / 3 + 1.0 / 3),
          .gradient = scale * (2 * s - s * s) * t,
          .hessian = scale / eps * ((2 - 2 * s) * along + (2 - s) * (tangent - along))};
}

inline Kernel ground_friction() {
  static const ErgonInput inputs[] = {{"epsv", ERGON_PARAM, 1, 1, 0},    {"fall", ERGON_PARAM, 1, 1, 1},
                                      {"force", ERGON_LAG, 1, 1, 0},     {"dt", ERGON_LAG, 1, 1, 1},
                                      {"xlag", ERGON_LAG, 3, 1, 2},      {"n", ERGON_LAG, 3, 1, 5},
                                      {"mu_static", ERGON_LAG, 1, 1, 8}, {"mu_kinetic", ERGON_LAG, 1, 1, 9}};
  static const ErgonKernel kernel = [] {
    ErgonKernel k{};
    fill<ground_friction_law, 10, 2>(k);
    set_point(k);
    k.energy = "friction";
    k.n_inputs = 8;
    k.inputs = inputs;
    k.actives = 1;
    k.psd_hessian = 1;
    return k;
  }();
  return {nullptr, &kernel};
}

inline Derivatives friction_secant_law(const Vector3d& x, const double* e, const double*) {
  const Vector3d t = vector(e + 1);
  const double stiffness = e[0], along = t.dot(x - vector(e + 4));
  return {.value = stiffness / 2 * along * along,
          .gradient = stiffness * along * t,
          .hessian = stiffness * t * t.transpose()};
}

inline Kernel friction_secant() {
  static const ErgonInput inputs[] = {
      {"stiffness", ERGON_LAG, 1, 1, 0}, {"t", ERGON_LAG, 3, 1, 1}, {"xlag", ERGON_LAG, 3, 1, 4}};
  static const ErgonKernel kernel = [] {
    ErgonKernel k{};
    fill<friction_secant_law, 7, 0>(k);
    set_point(k);
    k.energy = "friction_secant";
    k.n_inputs = 3;
    k.inputs = inputs;
    k.psd_hessian = 1;
    return k;
  }();
  return {nullptr, &kernel};
}

}  // namespace ergon::body_kernels
