#pragma once
// Small scenes of point masses, springs and ground for the tests of the solver.

#include <memory>
#include <numeric>

#include "runtime/contact/ground.h"
#include "runtime/solver/time_step.h"
#include "tests/runtime/body_kernels.h"

namespace ergon {

struct BodyScene {
  State state;
  Eigen::VectorXd mass;
  System system;
  std::unique_ptr<GroundContact> ground;
  std::unique_ptr<TimeStepper> stepper;
  Eigen::Vector3d g;

  BodyScene(const Eigen::Matrix3Xd& x, const Eigen::VectorXd& masses, const Eigen::Vector3d& gravity,
            const std::vector<char>& fixed = {}, bool inert = true)
      : mass(masses), system(static_cast<int>(x.cols())), g(gravity) {
    state.x = x;
    state.v.setZero(3, x.cols());
    if (!fixed.empty()) system.set_fixed(fixed);
    std::vector<int> points(static_cast<size_t>(x.cols()));
    std::iota(points.begin(), points.end(), 0);
    const std::vector<double> m(masses.begin(), masses.end());
    if (inert) system.add(Potential::on_stencils("inertia", body_kernels::inertia(), points, x, {}, {{"mass", m}}));
    system.add(Potential::on_stencils("gravity", body_kernels::gravity(), points, x, {{"g", {g[0], g[1], g[2]}}},
                                      {{"mass", m}}));
  }

  void add_springs(const std::vector<int>& edges, double k, const Eigen::Matrix3Xd& X) {
    system.add(Potential::on_stencils("spring", body_kernels::spring(), edges, X, {{"k", {k}}}, {}));
  }

  void add_ground(const std::vector<Ground>& grounds, const Kernel& secant = {}) {
    std::vector<int> points(static_cast<size_t>(state.x.cols()));
    std::iota(points.begin(), points.end(), 0);
    ground = std::make_unique<GroundContact>(
        system, grounds, GroundLaws{body_kernels::ground_barrier(), body_kernels::ground_friction(), secant}, points,
        state.x, mass, g);
  }

  void start(const StepOptions& options) {
    stepper = std::make_unique<TimeStepper>(system, mass, ground.get(), options);
  }

  StepRecord step() { return stepper->step(state); }
};

// One point.
inline BodyScene point_scene(const Eigen::Vector3d& x, const Eigen::Vector3d& v, const Eigen::Vector3d& gravity,
                             double mass = 1) {
  BodyScene scene(x, Eigen::VectorXd::Constant(1, mass), gravity);
  scene.state.v = v;
  return scene;
}

// A cube of eight points of 1/8 of the mass each, braced by springs along all edges and diagonals.
inline BodyScene cube_scene(double size, double height, double mass, double stiffness, const Eigen::Vector3d& gravity) {
  Eigen::Matrix3Xd X(3, 8);
  for (int i = 0; i < 8; ++i)
    X.col(i) = size * Eigen::Vector3d(i & 1, i >> 1 & 1, i >> 2) + Eigen::Vector3d(0, height, 0);
  BodyScene scene(X, Eigen::VectorXd::Constant(8, mass / 8), gravity);
  std::vector<int> edges;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < i; ++j) edges.insert(edges.end(), {j, i});
  }
  scene.add_springs(edges, stiffness, X);
  return scene;
}

}  // namespace ergon
