#pragma once
// Lagged friction of active stencils: each slides with the parts, weights and normal that it had when it was lagged, so
// that friction is a potential. Source: Li et al. 2020, Incremental Potential Contact, TOG 39(4).

#include <Eigen/Core>
#include <array>
#include <vector>

#include "runtime/contact/contact.h"
#include "runtime/contact/contact_frame.h"
#include "runtime/contact/friction_secants.h"
#include "runtime/system.h"

namespace ergon {

struct FrictionCoefficients {
  double at_rest = 0;  // up to the sliding speed epsv
  double sliding = 0;  // from epsv + fall on
};

// One stencil that rubs.
struct RubbingPair {
  ContactFrame frame;
  std::array<int, 4> vertices{};  // of the system; those without weight are not read
  double force = 0;               // N, normal
  FrictionCoefficients coefficients;
};

class SurfaceFriction {
 public:
  // Adds potentials of the laws friction and friction_secant to the system: one for each number of points that a pair
  // may have. epsv, fall: m/s.
  SurfaceFriction(System& system, const Kernel& law, const Kernel& secant, double epsv, double fall);

  // From now on friction is that of these pairs, against the displacement from xlag within dt seconds. The change is
  // told of the normal forces on vertices, so that a contact which goes from one triangle to the next changes little.
  FrictionChange lag(const std::vector<RubbingPair>& pairs, const Eigen::Matrix3Xd& xlag, double dt);

  FrictionSecants& secants() { return secants_; }
  int count() const { return count_; }
  bool owns(int potential) const;

 private:
  static constexpr int fewest = 2, most = 4;  // points of a pair
  System* system_;
  double epsv_;
  std::array<int, most + 1> potential_{};  // by number of points
  FrictionSecants secants_;
  Eigen::Matrix3Xd force_;  // N, normal forces on vertices
  int count_ = 0;
};

}  // namespace ergon
