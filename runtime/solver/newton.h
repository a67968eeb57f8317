#pragma once
// Projected Newton with a back-tracking line search: minimises the energy of a System over its free vertices. It
// establishes that the energy never rises from iterate to iterate, that no iterate leaves the domain of any potential,
// and that none passes through a contact.
// Source: Li et al. 2020, Incremental Potential Contact, TOG 39(4), barrier-aware projected Newton.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "runtime/contact/contact.h"
#include "runtime/solver/line_search.h"
#include "runtime/solver/linear_solver.h"
#include "runtime/system.h"

namespace ergon {

// Vertices without degrees of freedom that are to move while the others are solved for.
struct Prescribed {
  const std::vector<int>* vertices = nullptr;
  const Eigen::Matrix3Xd* goal = nullptr;  // m, 3 x vertices of the system; only columns of `vertices` are read
};

struct NewtonOptions {
  // Converged when the largest component of the Newton step, divided by dt, is at most this and no active gap changes
  // by more than a tenth; the step is still taken.
  double tolerance = 1e-4;  // m/s
  double dt = 1;            // s; 1 makes the tolerance one of displacement, for statics
  int max_iterations = 200;
  Projection projection = Projection::clamp;
  // Project on demand: Hessians are H + a*(P - H), H as they are and P projected. A minimisation starts with a = 0;
  // where the sum has no factor or gives no direction of descent, or where the direction proves too bold, a grows up to
  // 1, and it falls again where steps succeed. Near a minimum the sum of the H is definite, and only they converge
  // quadratically. Source: project-on-demand Newton of Longva, Loeschner, Fernandez-Fernandez, Larionov, Ascher, Bender
  // 2023, Pitfalls of Projection: A study of Newton-type solvers for incremental potentials, arXiv:2311.14526, which
  // knows a = 0 and a = 1 only.
  bool on_demand = false;
  double sufficient_decrease = 1e-4;  // of the decrease that the gradient predicts
  int max_halvings = 60;
  // N/m, per vertex of the system: a lower bound of the Hessian's eigenvalues there (mass/dt^2; of a carried vertex, of
  // what resists its motion alone). It bounds the next Newton step without solving for it, which saves the last
  // factorisation. Empty: not used. Only Hessians that are projected have such a bound: it is not asked while they are
  // left as they are.
  Eigen::VectorXd curvature;
  // First brought to their goal, as far at a time as contact lets them; the others follow to first order.
  Prescribed prescribed;
};

// Seconds by part.
struct NewtonSeconds {
  double evaluate = 0;  // energies, derivatives and assembly
  double factor = 0;    // analysis included
  double solve = 0;
  double line_search = 0;  // energies of trial states
  double contact = 0;      // active sets and step bounds
};

struct NewtonResult {
  bool converged = false;
  std::string reason;           // why not, with the place
  int worst_vertex = -1;        // that place, where there is one
  int iterations = 0;           // Newton steps taken, those of the prescribed motion included
  int follow_iterations = 0;    // that moved what is prescribed
  double residual = 0;          // N, largest component of the gradient at x over free vertices
  double step_speed = 0;        // m/s, largest component of the last Newton step over dt, or the bound that replaced it
  double first_step_speed = 0;  // m/s, of the first Newton step, prescribed motion included
  double smallest_fraction = 1;  // of a Newton step that was taken
  int halvings = 0;
  int shifts = 0;  // factorisations repeated with a larger diagonal
  int factorisations = 0;
  double factor_flops = 0;       // of all factorisations
  int projected_iterations = 0;  // with Hessians projected, if in part
  int reused_factors = 0;        // last steps solved with the factor of the step before: not among the iterations
  long indefinite = 0;           // Hessians changed by projection, summed over iterations
  bool at_rounding = false;      // stopped where rounding, not the tolerance, ends the progress
  Evaluation evaluation;         // at x
  NewtonSeconds seconds;
};

class Newton {
 public:
  explicit Newton(Ordering ordering = Ordering::automatic) : solver_(ordering) {}

  // Moves x (3 x vertices, m) to a minimum. `contact` may be null. Whatever happens, x is a state inside the domain
  // with an energy not above the first; throws InputError only when the first x is outside the domain or not finite.
  NewtonResult minimise(System& system, Eigen::Matrix3Xd& x, const NewtonOptions& options, Contact* contact = nullptr);

  // Whether the Hessian at x, as it is, has no negative eigenvalue that rounding does not explain. Contact's active set
  // must be that of x.
  bool is_minimum(System& system, const Eigen::Matrix3Xd& x);

  const LinearSolver& linear_solver() const { return solver_; }
  const BlockMatrix& matrix() const { return matrix_; }

 private:
  struct Progress {
    bool found = false;         // x has moved
    bool is_near = false;       // the step was within a factor of the tolerance
    bool is_last = false;       // the step was below the tolerance
    bool is_quadratic = false;  // the energy fell by what the quadratic model foretold
    double gap_change = 0;      // Contact::gap_change of the whole step
  };
  bool follow(System& system, Eigen::Matrix3Xd& x, const NewtonOptions& options, Contact* contact,
              NewtonResult& result);
  bool relax(System& system, Eigen::Matrix3Xd& x, const NewtonOptions& options, Contact* contact, NewtonResult& result);
  void add_pull(System& system, const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& way, double rate);
  void evaluate_value(System& system, const Eigen::Matrix3Xd& x, Contact* contact, NewtonResult& result);
  void evaluate_gradient(System& system, const Eigen::Matrix3Xd& x, NewtonResult& result);
  void evaluate_hessian(System& system, const Eigen::Matrix3Xd& x, const NewtonOptions& options, NewtonResult& result);
  void blend(double part);
  double find_direction(System& system, const Eigen::Matrix3Xd& x, const NewtonOptions& options, NewtonResult& result);
  std::optional<double> solve_direction(System& system, NewtonResult& result);
  Progress iterate(System& system, Eigen::Matrix3Xd& x, const NewtonOptions& options, Contact* contact,
                   NewtonResult& result);
  Progress take_step(System& system, Eigen::Matrix3Xd& x, double slope, const NewtonOptions& options, Contact* contact,
                     NewtonResult& result);
  bool certainly_converged(const System& system, const NewtonOptions& options, NewtonResult& result) const;
  bool finishes_with_same_factor(System& system, Eigen::Matrix3Xd& x, const NewtonOptions& options, Contact* contact,
                                 NewtonResult& result);
  void refuse_standstill(const System& system, const Eigen::Matrix3Xd& x, Contact& contact, NewtonResult& result) const;
  void give_up_line_search(System& system, const Eigen::Matrix3Xd& x, Contact* contact, bool is_last,
                           NewtonResult& result);

  double blend_ = 1;  // a of NewtonOptions::on_demand in the present iteration
  LinearSolver solver_;
  BlockMatrix matrix_;                // kept, with its pattern, from call to call
  BlockMatrix as_it_is_, projected_;  // of which matrix_ is a blend, while blend_ is between 0 and 1
  Eigen::Matrix3Xd gradient_;
  Eigen::Matrix3Xd direction_;
  Eigen::Matrix3Xd moved_, moved_gradient_;
  Eigen::VectorXd right_side_;
  Eigen::VectorXd step_;
  LineSearchResult trial_;
};

}  // namespace ergon
