#pragma once
// Offsets within one object, where that is thicker than its edges are long: parts of a mesh that are near each other at
// rest cannot keep the distance that its thickness asks for. It establishes that no pair of an object is closer than
// its offset at rest, so that every mesh may start at rest, however thick it is.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace ergon {

struct CollisionSurface;

// Of some pairs of primitives, the number of their offset among those that are lower than their object's.
class RestOffsets {
 public:
  enum Kind : size_t { point_triangle, edge_edge, point_edge, point_point };  // as the lists of candidates

  bool empty() const { return lowered_.empty(); }
  // 0: the object's own.
  std::uint32_t number(Kind kind, const std::array<int, 2>& pair) const {
    const Pairs& pairs = pairs_[kind];
    const auto first = static_cast<size_t>(pair[0]);
    if (first + 1 >= pairs.starts.size()) return 0;
    for (std::uint32_t i = pairs.starts[first]; i < pairs.starts[first + 1]; ++i)
      if (pairs.second[i] == pair[1]) return pairs.number[i];
    return 0;
  }
  double lowered(std::uint32_t number) const { return lowered_[number - 1]; }  // m; number > 0

 private:
  friend void lower_offsets(CollisionSurface& surface, const Eigen::Matrix3Xd& X, double dhat);

  // Pairs by their first primitive.
  struct Pairs {
    std::vector<std::uint32_t> starts;
    std::vector<int> second;
    std::vector<std::uint32_t> number;
  };
  std::array<Pairs, 4> pairs_;
  std::vector<double> lowered_;
};

// Gives each pair of primitives of one object whose distance d at rest is below offset + dhat (X: rest positions, m)
// the offset min(d/2, max(d - dhat, 0)): they may come half as near as they are at rest, and their barrier does not act
// there unless it would without thickness. All others keep the offset of their object.
void lower_offsets(CollisionSurface& surface, const Eigen::Matrix3Xd& X, double dhat);

}  // namespace ergon
