#pragma once
// A Hessian of friction that foretells where sliding ends. Beyond epsv the force of friction is constant, so that its
// Hessian knows nothing of the rest at which the force turns around: Newton's steps overshoot it, and the line search
// cuts them to a fraction, once for each point that comes to rest. It establishes that points whose step would take
// them past rest are instead held by the secant of their force, the stiffness |force|/|way slid|, whose quadratic is
// never below friction's energy. Energies and gradients are unchanged.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "runtime/system.h"

namespace ergon {

// A relative position sum of weight*x of up to four vertices that slides across `normal`.
struct SlidingPoint {
  std::array<int, 4> vertices{};  // of the system; those without weight are not read
  std::array<double, 4> weight{};
  Eigen::Vector3d normal;
  Eigen::Vector3d start;  // m, its position at the start of the step
  double force = 0;       // N, the largest of friction
};

class FrictionSecants {
 public:
  // Adds potentials of the law friction_secant to the system, for points of `fewest` to `most` vertices. An empty
  // kernel: none, and friction keeps its own Hessian.
  FrictionSecants(System& system, const Kernel& law, int fewest, int most);

  // From now on it is these that slide; rest is what moves less than eps, m.
  void set(const std::vector<SlidingPoint>& points, double eps);

  // The Hessian at x is found between the two.
  void begin_hessian(const Eigen::Matrix3Xd& x);
  void end_hessian();
  // After the whole Newton step from x is known, which may not be taken as a whole.
  void judge_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction);

  int held() const;  // points that have a secant
  bool owns(int potential) const;

 private:
  static constexpr size_t kMost = 5;  // vertices of a point, and none
  struct Group {                      // points with one number of vertices
    int potential = -1;
    std::vector<SlidingPoint> points;
    std::vector<char> held;
    bool shown = false;  // the potential has a stiffness
  };
  System* system_;
  std::array<Group, kMost> groups_;
  double eps_ = 0;
};

}  // namespace ergon
