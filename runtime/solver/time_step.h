#pragma once
// One step of a simulation: each stage of the integrator (implicit Euler has one) is the minimum of an incremental
// potential, inertia + all other potentials of the system. It establishes that a step either ends in a converged state
// free of penetration, or leaves the state as it was and says why. Source: Gast et al. 2015, Optimization Integrator
// for Large Time Steps, TVCG 21(10); Li et al. 2020, Incremental Potential Contact, TOG 39(4).
//
// Lags are set by name in every potential that has them. For each point of a stencil, its dof's name with `hat` added:
// where inertia pulls it to, xhat = x + dt*v for implicit Euler; beside it, `dt` is the time (s) such that
// mass/(2*dt^2)*|x - xhat|^2 is the stage's inertia. With `lag` added: the position from which (x - xlag)/dt is the
// velocity at the end of the stage, with the `dt` of potentials without `hat`; for implicit Euler both are those of the
// step. A potential with the lag dt is a term of the incremental potential and not stored energy.
//
// Damping in proportion to stiffness (System::damp) takes the stiffness at the start of the step, for all its stages,
// and the velocity at the end of the stage. Steps without inertia have none.
//
// Constraints that are to keep a tolerance (runtime/solver/constraints.h) are solved for again until they do.
//
// Coupled mass of the system (System::coupled_mass) has the same xhat and xlag in place of a potential of inertia.
// Scripted vertices pull the free ones that they share mass with by their mean acceleration over the step.
//
// A density has the lag `Flag` in place of positions: its F there. Lags that an energy renews itself are part of the
// state; they change once a step is accepted, by what the energy sees at its end with the lags of the last stage.

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/contact/contact.h"
#include "runtime/script.h"
#include "runtime/solver/constraints.h"
#include "runtime/solver/integrator.h"
#include "runtime/solver/newton.h"
#include "runtime/system.h"

namespace ergon {

struct State {
  Eigen::Matrix3Xd x;  // m, 3 x vertices
  Eigen::Matrix3Xd v;  // m/s
  Eigen::Matrix3Xd a;  // m/s^2; empty where no step has ended yet
  // Of the start of the last step, for two-step integrators; empty before the first one.
  Eigen::Matrix3Xd last_x, last_v;
  double last_dt = 0;  // s
  // What energies renew themselves, by potential; empty where no step has ended yet: then it is 0.
  std::vector<StencilData> internal;
  double dissipated = 0;  // J, by integrators since the start
  double time = 0;        // s
  long step = 0;
};

struct StepOptions {
  double dt = 0.01;  // s
  std::string integrator = "implicit_euler";
  double tolerance = 1e-4;          // m/s, of a Newton step over dt
  int max_iterations = 200;         // of each Newton solve
  int constraint_iterations = 40;   // solves of each stage, until constraints keep their tolerances
  int friction_lag_iterations = 2;  // solves per step, each with the normal forces of the one before
  double friction_tolerance =
      0.05;  // no further solve when normal forces changed by less than this fraction of their sum
  Projection projection = Projection::clamp;
  bool project_on_demand = false;   // NewtonOptions::on_demand
  bool record_forces = false;       // of contact, in the record of each step
  bool accept_unconverged = false;  // go on from the best state found; the record still says so
  bool estimate_error = false;      // of the integrator, in the record of each step
  // A step that would make more energy than integrators have dissipated since the start, or more than a hundredth of
  // the kinetic energy, is made anew by implicit Euler, which makes none where the incremental potential is convex:
  // kinetic and stored energy then never exceed those of the start and the work done since.
  bool creates_no_energy = false;
  int points = -1;  // vertices that are points of space, of whose momentum a step tells; -1: all
};

// A potential of a load, and the values of the param that is in proportion to it.
struct Load {
  int potential = 0;
  std::string param;
  std::vector<double> full;
};

// J
struct Energies {
  std::vector<std::pair<std::string, double>> stored;  // by potential, in order of addition; equal names are added up
  double kinetic = 0;
  double total = 0;
};

// What changed the sum of kinetic and stored energy in a step, J:
// change = script + loads + barrier - friction - damping - integrator + residual. See runtime/solver/budget.cpp.
struct Budget {
  double change = 0;
  double script = 0;      // work of what holds and moves scripted vertices
  double loads = 0;       // by loads that grow, and by what else potentials have that follows time
  double barrier = 0;     // by changes of barrier stiffness, and of constraints that are shifted and hardened
  double friction = 0;    // dissipated
  double damping = 0;     // dissipated by potentials with the lag dt, and in proportion to stiffness
  double integrator = 0;  // dissipated by the way in which time is cut into steps
  double residual = 0;    // of the last Newton solve: the work of forces that do not balance
};

// Of all that has mass, about the origin.
struct Momentum {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   // kg m/s
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  // kg m^2/s
};

// Seconds by part; the parts of all Newton solves of the step.
struct StepSeconds : NewtonSeconds {
  double total = 0;
};

struct StepRecord {
  bool accepted = false;  // false: the state is as it was
  bool converged = false;
  std::string reason;  // why not
  int worst_vertex = -1;
  long step = 0;    // number and time of the state after the step
  double time = 0;  // s
  double dt = 0;    // s
  int newton_iterations = 0;
  int follow_iterations = 0;  // of these, those that moved scripted vertices
  double residual = 0;        // N
  double step_speed = 0;      // m/s, against the tolerance
  int factorisations = 0;
  double factor_flops = 0;  // of all factorisations
  int halvings = 0;
  int shifts = 0;
  long indefinite = 0;
  int friction_iterations = 0;                                    // solves
  double friction_change = 0;                                     // of the normal forces after the last solve, fraction
  int contacts = 0;                                               // pairs within dhat
  double smallest_gap = std::numeric_limits<double>::infinity();  // m
  double barrier_stiffness = 0;                                   // largest
  double energy_added = 0;                                        // J, by changes as those of Budget::barrier
  int constraint_iterations = 0;                                  // solves for the sake of constraints alone
  double constraint_excess = 0;                                   // largest |c| over its tolerance
  double error = 0;                                               // m, where it is estimated: of the step, any vertex
  Budget budget;                                                  // of a step that was accepted
  Momentum momentum;
  double load_factor = 1;  // of the state after the step
  int refused = 0;         // steps that were tried before and undone
  std::string integrator;  // that made the step
  Energies energy;
  std::optional<ContactForces> forces;  // at the end of the step, friction as the last solve had it
  StepSeconds seconds;
  std::vector<std::string> skipped;  // "part: reason"
};

class TimeStepper {
 public:
  // The system with all its potentials, inertia among them; mass: kg, per vertex, 0 where it is carried, and a scale
  // only where it is coupled; `contact` may be null. System and contact must outlive this. The vertices of `script` are
  // fixed in the system and follow it. Throws InputError for a dt or tolerance that is not positive.
  TimeStepper(System& system, Eigen::VectorXd mass, Contact* contact, StepOptions options, Script script = {});

  StepRecord step(State& state);

  // Loads grow in proportion to time, from 0 to `full` at `end` (s), and then stay.
  void grow_loads(std::vector<Load> loads, double end);
  double load_factor(double time) const;

  // Every step ends with these within their tolerances, or fails. Throws InputError as Constraints does.
  void keep_constraints(std::vector<Constraint> constraints) { constraints_ = {*system_, std::move(constraints)}; }

  // Of a state, not only of one that was stepped to.
  Energies energies(const State& state);

  const Newton& newton() const { return newton_; }
  StepOptions& options() { return options_; }

 private:
  // One stage as the solver sees it.
  struct Solve {
    Eigen::Matrix3Xd xhat;  // m, of inertia
    double dt = 0;          // s, of inertia
    Eigen::Matrix3Xd xlag;  // m, from which motion is counted
    double lag_dt = 0;      // s, that it takes
    double end = 0;         // s, time at its end
    double since = 0;       // s, from the start of the step to it: what energies that renew themselves live through
  };
  // Forces on the vertices (N, downhill is minus these) and accelerations that a solve balanced, and the part of the
  // step's displacement (m) that was made with them.
  struct Balance {
    Eigen::Matrix3Xd stored, friction, damping, a, way;
    double time = 0;  // s, that potentials which follow it had then
  };
  std::string integrator_for(const State& state);
  StepRecord step_by(const std::string& integrator, State& state);
  bool creates_energy(const State& after, const StepRecord& record) const;
  std::vector<Moment> known_moments(const State& state, const Integrator& integrator);
  Solve stage_of(const State& state, const Stage& stage, const std::vector<Moment>& moments) const;
  Moment moment_of(const State& state, const Stage& stage, const std::vector<Moment>& moments,
                   const Eigen::Matrix3Xd& x) const;
  NewtonResult solve_stage(const Solve& stage, const Eigen::Matrix3Xd& v, Eigen::Matrix3Xd& x, StepRecord& record);
  bool finish(const Integrator& integrator, double end_time, std::vector<Moment>& moments, NewtonResult& result);
  void prepare_at(const State& state);
  void set_loads(double factor);
  void set_time(double time);
  double work_of_time(const State& state, int order);
  bool is_stable(const State& state);
  void take_balance(const Eigen::Matrix3Xd& x);
  Balance starting_balance(const Moment& start) const;
  void take_ways(const State& state, const Integrator& integrator, const std::vector<Moment>& moments);
  Budget budget_of(const State& state, const StepRecord& record, const Evaluation& evaluation);
  double local_error(const State& state, const Integrator& integrator, const std::vector<Moment>& moments) const;
  void judge_path(const State& state, const Eigen::Matrix3Xd& x, bool was_stable, NewtonResult& result);
  Eigen::Matrix3Xd free_acceleration(const State& state);
  void set_lags(const Solve& stage);
  bool friction_changes(const Solve& stage, const Eigen::Matrix3Xd& x, int solves, StepRecord& record);
  bool constraints_give(const Eigen::Matrix3Xd& x, int solves, NewtonResult& result, StepRecord& record);
  void lag_stiffness(const State& state);
  void set_internal(const State& state);
  static bool renews(const Potential& potential);
  void lag_dt(int potential, double dt);
  void begin_contact(const Solve& stage, const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, StepRecord& record);
  NewtonResult solve(const Solve& stage, Eigen::Matrix3Xd& x, StepRecord& record);
  ContactForces forces(const Eigen::Matrix3Xd& x);
  void advance(State& state, const Moment& end);
  void report(State& state, const NewtonResult& result, StepRecord& record);
  bool is_stored(int potential) const;
  double kinetic_energy(const Eigen::Matrix3Xd& v) const;
  Eigen::Matrix3Xd mass_times(const Eigen::Matrix3Xd& field) const;
  void divide_by_mass(Eigen::Matrix3Xd& forces) const;
  Eigen::Matrix3Xd scripted_acceleration(const State& state) const;
  Energies energies_of(const Evaluation& evaluation, const Eigen::Matrix3Xd& v) const;
  std::vector<std::string> skipped_parts() const;

  System* system_;
  Eigen::VectorXd mass_;
  Eigen::VectorXd resisting_mass_;  // kg: of carried vertices too, what resists the motion of one alone at least
  Eigen::VectorXd lumped_mass_;     // kg: 0 where it is coupled
  Eigen::Matrix3Xd scripted_a_;     // m/s^2, in this step; 0 for what is not scripted
  Contact* contact_;
  StepOptions options_;
  Script script_;
  Balance balance_;                // of the last solve
  std::vector<Balance> balances_;  // of the moments that the step is made of: at its start, then the stages
  // Of the state at the end of the last step.
  struct Known {
    Eigen::Matrix3Xd x;
    PotentialValues energy;
    Balance balance = {};  // without columns where nothing was stepped to it
  };
  Known known_;
  Constraints constraints_;
  std::vector<Load> loads_;
  double load_end_ = 0;                            // s; 0: loads do not change
  std::optional<std::pair<double, bool>> stable_;  // time of the state that stability was last found for, and it
  Eigen::Matrix3Xd goal_;                          // m, of scripted vertices at the end of the step
  Newton newton_;
  std::vector<double> lagged_dt_;  // last dt given to each potential, so that an unchanged one stays untouched
};

}  // namespace ergon
