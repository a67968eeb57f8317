// A patch of cells of any shape whose boundary is deformed alike everywhere must deform so within: every element
// reproduces constant strain, or refining a mesh does not lead to the solution.

#include <Eigen/Geometry>
#include <random>

#include "runtime/mesh/mesh_build.h"
#include "tools/verify/model.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

constexpr std::array<int, 3> cells = {3, 3, 3};

// Inner vertices are moved by up to an eighth of a cell.
Mesh distorted(Element element, const Eigen::Vector3d& size) {
  Mesh mesh = box_mesh(linear_element(element), size, cells);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-0.125, 0.125);
  const int dimension = dimension_of(element);
  for (int v = 0; v < mesh.vertices(); ++v) {
    bool inside = true;
    for (int k = 0; k < dimension; ++k) inside = inside && mesh.X(k, v) > 1e-9 && mesh.X(k, v) < size[k] - 1e-9;
    for (int k = 0; k < dimension && inside; ++k)
      mesh.X(k, v) += part(random) * size[k] / cells[static_cast<size_t>(k)];
  }
  return degree_of(element) == 1 ? mesh : to_quadratic(mesh, element);
}

void add_law(Model& model, int dimension) {
  if (dimension == 3)
    model.add("stable_neo_hookean", {{"E", {1e5}}, {"nu", {0.3}}});
  else if (dimension == 2)
    model.add("neo_hookean_membrane", {{"E", {1e5}}, {"nu", {0.3}}, {"h", {1e-3}}});
  else
    model.add("rod_stretching", {{"EA", {10}}});
}

VerifyRow patch_row(Element element) {
  const Eigen::Vector3d size(1.2, 1, 0.9);
  const int dimension = dimension_of(element);
  Model model(distorted(element, size));
  add_law(model, dimension);
  // Stretched along all axes of the element, sheared and turned: a membrane in tension is stiff across its plane too.
  Eigen::Matrix3d F;
  F << 1.2, 0.1, -0.05, 0, 1.15, 0.08, 0.04, 0, 1.1;
  F = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()) * F;
  const Eigen::Matrix3Xd exact = F * model.mesh().X;
  model.hold(vertices_where(model.mesh(), [&](const Eigen::Vector3d& X) {
    for (int k = 0; k < dimension; ++k)
      if (X[k] < 1e-9 || X[k] > size[k] - 1e-9) return true;
    return false;
  }));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> noise(-0.01, 0.01);
  model.x = exact;
  for (int v = 0; v < model.mesh().vertices(); ++v)
    if (const Eigen::Vector3d X = model.mesh().X.col(v); true) {
      bool inside = true;
      for (int k = 0; k < dimension; ++k) inside = inside && X[k] > 1e-9 && X[k] < size[k] - 1e-9;
      if (inside)
        for (int k = 0; k < 3; ++k) model.x(k, v) += noise(random);
    }
  model.solve(1e-10);
  return {.quantity = "largest distance from the affine map / size",
          .element = name_of(element),
          .mesh = dimension == 3   ? "3x3x3"
                  : dimension == 2 ? "3x3"
                                   : "3",
          .value = (model.x - exact).cwiseAbs().maxCoeff() / size[0],
          .bound = 1e-12};
}

}  // namespace

VerifyCase patch_test_case() {
  return {
      "patch_test", "constant strain on distorted cells, for every element",
      "Irons, Razzaque 1972, Experience with the patch test for convergence of finite elements; exact by construction",
      [](const VerifyRows& rows) {
        for (const Element element : all_elements())
          if (dimension_of(element) > 0) rows.add(patch_row(element));
      }};
}

}  // namespace ergon
