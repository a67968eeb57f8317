#include "scenes/start_noise.h"

#include <Eigen/Geometry>
#include <cstdint>

namespace ergon {
namespace {

// The output function of SplitMix64: Steele, Lea, Flood 2014, Fast Splittable Pseudorandom Number Generators, OOPSLA.
std::uint64_t mixed(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

// In [-1, 1), by the words that it belongs to.
double number(std::uint64_t seed, std::uint64_t object, std::uint64_t vertex, std::uint64_t axis) {
  std::uint64_t word = 0;
  for (const std::uint64_t part : {seed, object, vertex, axis}) word = mixed(word ^ part);
  return static_cast<double>(word >> 11) * 0x1p-52 - 1;
}

Eigen::Vector3d vector(int seed, size_t object, std::uint64_t vertex) {
  Eigen::Vector3d out;
  for (std::uint64_t axis = 0; axis < 3; ++axis)
    out[static_cast<Eigen::Index>(axis)] = number(static_cast<std::uint64_t>(seed), object, vertex, axis);
  return out;
}

}  // namespace

void add_start_noise(const StartSettings& start, const std::vector<Body>& bodies, size_t objects, const System& system,
                     const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& v) {
  if (!(start.noise > 0)) return;
  for (size_t i = 0; i < objects; ++i) {
    const Body& body = bodies[i];
    if (body.affine()) {
      const auto at = x.middleCols<4>(body.first_control);
      const Eigen::Matrix<double, 3, 4> arm = at.colwise() - Eigen::Vector3d(at.rowwise().mean());
      const double radius = std::sqrt(arm.colwise().squaredNorm().maxCoeff());
      const Eigen::Vector3d move = start.noise * vector(start.seed, i, 0),
                            turn = start.noise / radius * vector(start.seed, i, 1);
      for (int k = 0; k < 4; ++k) v.col(body.first_control + k) += move + turn.cross(arm.col(k));
      continue;
    }
    for (int k = 0; k < body.ordered.vertices(); ++k) {
      const int vertex = body.first_vertex + k;
      if (system.block_of(vertex) < 0) continue;
      const auto own = static_cast<std::uint64_t>(body.vertex_from[static_cast<size_t>(k)]);
      v.col(vertex) += start.noise * vector(start.seed, i, own);
    }
  }
  system.carriers().place(v);
}

}  // namespace ergon
