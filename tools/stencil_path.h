#pragma once
// Motions of one stencil along which its energy is looked at: points as functions of one quantity, such as the angle of
// a hinge or the gap between two edges.

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

namespace ergon {

struct StencilPath {
  std::string name;      // "length", "angle", "distance", "scale"
  std::string quantity;  // of the axis: "angle"
  std::string unit;      // "rad", "m", "1"
  double low = 0, high = 1, rest = 0;
  // The points, one after the other, 3 components each (m), and how they change.
  std::function<Eigen::VectorXd(double)> positions, change;
};

// Of a stencil by its name, most telling first. Lengths at rest are 1 m.
std::vector<StencilPath> stencil_paths(const std::string& stencil);

}  // namespace ergon
