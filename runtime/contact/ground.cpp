#include "runtime/contact/ground.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/error.h"

namespace ergon {

namespace {

constexpr double kept_gap = 0.1;          // of the present gap, after any step
constexpr double loaded_gap = 0.1;        // of dhat, where one vertex carries all the weight
constexpr double smallest_useful = 1e-6;  // of dhat: smaller gaps double an adaptive stiffness
constexpr double roundings = 1e4;         // or gaps of fewer roundings of a position than this
constexpr double infinity = std::numeric_limits<double>::infinity();

std::string length(double metres) {
  return std::abs(metres) < 0.1 ? fmt::format("{:.3g} mm", 1e3 * metres) : fmt::format("{:.3g} m", metres);
}

void check(const Ground& ground, const std::string& name) {
  const auto reject = [&](const char* what, double value, const char* unit, const char* range) {
    throw InputError(fmt::format("{}: {} is {:g}{}; it must be {}", name, what, value, unit, range));
  };
  if (!(ground.normal.norm() > 0) || !ground.normal.allFinite()) {
    throw InputError(name + ": normal has no direction; give the direction that points out of the ground");
  }
  if (!std::isfinite(ground.height)) reject("height", ground.height, " m", "finite");
  if (!(ground.dhat > 0) || !std::isfinite(ground.dhat)) reject("dhat", ground.dhat, " m", "above 0");
  if (!(ground.friction >= 0) || !std::isfinite(ground.friction)) reject("friction", ground.friction, "", "at least 0");
  if (!(ground.epsv > 0) || !std::isfinite(ground.epsv)) reject("epsv", ground.epsv, " m/s", "above 0");
  if (!(ground.stiffness >= 0) || !std::isfinite(ground.stiffness)) {
    reject("stiffness", ground.stiffness, " N/m", "above 0, or 0 to have it chosen");
  }
}

std::vector<double> components(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace

double barrier_value(double gap, double dhat) {
  if (gap >= dhat) return 0;
  return -(gap - dhat) * (gap - dhat) * std::log(gap / dhat);
}

double barrier_slope(double gap, double dhat) {
  if (gap >= dhat) return 0;
  const double d = gap - dhat;
  return -2 * d * std::log(gap / dhat) - d * d / gap;
}

GroundContact::GroundContact(System& system, std::vector<Ground> grounds, const GroundLaws& laws,
                             std::vector<int> vertices, const Eigen::Matrix3Xd& X, const Eigen::VectorXd& mass,
                             const Eigen::Vector3d& gravity)
    : system_(&system), vertices_(std::move(vertices)), X_(X), mass_(mass), gravity_(gravity) {
  for (size_t g = 0; g < grounds.size(); ++g) {
    const std::string number = grounds.size() > 1 ? fmt::format("_{}", g + 1) : "";
    Side side;
    side.ground = grounds[g];
    side.name = grounds.size() > 1 ? fmt::format("ground {}", g + 1) : "the ground";
    check(side.ground, side.name);
    side.ground.normal.normalize();
    side.kappa = side.ground.stiffness;
    const std::vector<double> n = components(side.ground.normal);
    side.barrier = system.add(
        Potential::on_stencils("ground_barrier" + number, laws.barrier, {}, X,
                               {{"n", n}, {"height", {side.ground.height}}, {"dhat", {side.ground.dhat}}}, {}));
    if (side.ground.friction > 0) {
      if (!laws.friction.table) throw std::logic_error("GroundContact: friction without its law");
      side.friction =
          system.add(Potential::on_stencils("ground_friction" + number, laws.friction, {}, X,
                                            {{"epsv", {side.ground.epsv}}, {"fall", {side.ground.epsv}}}, {}));
      side.secants.emplace(system, laws.friction_secant, 1, 1);
    }
    sides_.push_back(std::move(side));
  }
}

double GroundContact::gap(const Side& side, const Eigen::Matrix3Xd& x, int vertex) const {
  return side.ground.normal.dot(x.col(vertex)) - side.ground.height;
}

bool GroundContact::is_free(int vertex) const { return system_->moves(vertex); }

void GroundContact::check_start(const Eigen::Matrix3Xd& x) const {
  for (const Side& side : sides_) {
    int deepest = -1, below = 0;
    double least = infinity;
    for (int v : vertices_) {
      if (!is_free(v)) continue;
      const double d = gap(side, x, v);
      if (std::isnan(d)) throw InputError(fmt::format("vertex {} has no finite position", v));
      if (d <= 0) ++below;
      if (d < least) least = d, deepest = v;
    }
    if (below == 0) continue;
    const std::string others =
        below == 1 ? ""
                   : fmt::format(" and {} other {} not above it", below - 1, below == 2 ? "vertex is" : "vertices are");
    const Eigen::Vector3d n = side.ground.normal;
    const std::string along = fmt::format("along ({:.3g}, {:.3g}, {:.3g})", n[0], n[1], n[2]);
    if (least == 0) {
      throw InputError(fmt::format("vertex {} lies on {}{}; raise the object by {} {}", deepest, side.name, others,
                                   length(side.ground.dhat), along));
    }
    throw InputError(fmt::format("vertex {} is {} below {}{}; raise the object by more than {} {}", deepest,
                                 length(-least), side.name, others, length(-least), along));
  }
}

// The stiffness at which one vertex that carries the weight of all that moves comes to rest at a tenth of dhat. The
// barrier then stores at most about that weight times dhat, so that it gives next to nothing back after an impact, and
// vertices that share the load rest between there and dhat. Without gravity the force is the one that stops all that
// moves within a step, or within dhat if that takes longer.
double GroundContact::reference_force(const Side& side, const Eigen::Matrix3Xd& v, double dt) const {
  double mass = 0, speed = 0;
  for (int i = 0; i < mass_.size(); ++i) {
    if (!is_free(i)) continue;
    mass += mass_[i];
    speed = std::max(speed, v.col(i).norm());
  }
  const double weight = mass * gravity_.norm();
  if (weight > 0) return weight;
  if (speed > 0) return mass * speed / std::max(dt, side.ground.dhat / speed);
  return mass * side.ground.dhat / (dt * dt);
}

// A stiffness is chosen only while no vertex is within dhat: there the barrier's energy is zero whatever its stiffness,
// so that the choice adds none.
void GroundContact::begin_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double dt) {
  energy_added_ = 0;
  reached_ = false;
  for (Side& side : sides_) {
    side.last_gap = infinity;
    side.start_sum = 0;
    for (int i : vertices_) {
      if (is_free(i)) side.start_sum += barrier_value(gap(side, x, i), side.ground.dhat);
    }
    const bool open = side.ground.stiffness == 0 && (side.start_sum == 0 || side.kappa == 0);
    if (!open) continue;
    const double unit_force = -barrier_slope(loaded_gap * side.ground.dhat, side.ground.dhat);
    side.kappa = reference_force(side, v, dt) / unit_force;
    set_stiffness(side);
  }
}

void GroundContact::set_stiffness(Side& side) {
  if (!side.active.empty()) system_->potential(side.barrier).set_lag("kappa", {side.kappa});
}

void GroundContact::set_active(const Eigen::Matrix3Xd& x) {
  for (Side& side : sides_) {
    found_.clear();
    for (int v : vertices_) {
      if (is_free(v) && gap(side, x, v) < side.ground.dhat) found_.push_back(v);
    }
    if (!found_.empty()) reached_ = true;
    if (found_ == side.active) continue;
    side.active = found_;
    system_->potential(side.barrier).set_stencils(side.active, X_, {});
    set_stiffness(side);
  }
}

double GroundContact::largest_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  double fraction = 1;
  for (const Side& side : sides_) {
    for (int v : vertices_) {
      if (!is_free(v)) continue;
      const double approach = -side.ground.normal.dot(direction.col(v));
      const double allowed = (1 - kept_gap) * gap(side, x, v);
      if (approach * fraction > allowed) fraction = allowed / approach;
    }
  }
  // Where a gap is a few roundings of the position the bound above may be off by all of it.
  for (const Side& side : sides_) {
    for (int v : vertices_) {
      if (!is_free(v)) continue;
      while (side.ground.normal.dot(x.col(v) + fraction * direction.col(v)) - side.ground.height <= 0 && fraction > 0) {
        fraction /= 2;
      }
    }
  }
  return fraction;
}

double GroundContact::gap_change(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  double largest = 0;
  for (const Side& side : sides_) {
    for (int v : side.active) {
      largest = std::max(largest, std::abs(side.ground.normal.dot(direction.col(v))) / gap(side, x, v));
    }
  }
  return largest;
}

bool GroundContact::adapt(const Eigen::Matrix3Xd& x) {
  bool changed = false;
  for (Side& side : sides_) {
    if (side.ground.stiffness > 0) continue;
    double least = infinity, extent = std::abs(side.ground.height);
    for (int v : side.active) {
      least = std::min(least, gap(side, x, v));
      extent = std::max(extent, x.col(v).cwiseAbs().maxCoeff());
    }
    const double rounding = std::numeric_limits<double>::epsilon() * extent;
    const double limit = std::max(smallest_useful * side.ground.dhat, roundings * rounding);
    if (least < limit && least < side.last_gap && side.last_gap < limit) {
      energy_added_ += side.kappa * side.start_sum;
      side.kappa *= 2;
      set_stiffness(side);
      changed = true;
    }
    side.last_gap = least;
  }
  return changed;
}

FrictionChange GroundContact::lag_friction(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& xlag, double dt) {
  FrictionChange result;
  for (Side& side : sides_) {
    if (side.friction < 0) continue;
    Eigen::VectorXd before = Eigen::VectorXd::Zero(x.cols());
    for (size_t i = 0; i < side.rubbing.size(); ++i) before[side.rubbing[i]] = side.friction_force[i];
    found_.clear();
    side.friction_force.clear();
    std::vector<double> start;
    std::vector<SlidingPoint> sliding;
    for (int v : vertices_) {
      const double force = is_free(v) ? -side.kappa * barrier_slope(gap(side, x, v), side.ground.dhat) : 0;
      result.change += std::abs(force - before[v]);
      if (!(force > 0)) continue;
      result.sum += force;
      found_.push_back(v);
      side.friction_force.push_back(force);
      start.insert(start.end(), xlag.col(v).begin(), xlag.col(v).end());
      sliding.push_back({{v}, {1}, side.ground.normal, xlag.col(v), side.ground.friction * force});
    }
    Potential& friction = system_->potential(side.friction);
    if (found_ != side.rubbing) friction.set_stencils(found_, X_, {});
    side.rubbing = found_;
    side.secants->set(sliding, side.ground.epsv * dt);
    if (side.rubbing.empty()) continue;
    friction.set_lag("n", components(side.ground.normal));
    friction.set_lag("mu_static", {side.ground.friction});
    friction.set_lag("mu_kinetic", {side.ground.friction});
    friction.set_lag("force", side.friction_force);
    friction.set_lag("xlag", start);
    friction.set_lag("dt", {dt});
  }
  return result;
}

void GroundContact::begin_hessian(const Eigen::Matrix3Xd& x) {
  for (Side& side : sides_) {
    if (side.secants) side.secants->begin_hessian(x);
  }
}

void GroundContact::end_hessian() {
  for (Side& side : sides_) {
    if (side.secants) side.secants->end_hessian();
  }
}

void GroundContact::judge_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  for (Side& side : sides_) {
    if (side.secants) side.secants->judge_step(x, direction);
  }
}

bool GroundContact::owns(int potential) const {
  return rubs(potential) ||
         std::any_of(sides_.begin(), sides_.end(), [potential](const Side& side) { return side.barrier == potential; });
}

bool GroundContact::rubs(int potential) const {
  return std::any_of(sides_.begin(), sides_.end(), [potential](const Side& side) {
    return side.friction >= 0 && (side.friction == potential || side.secants->owns(potential));
  });
}

bool GroundContact::has_friction() const {
  return std::any_of(sides_.begin(), sides_.end(), [](const Side& side) { return side.friction >= 0; });
}

int GroundContact::active_count() const {
  size_t count = 0;
  for (const Side& side : sides_) count += side.active.size();
  return static_cast<int>(count);
}

int GroundContact::friction_count() const {
  size_t count = 0;
  for (const Side& side : sides_) count += side.rubbing.size();
  return static_cast<int>(count);
}

double GroundContact::smallest_gap(const Eigen::Matrix3Xd& x) const {
  double least = infinity;
  for (const Side& side : sides_) {
    for (int v : vertices_) {
      if (is_free(v)) least = std::min(least, gap(side, x, v));
    }
  }
  return least;
}

double GroundContact::stiffness(int ground) const { return sides_[static_cast<size_t>(ground)].kappa; }

double GroundContact::largest_stiffness() const {
  double largest = 0;
  for (const Side& side : sides_) largest = std::max(largest, side.kappa);
  return largest;
}

double GroundContact::energy_added() const { return energy_added_; }

ContactStatus GroundContact::status(const Eigen::Matrix3Xd& x) {
  return {reached_, active_count(), friction_count(), smallest_gap(x), largest_stiffness(), energy_added_};
}

std::vector<std::string> GroundContact::skipped() const {
  std::vector<std::string> lines;
  if (!reached_) lines.emplace_back("contact: no vertex came within dhat of the ground");
  if (!has_friction()) {
    lines.emplace_back("friction: no ground has a coefficient of friction");
  } else if (friction_count() == 0) {
    lines.emplace_back("friction: no vertex within dhat of the ground");
  }
  return lines;
}

std::vector<GroundContact::Force> GroundContact::forces(const Eigen::Matrix3Xd& x) const {
  std::vector<Force> forces;
  for (size_t g = 0; g < sides_.size(); ++g) {
    for (int v : vertices_) {
      if (!is_free(v)) continue;
      const double force = -sides_[g].kappa * barrier_slope(gap(sides_[g], x, v), sides_[g].ground.dhat);
      if (force > 0) forces.push_back({v, static_cast<int>(g), force});
    }
  }
  return forces;
}

}  // namespace ergon
