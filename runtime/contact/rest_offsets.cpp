#include "runtime/contact/rest_offsets.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/contact/broad_phase.h"
#include "runtime/contact/collision_surface.h"
#include "runtime/contact/distance.h"

namespace ergon {
namespace {

constexpr double steps =
    1024;  // of an object's offset, in which lowered ones are counted: equal shapes have equal ones

struct Lowered {
  std::array<int, 2> pair;
  std::uint32_t number;
};

}  // namespace

void lower_offsets(CollisionSurface& surface, const Eigen::Matrix3Xd& X, double dhat) {
  surface.rest_offsets = {};
  if (std::all_of(surface.radius.begin(), surface.radius.end(), [](double radius) { return radius == 0; })) return;
  BroadPhase broad(surface);
  broad.cover(X, X, dhat);
  const Candidates& candidates = broad.candidates();

  const auto at = [&](int vertex) -> Eigen::Vector3d { return X.col(vertex); };
  const auto point = [&](int i) { return surface.points[static_cast<size_t>(i)]; };
  const auto edge = [&](int i) -> const auto& { return surface.edges[static_cast<size_t>(i)]; };
  const auto triangle = [&](int i) -> const auto& { return surface.triangles[static_cast<size_t>(i)]; };

  std::array<std::vector<Lowered>, 4> found;
  std::map<double, std::uint32_t> numbers;
  // `first` and `second`: a vertex of each primitive.
  const auto consider = [&](RestOffsets::Kind kind, const std::array<int, 2>& pair, int first, int second,
                            double gap2) {
    const int object = surface.object[static_cast<size_t>(first)];
    if (object != surface.object[static_cast<size_t>(second)]) return;
    const double offset = surface.offset(object, object), d = std::sqrt(gap2);
    if (!(d < offset + dhat) || offset == 0) return;
    const double wanted = std::max(0.0, std::min(d / 2, d - dhat));
    const double lowered = std::floor(wanted / offset * steps) / steps * offset;
    const auto [at_number, is_new] = numbers.emplace(lowered, surface.rest_offsets.lowered_.size() + 1);
    if (is_new) surface.rest_offsets.lowered_.push_back(lowered);
    found[kind].push_back({pair, at_number->second});
  };
  for (const auto& pair : candidates.point_triangle) {
    const auto& t = triangle(pair[1]);
    consider(RestOffsets::point_triangle, pair, point(pair[0]), t[0],
             point_triangle_distance(at(point(pair[0])), at(t[0]), at(t[1]), at(t[2])).gap2);
  }
  for (const auto& pair : candidates.edge_edge) {
    const auto &a = edge(pair[0]), &b = edge(pair[1]);
    consider(RestOffsets::edge_edge, pair, a[0], b[0], edge_edge_distance(at(a[0]), at(a[1]), at(b[0]), at(b[1])).gap2);
  }
  for (const auto& pair : candidates.point_edge) {
    const auto& e = edge(pair[1]);
    consider(RestOffsets::point_edge, pair, point(pair[0]), e[0],
             point_edge_distance(at(point(pair[0])), at(e[0]), at(e[1])).gap2);
  }
  for (const auto& pair : candidates.point_point) {
    const int p = point(pair[0]), q = point(pair[1]);
    consider(RestOffsets::point_point, pair, p, q, (at(p) - at(q)).squaredNorm());
  }

  const size_t firsts = std::max(surface.points.size(), surface.edges.size());
  for (size_t kind = 0; kind < found.size(); ++kind) {
    std::vector<Lowered>& of = found[kind];
    if (of.empty()) continue;
    std::sort(of.begin(), of.end(), [](const Lowered& a, const Lowered& b) { return a.pair < b.pair; });
    RestOffsets::Pairs& pairs = surface.rest_offsets.pairs_[kind];
    pairs.starts.assign(firsts + 1, 0);
    for (const Lowered& each : of) {
      ++pairs.starts[static_cast<size_t>(each.pair[0]) + 1];
      pairs.second.push_back(each.pair[1]);
      pairs.number.push_back(each.number);
    }
    for (size_t i = 1; i < pairs.starts.size(); ++i) pairs.starts[i] += pairs.starts[i - 1];
  }
}

}  // namespace ergon
