#include "runtime/mesh/edge_normals.h"

#include <Eigen/Geometry>
#include <array>

#include "runtime/mesh/mesh_stencils.h"

namespace ergon {
namespace {

// Calls f(triangle's three vertices, its three edges) for each triangle.
template <class F>
void for_each_triangle(const Mesh& mesh, F f) {
  const std::vector<int> stencils = stencils_on_mesh("shell_triangle", mesh);
  for (size_t start = 0; start < stencils.size(); start += 6) {
    const int* points = &stencils[start];
    const std::array<int, 3> edges = {points[3] - mesh.vertices(), points[4] - mesh.vertices(),
                                      points[5] - mesh.vertices()};
    f(points, edges);
  }
}

int edges_in(const Mesh& mesh) { return static_cast<int>(stencils_on_mesh("edge", mesh).size()) / 2; }

}  // namespace

Eigen::Matrix3Xd edge_normal_tips(const Mesh& mesh) {
  const std::vector<int> edges = stencils_on_mesh("edge", mesh);
  Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, edges_in(mesh)), first = sums;
  for_each_triangle(mesh, [&](const int* t, const std::array<int, 3>& of) {
    const Eigen::Vector3d normal =
        (mesh.X.col(t[1]) - mesh.X.col(t[0])).cross(mesh.X.col(t[2]) - mesh.X.col(t[0])).normalized();
    for (const int e : of) {
      if (first.col(e).isZero(0)) first.col(e) = normal;
      sums.col(e) += normal;
    }
  });
  for (int e = 0; e < sums.cols(); ++e) {
    const auto a = mesh.X.col(edges[2 * static_cast<size_t>(e)]), b = mesh.X.col(edges[2 * static_cast<size_t>(e) + 1]);
    // Of triangles folded onto each other, and of one that is turned over, no angle can be halved.
    const Eigen::Vector3d normal = sums.col(e).norm() > 1e-6 ? sums.col(e).normalized() : first.col(e);
    sums.col(e) = (a + b) / 2 + (b - a).norm() * normal;
  }
  return sums;
}

std::vector<int> edges_of_triangles_within(const Mesh& mesh, const std::vector<int>& vertices) {
  std::vector<char> in(static_cast<size_t>(mesh.vertices()), 0), within(static_cast<size_t>(edges_in(mesh)), 0);
  for (const int v : vertices) in[static_cast<size_t>(v)] = 1;
  for_each_triangle(mesh, [&](const int* t, const std::array<int, 3>& of) {
    for (const int e : of)
      if (in[static_cast<size_t>(t[0])] && in[static_cast<size_t>(t[1])] && in[static_cast<size_t>(t[2])])
        within[static_cast<size_t>(e)] = 1;
  });
  std::vector<int> out;
  for (size_t e = 0; e < within.size(); ++e)
    if (within[e] != 0) out.push_back(static_cast<int>(e));
  return out;
}

Eigen::VectorXd edge_areas(const Mesh& mesh) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(edges_in(mesh));
  for_each_triangle(mesh, [&](const int* t, const std::array<int, 3>& of) {
    const double area = (mesh.X.col(t[1]) - mesh.X.col(t[0])).cross(mesh.X.col(t[2]) - mesh.X.col(t[0])).norm() / 2;
    for (const int e : of) areas[e] += area / 3;
  });
  return areas;
}

}  // namespace ergon
