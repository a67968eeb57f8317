#pragma once
// Time integrators as tables: each step is one or more stages, each of them the minimum of an incremental potential,
// and possibly a last combination of their results. A stage solves
//   x = xhat + inertia*dt^2*a,  v = vhat + rate*dt*a,  mass*a = -(gradient of all stored energies at x),
// with xhat and vhat linear in what is known, so that it minimises mass/(2*inertia*dt^2)*|x - xhat|^2 + energies.
// A method for first-order systems, that forms x from v as it forms v from a, has inertia = rate^2.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace ergon {

// What is known of one moment, 3 x vertices: m, m/s, m/s^2.
struct Moment {
  Eigen::Matrix3Xd x, v, a;
};

// Weights of one moment's x, dt*v and dt^2*a in a position; of v and dt*a in a velocity; of a in an acceleration.
struct Weights {
  double x = 0, v = 0, a = 0;
};

// Over moments in this order: the start of the last step (used by two-step methods only), the start of this step, the
// stages so far.
using Combination = std::vector<Weights>;

struct Stage {
  double time = 1;  // of its end, in dt after the start of the step
  double inertia = 1, rate = 1;
  Combination xhat, vhat;
};

// The position from which (x - xlag)/(inertia/rate*dt) is the velocity at the end of the stage.
Combination xlag_of(const Stage& stage);

struct Integrator {
  int order = 1;
  bool two_step = false;            // its first step is made by sdirk2
  bool needs_acceleration = false;  // at the start of a step
  bool has_inertia = true;          // false: each step ends in an equilibrium
  std::vector<Stage> stages = {};
  // Empty: the step ends with the last stage. A combination that goes on beyond it may lead through what contact keeps
  // apart; the step then fails.
  Combination end_x = {}, end_v = {}, end_a = {};
};

// implicit_euler; bdf2, with variable steps: Hairer, Norsett, Wanner 1993, Solving Ordinary Differential Equations I,
// III.5; sdirk2: Alexander 1977, Diagonally Implicit Runge-Kutta Methods for Stiff O.D.E.'s, SIAM J. Numer. Anal.
// 14(6), of two stages with gamma = 1 - sqrt(1/2); tr_bdf2: Bank et al. 1985, Transient Simulation of Silicon Devices
// and Circuits, with gamma = 2 - sqrt(2); midpoint; newmark: Newmark 1959 with beta = 1/4, gamma = 1/2 (the trapezoidal
// rule); generalised_alpha: Chung, Hulbert 1993, A Time Integration Algorithm for Structural Dynamics With Improved
// Numerical Dissipation, J. Appl. Mech. 60(2), with a spectral radius of 0.8 at infinity. quasi_static: equilibria that
// follow a load; velocities, of friction and damping, are displacements of a step over its dt.
std::vector<std::string> integrator_names();

// ratio: dt of this step over that of the last one, for two-step methods. Throws InputError naming the nearest.
Integrator integrator_named(const std::string& name, double ratio = 1);

// Of each moment that known_moments and the stages make, the weight of its slopes (v and a) in the change of x and v
// over the step; they add to 1. Empty for methods of one stage.
std::vector<double> slope_weights(const Integrator& integrator);

// The error of a step's position is this times dt^(order + 1) times the derivative of that order of the motion (m,
// where that is in m/s^(order + 1)), to leading order: what the method makes of t^(order + 1)/(order + 1)!. With
// accelerations, which steps have anyway, it gives an estimate for nothing, like that for Newmark's method in Error
// Estimation and Adaptivity in Elastodynamics, 1992, Computer Methods in Applied Mechanics and Engineering 101,
// 369-395. ratio as above.
double error_constant(const Integrator& integrator, double ratio = 1);

// Sums over moments.
Eigen::Matrix3Xd position(const Combination& weights, const std::vector<Moment>& moments, double dt);
Eigen::Matrix3Xd velocity(const Combination& weights, const std::vector<Moment>& moments, double dt);
Eigen::Matrix3Xd acceleration(const Combination& weights, const std::vector<Moment>& moments);

}  // namespace ergon
