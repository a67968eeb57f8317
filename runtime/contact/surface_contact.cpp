#include "runtime/contact/surface_contact.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/contact/area_weights.h"
#include "runtime/contact/step_bound.h"
#include "runtime/error.h"

namespace ergon {

namespace {

constexpr double kept_gap = 0.1;          // of the present gap, after any step
constexpr double smallest_useful = 1e-6;  // of dhat: smaller gaps double an adaptive stiffness
constexpr double roundings = 1e4;         // or gaps of fewer roundings of a position than this
constexpr double edges_per_pass = 8;      // of mean length, that a vertex moves within one pass of detection
constexpr double infinity = std::numeric_limits<double>::infinity();

const char* const potential_names[kContactKinds] = {"contact_point_point",    "contact_point_edge",
                                                    "contact_point_triangle", "contact_edge_edge",
                                                    "contact_parallel_edges", "contact_parallel_ends"};

double mean_edge(const CollisionSurface& surface, const Eigen::Matrix3Xd& X) {
  double sum = 0;
  for (const auto& [a, b] : surface.edges) sum += (X.col(a) - X.col(b)).norm();
  return surface.edges.empty() ? infinity : sum / static_cast<double>(surface.edges.size());
}

// Kernels of laws without offset have no such input. Rest positions of edges are found by the potential itself.
StencilData rest_data(const ErgonKernel& kernel, const ActiveList& list) {
  for (int i = 0; i < kernel.n_inputs; ++i) {
    if (kernel.inputs[i].role == ERGON_REST && std::string_view(kernel.inputs[i].name) == "offset")
      return {{"offset", list.offset}};
  }
  return {};
}

SurfaceContactOptions checked(SurfaceContactOptions options) {
  const auto reject = [](const char* what, double value, const char* unit, const char* range) {
    throw InputError(fmt::format("contact: {} is {:g}{}; it must be {}", what, value, unit, range));
  };
  if (!(options.dhat > 0) || !std::isfinite(options.dhat)) reject("dhat", options.dhat, " m", "above 0");
  if (!(options.epsv > 0) || !std::isfinite(options.epsv)) reject("epsv", options.epsv, " m/s", "above 0");
  if (!(options.stiffness >= 0) || !std::isfinite(options.stiffness))
    reject("stiffness", options.stiffness, "", "above 0, or 0 to have it chosen");
  return options;
}

}  // namespace

SurfaceContact::SurfaceContact(System& system, CollisionSurface surface, const SurfaceLaws& laws,
                               SurfaceContactOptions options, const Eigen::Matrix3Xd& X, const Eigen::VectorXd& mass,
                               const Eigen::Vector3d& gravity)
    : system_(&system),
      surface_(std::move(surface)),
      options_(checked(std::move(options))),
      X_(X),
      broad_(surface_),
      intersections_(surface_),
      probe_(laws.barrier[0], options_.dhat),
      kappa_(probe_, options_.dhat, static_cast<int>(surface_.radius.size()), options_.stiffness),
      mass_(system.carriers().resisting_mass(mass)) {
  for (int v = 0; v < system.vertices(); ++v) {
    if (system.block_of(v) >= 0) weight_ += mass[v] * gravity.norm();
  }
  const auto objects = static_cast<Eigen::Index>(surface_.radius.size());
  start_sum_.setZero(objects, objects);
  piece_ = std::max(edges_per_pass * mean_edge(surface_, X), options_.dhat);
  for (int kind = 0; kind < kContactKinds; ++kind) {
    const auto k = static_cast<size_t>(kind);
    laws_[k].potential =
        system.add(Potential::on_used_points(potential_names[kind], laws.barrier[k], {}, X, {{"dhat", {options_.dhat}}},
                                             rest_data(*laws.barrier[k].table, {})));
  }
  const auto rubs = [](const FrictionCoefficients& c) { return std::max(c.at_rest, c.sliding) > 0; };
  const bool friction = std::any_of(options_.friction.begin(), options_.friction.end(),
                                    [&](const auto& row) { return std::any_of(row.begin(), row.end(), rubs); });
  if (!friction) return;
  if (!laws.friction.table) throw std::logic_error("SurfaceContact: friction without its law");
  friction_.emplace(system, laws.friction, laws.friction_secant, options_.epsv, options_.fall);
}

std::array<int, 2> SurfaceContact::objects_of(ContactKind kind, const int* vertices) const {
  const bool edges = kind == ContactKind::edge_edge || kind == ContactKind::parallel_point_edge ||
                     kind == ContactKind::parallel_point_point;
  return {surface_.object[static_cast<size_t>(vertices[0])],
          surface_.object[static_cast<size_t>(vertices[edges ? 2 : 1])]};
}

template <class F>
void SurfaceContact::for_each_active(F f) const {
  for (int k = 0; k < kContactKinds; ++k) {
    const auto kind = static_cast<ContactKind>(k);
    const ActiveList& list = list_of(active_, kind);
    for (size_t i = 0; i < list.count(); ++i) {
      const int* vertices = list.vertices.data() + i * static_cast<size_t>(list.points);
      f(kind, i, vertices, objects_of(kind, vertices));
    }
  }
}

void SurfaceContact::find(const Eigen::Matrix3Xd& x) {
  broad_.cover(x, x, options_.dhat);
  find_active(surface_, broad_.candidates(), x, X_, options_.dhat, active_);
}

void SurfaceContact::set_active(const Eigen::Matrix3Xd& x) {
  find(x);
  give_stiffness();
}

// Hands stencils and their stiffness to the potentials whose lists changed.
void SurfaceContact::give_stiffness() {
  std::vector<double> strength;
  for (int k = 0; k < kContactKinds; ++k) {
    const auto kind = static_cast<ContactKind>(k);
    const ActiveList& list = list_of(active_, kind);
    Law& law = laws_[static_cast<size_t>(k)];
    Potential& potential = system_->potential(law.potential);
    const bool moved = list.vertices != law.vertices;
    if (moved) {
      law.vertices = list.vertices;
      potential.set_stencils(list.vertices, X_, rest_data(potential.kernel(), list));
    }
    strength.resize(list.count());
    for (size_t i = 0; i < list.count(); ++i) {
      const auto [a, b] = objects_of(kind, list.vertices.data() + i * static_cast<size_t>(list.points));
      strength[i] = kappa_(a, b) * list.multiplicity[i];
    }
    if (list.count() > 0) reached_ = true;
    if (!moved && strength == law.strength) continue;
    law.strength = strength;
    if (!strength.empty()) potential.set_lag("kappa", strength);
  }
}

// Of each object at x.
std::vector<SurfaceResistance> SurfaceContact::resistance(const Eigen::Matrix3Xd& x, double dt) {
  Eigen::Matrix3Xd gradient;
  BlockMatrix matrix;
  system_->hessian(x, Projection::clamp, gradient, matrix);
  std::vector<SurfaceResistance> sum(surface_.radius.size());
  std::vector<double> count(sum.size(), 0);
  for (const int v : surface_.points) {
    if (!system_->moves(v)) continue;
    const auto object = static_cast<size_t>(surface_.object[static_cast<size_t>(v)]);
    sum[object].hessian += system_->stiffness_at(v, matrix);
    sum[object].inertia += mass_[v] / (dt * dt);
    count[object] += 1;
  }
  const std::vector<double> weight = mean_weights(surface_);
  for (size_t object = 0; object < sum.size(); ++object) {
    const double n = count[object];
    sum[object] = n > 0 ? SurfaceResistance{sum[object].hessian / n, sum[object].inertia / n, weight[object]}
                        : SurfaceResistance{infinity, infinity, weight[object]};
  }
  return sum;
}

void SurfaceContact::begin_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd&, double dt) {
  energy_added_ = 0;
  reached_ = false;
  start_ = x;
  start_sum_.resize(0, 0);
  if (kappa_.fixed()) return;
  find(x);
  const Eigen::MatrixXd gaps = smallest_gaps(x), before = kappa_.values();
  kappa_.begin_step(kappa_.needs_resistance() ? resistance(x, dt) : std::vector<SurfaceResistance>{}, weight_, gaps);
  if (kappa_.values() == before || !(before(0, 0) > 0)) return;
  const Eigen::MatrixXd added = (kappa_.values() - before).cwiseProduct(unit_energies(x));
  energy_added_ += (added.sum() + added.trace()) / 2;
}

// Of the active stencils, per pair of objects, symmetric; +inf without any.
Eigen::MatrixXd SurfaceContact::smallest_gaps(const Eigen::Matrix3Xd& x) const {
  Eigen::MatrixXd least = Eigen::MatrixXd::Constant(kappa_.values().rows(), kappa_.values().cols(), infinity);
  for_each_active([&](ContactKind kind, size_t i, const int* vertices, std::array<int, 2> objects) {
    const double gap = contact_frame(kind, vertices, x).distance - list_of(active_, kind).offset[i];
    double& known = least(objects[0], objects[1]);
    known = std::min(known, gap);
  });
  return least.cwiseMin(least.transpose());
}

// J per unit of kappa that each pair of objects holds at x.
Eigen::MatrixXd SurfaceContact::unit_energies(const Eigen::Matrix3Xd& x) {
  find(x);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(kappa_.values().rows(), kappa_.values().cols());
  for_each_active([&](ContactKind kind, size_t i, const int* vertices, std::array<int, 2> objects) {
    const ContactFrame frame = contact_frame(kind, vertices, x);
    const ActiveList& list = list_of(active_, kind);
    const double faded = kind < ContactKind::edge_edge ? 1 : parallel_factor(vertices, x, X_);
    const double energy = list.multiplicity[i] * faded * probe_.at(frame.distance - list.offset[i]).value;
    sum(objects[0], objects[1]) += energy;
    if (objects[0] != objects[1]) sum(objects[1], objects[0]) += energy;
  });
  return sum;
}

double SurfaceContact::largest_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  double longest = 0;
  for (const int v : surface_.points) longest = std::max(longest, direction.col(v).norm());
  const double passes = std::max(1.0, std::ceil(longest / piece_));
  for (double pass = 0; pass < passes; ++pass) {
    from_ = x + pass / passes * direction;
    motion_ = direction / passes;
    to_ = from_ + motion_;
    broad_.cover(from_, to_, 0);
    const double step = ergon::largest_step(surface_, broad_.candidates(), from_, motion_, kept_gap);
    if (step < 1) return (pass + step) / passes;
  }
  return 1;
}

double SurfaceContact::gap_change(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  double largest = 0;
  for_each_active([&](ContactKind kind, size_t i, const int* vertices, std::array<int, 2>) {
    const ActiveList& list = list_of(active_, kind);
    const ContactFrame frame = contact_frame(kind, vertices, x);
    double change = 0;
    for (int p = 0; p < list.points; ++p) {
      change += frame.weight[static_cast<size_t>(p)] * frame.normal.dot(direction.col(vertices[p]));
    }
    largest = std::max(largest, std::abs(change) / (frame.distance - list.offset[i]));
  });
  return largest;
}

bool SurfaceContact::adapt(const Eigen::Matrix3Xd& x) {
  if (kappa_.fixed()) return false;
  double extent = 0;
  for_each_active([&](ContactKind, size_t, const int* vertices, std::array<int, 2>) {
    extent = std::max(extent, x.col(vertices[0]).cwiseAbs().maxCoeff());
  });
  const double resolved =
      std::max(smallest_useful * options_.dhat, roundings * std::numeric_limits<double>::epsilon() * extent);
  const Eigen::MatrixXd before = kappa_.values();
  if (!kappa_.adapt(smallest_gaps(x), resolved)) return false;
  if (start_sum_.size() == 0) start_sum_ = unit_energies(start_);
  const Eigen::MatrixXd added = (kappa_.values() - before).cwiseProduct(start_sum_);
  energy_added_ += (added.sum() + added.trace()) / 2;
  set_active(x);
  return true;
}

// The active stencils of pairs with friction, with the normal forces of their barriers at x.
std::vector<RubbingPair> SurfaceContact::rubbing_pairs(const Eigen::Matrix3Xd& x) {
  find(x);
  std::vector<RubbingPair> pairs;
  std::vector<double> gaps;
  for_each_active([&](ContactKind kind, size_t i, const int* vertices, std::array<int, 2> objects) {
    const auto [a, b] = objects;
    const FrictionCoefficients coefficients = options_.friction[static_cast<size_t>(a)][static_cast<size_t>(b)];
    if (!(std::max(coefficients.at_rest, coefficients.sliding) > 0)) return;
    const ActiveList& list = list_of(active_, kind);
    const double faded = kind < ContactKind::edge_edge ? 1 : parallel_factor(vertices, x, X_);
    RubbingPair pair{contact_frame(kind, vertices, x), {}, kappa_(a, b) * list.multiplicity[i] * faded, coefficients};
    std::copy_n(vertices, list.points, pair.vertices.begin());
    gaps.push_back(pair.frame.distance - list.offset[i]);
    pairs.push_back(pair);
  });
  const std::vector<BarrierAt> barrier = probe_.at(gaps);
  for (size_t i = 0; i < pairs.size(); ++i) pairs[i].force *= -barrier[i].slope;
  std::erase_if(pairs, [](const RubbingPair& pair) { return !(pair.force > 0); });
  return pairs;
}

FrictionChange SurfaceContact::lag_friction(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& xlag, double dt) {
  if (!friction_) return {};
  return friction_->lag(rubbing_pairs(x), xlag, dt);
}

void SurfaceContact::begin_hessian(const Eigen::Matrix3Xd& x) {
  if (friction_) friction_->secants().begin_hessian(x);
}

void SurfaceContact::end_hessian() {
  if (friction_) friction_->secants().end_hessian();
}

void SurfaceContact::judge_step(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& direction) {
  if (friction_) friction_->secants().judge_step(x, direction);
}

bool SurfaceContact::owns(int potential) const {
  return rubs(potential) ||
         std::any_of(laws_.begin(), laws_.end(), [&](const Law& law) { return law.potential == potential; });
}

bool SurfaceContact::rubs(int potential) const { return friction_ && friction_->owns(potential); }

bool SurfaceContact::has_friction() const { return friction_.has_value(); }

std::vector<std::vector<int>> SurfaceContact::touching(const Eigen::Matrix3Xd& x) {
  find(x);
  std::vector<std::vector<int>> stencils;
  for_each_active([&](ContactKind kind, size_t i, const int* vertices, std::array<int, 2>) {
    const ActiveList& list = list_of(active_, kind);
    if (contact_frame(kind, vertices, x).distance > list.offset[i]) return;
    stencils.emplace_back(vertices, vertices + list.points);
  });
  return stencils;
}

ContactStatus SurfaceContact::status(const Eigen::Matrix3Xd& x) {
  set_active(x);
  ContactStatus status;
  status.reached = reached_;
  for_each_active([&](ContactKind, size_t, const int*, std::array<int, 2>) { ++status.active; });
  status.rubbing = friction_ ? friction_->count() : 0;
  status.smallest_gap = status.active > 0 ? active_.smallest_gap : infinity;
  status.stiffness = kappa_.values().size() > 0 ? kappa_.values().maxCoeff() : 0;
  status.energy_added = energy_added_;
  return status;
}

std::vector<std::string> SurfaceContact::skipped() const {
  std::vector<std::string> lines;
  if (!reached_) lines.emplace_back("surface contact: no pair of surfaces came within dhat");
  if (!friction_) lines.emplace_back("surface friction: no pair has a coefficient of friction");
  if (friction_ && friction_->count() == 0) lines.emplace_back("surface friction: no pair with friction within dhat");
  return lines;
}

}  // namespace ergon
