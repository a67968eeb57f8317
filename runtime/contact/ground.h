#pragma once
// Contact of vertices with half-spaces dot(n, x) < height: the active sets of the barrier and of lagged friction, the
// largest step that does not reach the plane, and the barrier's stiffness.
// Source: Li et al. 2020, Incremental Potential Contact, TOG 39(4): the barrier and lagged, smoothed friction.

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "runtime/contact/contact.h"
#include "runtime/contact/friction_secants.h"
#include "runtime/system.h"

namespace ergon {

struct Ground {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitY();  // pointing out of the ground; any length but zero
  double height = 0;                                  // m, dot(normal, x) on the plane, for the unit normal
  double dhat = 1e-3;                                 // m, activation distance
  double friction = 0;                                // coefficient mu
  double epsv = 1e-3;                                 // m/s, sliding speed below which friction is static
  double stiffness = 0;                               // N/m, of the barrier; 0: chosen from the scene's forces
};

// The laws, loaded by whoever builds the scene: log_barrier:half_space, with params n, height, dhat and lag kappa;
// friction, with params epsv, fall and lags n, mu_static, mu_kinetic, force, dt, xlag; friction_secant. The friction
// kernel may be empty when no ground has friction, that of secants always.
struct GroundLaws {
  Kernel barrier;
  Kernel friction;
  Kernel friction_secant;
};

class GroundContact : public Contact {
 public:
  // Adds one barrier potential per ground to the system, and one friction potential per ground with friction > 0.
  // `vertices`: those that may touch (the surface). X: 3 x vertices of the system, m. mass: kg, per vertex of the
  // system. gravity: m/s^2. Throws InputError for a normal of length zero and for parameters out of range.
  GroundContact(System& system, std::vector<Ground> grounds, const GroundLaws& laws, std::vector<int> vertices,
                const Eigen::Matrix3Xd& X, const Eigen::VectorXd& mass, const Eigen::Vector3d& gravity);

  // Throws InputError when a free vertex is on or below a ground: the deepest one, its depth, and the remedy.
  void check_start(const Eigen::Matrix3Xd& x) const;

  void begin_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double dt) override;
  FrictionChange lag_friction(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& xlag, double dt) override;
  void set_active(const Eigen::Matrix3Xd& x) override;
  // Every vertex keeps at least a tenth of its present gap.
  double largest_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) override;
  double gap_change(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) override;
  // Doubles a stiffness that was not fixed when the smallest gap has come near the rounding of positions.
  bool adapt(const Eigen::Matrix3Xd& x) override;

  void begin_hessian(const Eigen::Matrix3Xd& x) override;
  void end_hessian() override;
  void judge_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) override;
  bool owns(int potential) const override;
  bool rubs(int potential) const override;
  bool has_friction() const override;
  ContactStatus status(const Eigen::Matrix3Xd& x) override;
  std::vector<std::string> skipped() const override;

  bool reached() const { return reached_; }
  int active_count() const;
  int friction_count() const;
  double smallest_gap(const Eigen::Matrix3Xd& x) const;  // m, over all free vertices and grounds; +inf without any
  double stiffness(int ground) const;                    // N/m; 0 while open
  double largest_stiffness() const;
  double energy_added() const;
  // Normal force per active pair at x: vertex, ground, N.
  struct Force {
    int vertex;
    int ground;
    double newton;
  };
  std::vector<Force> forces(const Eigen::Matrix3Xd& x) const;

 private:
  struct Side {  // one ground with its potentials and present state
    Ground ground;
    std::string name;
    int barrier = -1;  // indices of the potentials
    int friction = -1;
    std::optional<FrictionSecants> secants;
    double kappa = 0;                                           // N/m
    double start_sum = 0;                                       // m^2, barrier/kappa summed at the start of the step
    double last_gap = std::numeric_limits<double>::infinity();  // m, smallest at the last adapt
    std::vector<int> active;                                    // vertices within dhat
    std::vector<int> rubbing;                                   // vertices with a friction force
    std::vector<double> friction_force;                         // N, normal force of these
  };
  double gap(const Side& side, const Eigen::Matrix3Xd& x, int vertex) const;
  bool is_free(int vertex) const;
  double reference_force(const Side& side, const Eigen::Matrix3Xd& v, double dt) const;
  void set_stiffness(Side& side);

  System* system_;
  std::vector<Side> sides_;
  std::vector<int> vertices_;
  Eigen::Matrix3Xd X_;
  Eigen::VectorXd mass_;  // kg
  Eigen::Vector3d gravity_;
  double energy_added_ = 0;
  bool reached_ = false;
  std::vector<int> found_;
};

// b(gap)/kappa of log_barrier.energy and its derivative, m^2 and m; zero at and beyond dhat.
double barrier_value(double gap, double dhat);
double barrier_slope(double gap, double dhat);

}  // namespace ergon
