#pragma once
// Where on a set of points or triangles a point is nearest to: a tree of their boxes that does not change. It
// establishes that what is found is nearest, up to rounding of the distance; of several, the first.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

namespace ergon {

struct NearPlace {
  double distance = std::numeric_limits<double>::infinity();  // m
  int part = -1;                                              // of those given; -1: there was none
  std::array<double, 3> weights{};                            // of its corners; they add to 1
};

class PlaceSearch {
 public:
  // `parts`: triangles, by columns of X (m, 3 x vertices); a point is one with three corners alike.
  PlaceSearch(Eigen::Matrix3Xd X, std::vector<std::array<int, 3>> parts);

  NearPlace nearest(const Eigen::Vector3d& x) const;
  const std::array<int, 3>& part(int number) const { return parts_[static_cast<size_t>(number)]; }
  Eigen::Vector3d position(const NearPlace& place) const;  // m

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int first = 0, last = 0;  // of order_
    int second = -1;          // its second child, the first is next; -1: a leaf
  };
  void split(int first, int last);
  void search(int node, const Eigen::Vector3d& x, NearPlace& best) const;

  Eigen::Matrix3Xd X_;
  std::vector<std::array<int, 3>> parts_;
  std::vector<int> order_;  // of parts
  std::vector<Node> nodes_;
};

}  // namespace ergon
