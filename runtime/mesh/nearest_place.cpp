#include "runtime/mesh/nearest_place.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "runtime/contact/distance.h"

namespace ergon {
namespace {

constexpr int most_in_leaf = 4;

}  // namespace

PlaceSearch::PlaceSearch(Eigen::Matrix3Xd X, std::vector<std::array<int, 3>> parts)
    : X_(std::move(X)), parts_(std::move(parts)), order_(parts_.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  if (!parts_.empty()) split(0, static_cast<int>(parts_.size()));
}

Eigen::Vector3d PlaceSearch::position(const NearPlace& place) const {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < 3; ++i) out += place.weights[i] * X_.col(part(place.part)[i]);
  return out;
}

void PlaceSearch::split(int first, int last) {
  const auto at = nodes_.size();
  nodes_.push_back({{}, first, last, -1});
  for (int i = first; i < last; ++i)
    for (const int corner : part(order_[static_cast<size_t>(i)])) nodes_[at].box.extend(X_.col(corner));
  if (last - first <= most_in_leaf) return;
  Eigen::Index axis = 0;
  nodes_[at].box.sizes().maxCoeff(&axis);
  const auto before = [&](int a, int b) {
    double sum = 0;
    for (size_t i = 0; i < 3; ++i) sum += X_(axis, part(a)[i]) - X_(axis, part(b)[i]);
    return sum < 0 || (sum == 0 && a < b);
  };
  const int middle = (first + last) / 2;
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, before);
  split(first, middle);
  nodes_[at].second = static_cast<int>(nodes_.size());
  split(middle, last);
}

void PlaceSearch::search(int node, const Eigen::Vector3d& x, NearPlace& best) const {
  const Node& here = nodes_[static_cast<size_t>(node)];
  if (here.box.exteriorDistance(x) > best.distance) return;
  if (here.second >= 0) {
    const int children[] = {node + 1, here.second};
    const auto away = [&](int child) { return nodes_[static_cast<size_t>(child)].box.squaredExteriorDistance(x); };
    const size_t nearer = away(children[1]) < away(children[0]) ? 1 : 0;
    search(children[nearer], x, best);
    search(children[1 - nearer], x, best);
    return;
  }
  for (int i = here.first; i < here.last; ++i) {
    const int number = order_[static_cast<size_t>(i)];
    const std::array<int, 3>& corners = part(number);
    const PointTriangleDistance found =
        point_triangle_distance(x, X_.col(corners[0]), X_.col(corners[1]), X_.col(corners[2]));
    const double distance = std::sqrt(found.gap2);
    if (distance > best.distance || (distance == best.distance && number > best.part)) continue;
    best = {distance, number, {found.weight[0], found.weight[1], found.weight[2]}};
  }
}

NearPlace PlaceSearch::nearest(const Eigen::Vector3d& x) const {
  NearPlace best;
  if (!nodes_.empty()) search(0, x, best);
  return best;
}

}  // namespace ergon
