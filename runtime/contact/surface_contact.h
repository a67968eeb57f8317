#pragma once
// Contact of surfaces with one another and themselves: broad phase, active sets, barrier potentials, the largest step
// without collision, the barriers' stiffness, lagged friction.
// Source: Li et al. 2020, Incremental Potential Contact, TOG 39(4); thickness as in Li et al. 2021, Codimensional
// Incremental Potential Contact, TOG 40(4).

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/contact/active_set.h"
#include "runtime/contact/barrier_probe.h"
#include "runtime/contact/broad_phase.h"
#include "runtime/contact/contact.h"
#include "runtime/contact/contact_frame.h"
#include "runtime/contact/intersections.h"
#include "runtime/contact/pair_stiffness.h"
#include "runtime/contact/surface_friction.h"
#include "runtime/system.h"

namespace ergon {

struct SurfaceContactOptions {
  double dhat = 1e-3;    // m, gap at which barriers begin to act
  double stiffness = 0;  // in the unit of the barrier's kappa; 0: chosen from the scene
  double epsv = 1e-3;    // m/s, sliding speed below which friction is static
  double fall = 1e-3;    // m/s, by how much faster friction is that of sliding
  std::vector<std::vector<FrictionCoefficients>> friction;  // per pair of objects; empty: none
};

// The barrier's kernels, by ContactKind, and friction's: a law of the relative position of two points, which may be
// empty when no pair has friction; that of secants may be empty too.
struct SurfaceLaws {
  std::array<Kernel, kContactKinds> barrier;
  Kernel friction;
  Kernel friction_secant;
};

class SurfaceContact : public Contact {
 public:
  // Adds a barrier potential per kind of stencil to the system, and those of friction. X: rest positions, m, and mass,
  // kg, per vertex of the system; gravity: m/s^2. Throws InputError for options out of range.
  SurfaceContact(System& system, CollisionSurface surface, const SurfaceLaws& laws, SurfaceContactOptions options,
                 const Eigen::Matrix3Xd& X, const Eigen::VectorXd& mass, const Eigen::Vector3d& gravity);

  void begin_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double dt) override;
  FrictionChange lag_friction(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& xlag, double dt) override;
  void set_active(const Eigen::Matrix3Xd& x) override;
  // Every pair keeps at least a tenth of its present gap.
  double largest_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) override;
  double gap_change(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) override;
  // Raises the stiffness of pairs of objects whose smallest gap has become too small for the one that they have.
  bool adapt(const Eigen::Matrix3Xd& x) override;
  void begin_hessian(const Eigen::Matrix3Xd& x) override;
  void end_hessian() override;
  void judge_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) override;
  bool owns(int potential) const override;
  bool rubs(int potential) const override;
  bool has_friction() const override;
  ContactStatus status(const Eigen::Matrix3Xd& x) override;
  std::vector<std::string> skipped() const override;

  // Vertices of the stencils whose gap is not positive at x. The potentials keep the stencils that they have.
  std::vector<std::vector<int>> touching(const Eigen::Matrix3Xd& x);
  // Exactly, at x.
  std::vector<Intersection> crossing(const Eigen::Matrix3Xd& x) { return intersections_.find(x); }

  const CollisionSurface& surface() const { return surface_; }
  const ActiveSet& active() const { return active_; }  // of the last state looked at
  double stiffness(int object_a, int object_b) const { return kappa_(object_a, object_b); }

 private:
  struct Law {
    int potential = -1;            // in the system
    std::vector<int> vertices;     // of the stencils it has
    std::vector<double> strength;  // kappa of each
  };
  std::vector<RubbingPair> rubbing_pairs(const Eigen::Matrix3Xd& x);
  // Calls f(kind, index of the stencil in its list, its vertices, objects of its two parts).
  template <class F>
  void for_each_active(F f) const;
  std::array<int, 2> objects_of(ContactKind kind, const int* vertices) const;
  void find(const Eigen::Matrix3Xd& x);
  Eigen::MatrixXd unit_energies(const Eigen::Matrix3Xd& x);
  std::vector<SurfaceResistance> resistance(const Eigen::Matrix3Xd& x, double dt);
  Eigen::MatrixXd smallest_gaps(const Eigen::Matrix3Xd& x) const;
  void give_stiffness();

  System* system_;
  CollisionSurface surface_;
  SurfaceContactOptions options_;
  Eigen::Matrix3Xd X_;
  double weight_ = 0;  // N, of all that moves
  BroadPhase broad_;
  IntersectionFinder intersections_;
  BarrierProbe probe_;
  PairStiffness kappa_;
  Eigen::VectorXd mass_;  // kg, Carriers::resisting_mass
  std::array<Law, kContactKinds> laws_;
  std::optional<SurfaceFriction> friction_;
  ActiveSet active_;
  Eigen::Matrix3Xd start_;     // m, at the start of the step
  Eigen::MatrixXd start_sum_;  // unit_energies there, once asked for
  double piece_ = 0;           // m, motion that one pass of detection looks at
  double energy_added_ = 0;
  bool reached_ = false;
  Eigen::Matrix3Xd from_, to_, motion_;
};

}  // namespace ergon
