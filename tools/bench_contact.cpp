#include <fmt/format.h>

#include <optional>
#include <random>

#include "runtime/contact/active_set.h"
#include "runtime/contact/make_surface.h"
#include "runtime/contact/step_bound.h"
#include "runtime/error.h"
#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/system.h"
#include "tools/allocations.h"
#include "tools/bench.h"
#include "tools/choices.h"
#include "tools/installation.h"
#include "tools/median.h"

namespace ergon {
namespace {

using Eigen::Matrix3Xd;

// Two noisy cloths of side 1 m, half of dhat apart, the second displaced by half a cell in both directions.
struct Cloths {
  CollisionSurface surface;
  Matrix3Xd X;
  double h, dhat;  // m

  explicit Cloths(int cells) : h(1.0 / cells), dhat(h / 4) {
    const Mesh lower = box_mesh(Element::tri3, {1, 1, 1}, {cells, cells, 1});
    Mesh upper = lower;
    upper.X.colwise() += Eigen::Vector3d(h / 2, h / 2, dhat / 2);
    const int n = lower.vertices();
    surface = make_surface({{"lower", &lower, 0, 0}, {"upper", &upper, n, 0}},
                           std::vector<char>(2 * static_cast<size_t>(n), 1));
    X.resize(3, 2 * n);
    X << lower.X, upper.X;
  }
  // Noise of 0.1 h in the plane and 0.1 dhat across.
  Matrix3Xd state(unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    Matrix3Xd x = X;
    for (Eigen::Index v = 0; v < x.cols(); ++v) {
      for (int k = 0; k < 3; ++k) x(k, v) += 0.1 * (k < 2 ? h : dhat) * unit(random);
    }
    return x;
  }
};

// The barrier's potentials, one for each case.
class Barriers {
 public:
  Barriers(const std::string& barrier, const Cloths& cloths, const std::vector<ActiveList ActiveSet::*>& lists)
      : lists_(lists), system_(static_cast<int>(cloths.X.cols())) {
    const std::pair<const char*, const char*> distances[] = {{"point_point", ""},         {"point_edge", ""},
                                                             {"point_triangle", ""},      {"edge_edge", "line"},
                                                             {"edge_edge", "point_edge"}, {"edge_edge", "point_point"}};
    for (const auto& [distance, part] : distances) {
      const std::string name = fmt::format("{}:{}", barrier, distance);
      system_.add(Potential::on_stencils(name + part, load_kernel(find_energy(name), part, lanes::best_lanes()), {},
                                         cloths.X, {{"dhat", {cloths.dhat}}}, {}));
    }
  }
  void set(const ActiveSet& active, const Matrix3Xd& X) {
    for (size_t k = 0; k < lists_.size(); ++k) {
      const ActiveList& list = active.*lists_[k];
      Potential& potential = system_.potential(static_cast<int>(k));
      potential.set_stencils(list.vertices, X, {});
      potential.set_lag("kappa", list.multiplicity);
    }
  }
  System& system() { return system_; }

 private:
  std::vector<ActiveList ActiveSet::*> lists_;
  System system_;
};

}  // namespace

void bench_contact(const BenchContact& options, Rows& rows) {
  if (options.cells < 1) throw InputError(fmt::format("{} cells per edge; at least 1 is needed", options.cells));
  set_threads(options.threads);
  const Cloths cloths(options.cells);
  const Matrix3Xd states[] = {cloths.state(1), cloths.state(2)};
  const Matrix3Xd &x = states[0], &X = cloths.X, motion = states[1] - states[0];
  const std::vector<ActiveList ActiveSet::*> lists = {
      &ActiveSet::point_point, &ActiveSet::point_edge,          &ActiveSet::point_triangle,
      &ActiveSet::edge_edge,   &ActiveSet::parallel_point_edge, &ActiveSet::parallel_point_point};
  const auto stencils = [&](const ActiveSet& active) {
    size_t count = 0;
    for (const auto list : lists) count += (active.*list).count();
    return count;
  };
  const auto measure = [&](const char* part, const char* of, const auto& count, const auto& call) {
    const double seconds = median_seconds(call);
    const long before = allocations();
    call();
    const long asked = allocations() - before;
    const size_t counted = count();
    rows.add({{"part", part},
              {"of", of},
              {"count", counted},
              {"threads", options.threads},
              {"ms", seconds * 1e3},
              {"ns_each", seconds * 1e9 / static_cast<double>(std::max<size_t>(counted, 1))},
              {"allocations", asked}});
  };

  std::optional<BroadPhase> broad;
  ActiveSet active;
  const auto candidates = [&] {
    return broad->candidates().point_triangle.size() + broad->candidates().edge_edge.size();
  };
  const auto active_count = [&] { return stencils(active); };
  measure("candidates from nothing", "candidates", candidates, [&] {
    broad.emplace(cloths.surface);
    broad->cover(x, x, cloths.dhat);
  });
  // Both cloths go to and fro by half a cell against each other, so that no list serves twice.
  Matrix3Xd away = x;
  away.rightCols(x.cols() / 2).row(0).array() += cloths.h;
  bool turn = false;
  measure("candidates updated", "candidates", candidates, [&] {
    turn = !turn;
    const Matrix3Xd& at = turn ? away : x;
    broad->cover(at, at, cloths.dhat);
  });
  broad.emplace(cloths.surface);
  broad->cover(x, x, cloths.dhat);
  measure("candidates kept", "candidates", candidates, [&] { broad->cover(x, x, cloths.dhat); });
  measure("active set", "candidates", candidates,
          [&] { find_active(cloths.surface, broad->candidates(), x, X, cloths.dhat, active); });

  Barriers barriers(options.barrier, cloths, lists);
  Matrix3Xd gradient;
  BlockMatrix hessian;
  measure("stencil lists", "stencils", active_count, [&] { barriers.set(active, X); });
  measure("barrier value", "stencils", active_count, [&] { barriers.system().value(x); });
  measure("barrier gradient", "stencils", active_count, [&] { barriers.system().gradient(x, gradient); });
  measure("barrier Hessian", "stencils", active_count,
          [&] { barriers.system().hessian(x, Projection::clamp, gradient, hessian); });

  BroadPhase moving(cloths.surface);
  moving.cover(x, states[1], cloths.dhat);
  double step = 0;
  measure(
      "step bound", "candidates",
      [&] { return moving.candidates().point_triangle.size() + moving.candidates().edge_edge.size(); },
      [&] { step = largest_step(cloths.surface, moving.candidates(), x, motion); });

  // What an iteration asks for, between two states.
  int from = 0;
  measure("Newton iteration", "stencils", active_count, [&] {
    const Matrix3Xd &start = states[from], &end = states[1 - from];
    moving.cover(start, end, cloths.dhat);
    step = largest_step(cloths.surface, moving.candidates(), start, from == 0 ? motion : -motion);
    moving.cover(end, end, cloths.dhat);
    find_active(cloths.surface, moving.candidates(), end, X, cloths.dhat, active);
    barriers.set(active, X);
    barriers.system().hessian(end, Projection::clamp, gradient, hessian);
    from = 1 - from;
  });
}

}  // namespace ergon
