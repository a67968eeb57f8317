#pragma once
// The sum of all potentials over one set of vertices: value, gradient and assembled Hessian, over all cores. Results do
// not depend on the number of threads: stencils are added colour by colour, in an order fixed when the pattern is
// built.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "runtime/block_matrix.h"
#include "runtime/carriers.h"
#include "runtime/coupled_mass.h"
#include "runtime/potential.h"
#include "runtime/potential_values.h"

namespace ergon {

// A vertex that does not move in all directions: `along` is the orthogonal projector onto those in which it does.
struct Guide {
  int vertex = 0;
  Eigen::Matrix3d along = Eigen::Matrix3d::Identity();
};

struct Evaluation {
  double value = 0;              // J
  PotentialValues by_potential;  // J, in order of addition
  // Smallest margin of all `require` conditions, +inf without any; not positive: the state is outside the domain. A
  // margin or an energy that is not finite makes it -inf. Found by value() only.
  double require = 0;
  std::string violated;  // the potential with that margin, when it is not positive
  long indefinite = 0;   // quadrature points or stencils whose Hessian was changed by projection
};

class System {
 public:
  explicit System(int vertices);

  int vertices() const;
  // Fixed vertices carry no degree of freedom: their rows and columns are left out of the matrix.
  void set_fixed(const std::vector<char>& fixed);
  // Carried vertices have no degrees of freedom of their own either: what potentials give of derivatives with respect
  // to them goes to the control points that carry them. Potentials need not know. Throws InputError for a control point
  // that is fixed or carried itself, and for a vertex that is fixed and carried or carried twice.
  void set_carriers(Carriers carriers);
  const Carriers& carriers() const;
  // Guided vertices keep their rows in the matrix, but what potentials give is projected: with P the projectors, the
  // gradient is P g and the matrix P H P + s (I - P), s > 0, so that Newton's steps are along. Throws InputError for a
  // matrix that is no such projector, for a vertex that is guided twice or carried, and for a control point.
  void set_guides(std::vector<Guide> guides);
  // Takes from the columns of guided vertices what is not along.
  void guide(Eigen::Matrix3Xd& field) const;
  int free_vertices() const;
  int block_of(int vertex) const;  // block row of a vertex, -1 when it is fixed or carried
  bool moves(int vertex) const;    // it is not fixed

  int add(Potential potential);  // its index in by_potential
  Potential& potential(int index);
  int potential_count() const;

  Evaluation value(const Eigen::Matrix3Xd& x);
  // gradient: 3 x vertices, N; columns of fixed vertices hold the reaction (the full gradient), those of carried ones
  // what is collected at their control points, those of guided vertices what is along
  Evaluation gradient(const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& gradient);
  // The part of the gradient that comes from some potentials; indices, each once. Not projected by guides, so that it
  // tells their reactions.
  void gradient_of(const std::vector<int>& potentials, const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& gradient);
  // The matrix keeps its pattern from call to call; it is built at the first call and again only when a stencil list
  // brings a coupling that is not in it.
  Evaluation hessian(const Eigen::Matrix3Xd& x, Projection projection, Eigen::Matrix3Xd& gradient, BlockMatrix& matrix);

  // Damping in proportion to stiffness: with K the Hessian of a potential, every element projected, at the positions of
  // the last lag_stiffness(), and `from` and dt those of the last lag_motion(), value(), gradient() and hessian() have
  // time/(2*dt)*(x - from)' K (x - from) in addition. It is in no entry of by_potential, nor in gradient_of().
  // To be called after set_carriers(). Throws InputError for a time (s) that is not positive, and for a potential
  // without a Hessian.
  void damp(int potential, double time);
  bool damps() const;
  // Assembles K at x with all lags and params as they are.
  void lag_stiffness(const Eigen::Matrix3Xd& x);
  void lag_motion(const Eigen::Matrix3Xd& from, double dt);  // m, s
  // Adds the sum of time*K*v (N), which damping resists the velocity v (m/s) of vertices with: columns of carried ones
  // are not read, and get nothing; those of fixed ones are.
  void add_damping(const Eigen::Matrix3Xd& v, Eigen::Matrix3Xd& gradient) const;
  Eigen::Matrix3Xd lagged_velocity(const Eigen::Matrix3Xd& x) const;  // (x - from)/dt, m/s

  // Inertia of vertices whose mass is coupled, which no potential gives then: with xhat and dt, xlag and lag_dt those
  // of the last lag_coupled_mass(), value(), gradient() and hessian() have
  //   sum_ij mass_ij/(2*dt^2) (x_i - xhat_i).(x_j - xhat_j) + sum_ij drag_ij/(2*lag_dt) (x_i - xlag_i).(x_j - xlag_j)
  // in addition. It is in no entry of by_potential, nor in gradient_of(). Its Hessian is constant. Throws InputError
  // for matrices that are not of the system's vertices.
  void set_coupled_mass(CoupledMass mass);
  const CoupledMass& coupled_mass() const;
  void lag_coupled_mass(const Eigen::Matrix3Xd& xhat, double dt, const Eigen::Matrix3Xd& xlag, double lag_dt);  // m, s
  // Adds sum_j drag_ij (x_j - xlag_j)/lag_dt (N).
  void add_coupled_drag(const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& gradient) const;

  // N/m, mean over the axes: what resists the motion of this vertex alone, the others or, where it is carried, the
  // other bodies being held. 0 for a fixed one. `matrix`: of the last hessian().
  double stiffness_at(int vertex, const BlockMatrix& matrix) const;

  // What is not computed and why, one line each ("inertia: Hessian is constant, assembled once").
  std::vector<std::string> skipped() const;

  struct Impl;
  std::shared_ptr<Impl> impl;

 private:
  // What damping adds to the energy (J), and to the gradient unless it is null; and coupled mass.
  double damping(const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd* gradient) const;
  double coupled_inertia(const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd* gradient) const;
};

}  // namespace ergon
