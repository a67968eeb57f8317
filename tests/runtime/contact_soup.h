#pragma once
// Random scenes of shells, rods and loose points, some of them at rest, for tests against brute force.

#include <Eigen/Core>
#include <random>

#include "runtime/contact/make_surface.h"

namespace ergon {

struct Soup {
  CollisionSurface surface;
  Eigen::Matrix3Xd x;
};

struct SoupOptions {
  unsigned seed = 1;
  int cells = 4;                              // of each cloth, per side
  int loose = 30;                             // points
  double noise = 0.3;                         // of a cell
  double offset = 0;                          // m, of all coordinates
  double resting = 0;                         // share of vertices that do not move
  std::vector<double> radius = {0, 0, 0, 0};  // m, per object
};

// Two cloths of side 1 that cross one another, a rod that winds through them, and loose points about: four objects.
Soup make_soup(const SoupOptions& options);

Eigen::Matrix3Xd noise(const Eigen::Matrix3Xd& x, double amount, unsigned seed);

}  // namespace ergon
