#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/quadrature.h"
#include "runtime/system.h"
#include "tests/runtime/dense_oracle.h"

namespace ergon {
namespace {

using namespace testing;  // NOLINT

const Parameters kStiff{{"mu", {3.0}}, {"lambda", {7.0}}};

std::vector<int> widths() {
  std::vector<int> usable;
  for (const int w : lanes::kWidths) {
    if (w <= lanes::best_lanes()) usable.push_back(w);
  }
  return usable;
}

// Boxes whose inner vertices are moved at rest, so that every element has its own shape.
Mesh irregular(Mesh mesh) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.04, 0.04);
  for (int v = 0; v < mesh.vertices(); ++v) {
    const Eigen::Array3d X = mesh.X.col(v).array();
    if ((X > 0.01).all() && (X < Eigen::Array3d(0.99, 1.19, 0.89)).all()) {
      mesh.X.col(v) += Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    }
  }
  return mesh;
}

// Of every solid element; those of degree 2 are curved inside.
std::vector<Mesh> solid_meshes() {
  std::vector<Mesh> meshes;
  for (const Element element : all_elements()) {
    if (dimension_of(element) == 3) meshes.push_back(irregular(box_mesh(element, {1, 1.2, 0.9}, {2, 2, 2})));
  }
  meshes.push_back(to_quadratic(meshes.front(), Element::tet10));  // straight
  return meshes;
}

// What reproduces constant stress on curved cells: products of cofactors and gradients have degree 3 on a Tet10.
int patch_exactness(Element element) { return std::max(default_exactness(element), element == Element::tet10 ? 3 : 0); }

TEST(SystemElements, SolidsEqualTheDenseSum) {
  for (const Mesh& mesh : solid_meshes()) {
    Eigen::Matrix3Xd x = mesh.X;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> uniform(-0.15, 0.15);
    for (int v = 0; v < mesh.vertices(); ++v) {
      x.col(v) += Eigen::Vector3d(uniform(random), uniform(random), uniform(random));
    }
    for (const Projection projection : {Projection::clamp, Projection::absolute, Projection::none}) {
      Dense dense(mesh.vertices());
      dense.add_solid<NeoHookeanLaw>(x, mesh, 0, {3, 7}, projection);
      EXPECT_TRUE(projection == Projection::none || dense.indefinite > 10) << dense.indefinite;
      for (const int width : widths()) {
        SCOPED_TRACE(::testing::Message() << name_of(mesh.element) << " width " << width);
        System system(mesh.vertices());
        system.add(Potential::on_mesh("solid", kernel_of<NeoHookeanLaw>(width), mesh, 0, kStiff));
        Eigen::Matrix3Xd gradient;
        BlockMatrix matrix;
        const Evaluation all = system.hessian(x, projection, gradient, matrix);
        EXPECT_NEAR(all.value, dense.value, 1e-12 * std::abs(dense.value));
        EXPECT_EQ(all.indefinite, dense.indefinite);
        EXPECT_LT(difference(gradient.reshaped(), dense.gradient), 1e-12);
        EXPECT_LT(difference(to_dense(matrix), dense.hessian), 1e-12);
      }
    }
  }
}

TEST(SystemElements, LinearFieldsGiveOneDeformationGradient) {
  Eigen::Matrix3d F;
  F << 1.2, 0.1, -0.2, 0.05, 0.9, 0.3, 0.1, -0.15, 1.1;
  const double density = [&] {
    const double params[2] = {3, 7};
    return NeoHookeanLaw::psi(F.data(), nullptr, params);
  }();
  for (const Mesh& mesh : solid_meshes()) {
    for (const int width : widths()) {
      SCOPED_TRACE(::testing::Message() << name_of(mesh.element) << " width " << width);
      System system(mesh.vertices());
      system.add(
          Potential::on_mesh("solid", kernel_of<NeoHookeanLaw>(width), mesh, 0, kStiff, patch_exactness(mesh.element)));
      const Eigen::Matrix3Xd x = (F * mesh.X).colwise() + Eigen::Vector3d(100, -50, 30);
      Eigen::Matrix3Xd gradient;
      const Evaluation all = system.gradient(x, gradient);
      EXPECT_NEAR(all.value, density * 1 * 1.2 * 0.9, 2e-12);
      // Forces of a uniform stress act on the boundary only.
      for (int v = 0; v < mesh.vertices(); ++v) {
        const Eigen::Array3d X = mesh.X.col(v).array();
        const bool inside = (X > 0.01).all() && (X < Eigen::Array3d(0.99, 1.19, 0.89)).all();
        if (inside) {
          EXPECT_LT(gradient.col(v).norm(), 1e-12);
        }
      }
      EXPECT_LT(gradient.rowwise().sum().norm(), 1e-12);
      EXPECT_GT(gradient.norm(), 0.1);
    }
  }
}

TEST(SystemElements, MembranesFeelTheirStretchAndNotTheirPlace) {
  Mesh sheet;
  sheet.element = Element::tri3;
  sheet.X.resize(3, 4);
  sheet.X << 0, 2, 2, 0,  //
      0, 0, 1, 1,         //
      0, 0, 0, 0;
  const Eigen::Matrix3d tilt = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  sheet.X = tilt * sheet.X;
  sheet.cells = {0, 1, 2, 2, 3, 0};
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(-1.1, Eigen::Vector3d(3, -1, 1).normalized()).toRotationMatrix();
  for (const int width : widths()) {
    System system(4);
    system.add(Potential::on_mesh("sheet", kernel_of<MembraneLaw>(width), sheet, 0, {{"k", {5.0}}}));
    EXPECT_NEAR(system.value(turn * sheet.X).value, 0, 1e-14);
    // Stretched by 1.1 along one axis of the sheet: (1.1^2 - 1)^2 k on an area of 2.
    const Eigen::Matrix3d stretch = tilt * Eigen::Vector3d(1, 1.1, 1).asDiagonal() * tilt.transpose();
    const Eigen::Matrix3Xd x = turn * stretch * sheet.X;
    EXPECT_NEAR(system.value(x).value, 2 * 5 * 0.21 * 0.21, 1e-13);
    Eigen::Matrix3Xd gradient, unused;
    BlockMatrix matrix;
    system.hessian(x, Projection::none, gradient, matrix);
    const Eigen::MatrixXd dense = to_dense(matrix);
    constexpr double kStep = 1e-5;
    for (int v = 0; v < 4; ++v) {
      for (int c = 0; c < 3; ++c) {
        Eigen::Matrix3Xd plus = x, minus = x, at_plus, at_minus;
        plus(c, v) += kStep, minus(c, v) -= kStep;
        const double up = system.gradient(plus, at_plus).value, down = system.gradient(minus, at_minus).value;
        EXPECT_NEAR((up - down) / (2 * kStep), gradient(c, v), 1e-8);
        EXPECT_LT(((at_plus - at_minus) / (2 * kStep) - dense.col(3 * v + c).reshaped(3, 4)).norm(), 1e-7);
      }
    }
  }
}

TEST(SystemElements, WidthsAgreeOnALargerMesh) {
  const Mesh mesh = box_tets({1, 1, 1}, {7, 6, 5});
  Eigen::Matrix3Xd x = mesh.X;
  for (int v = 0; v < mesh.vertices(); ++v) {
    x.col(v) += 0.05 * Eigen::Vector3d(std::sin(13.0 * v), std::sin(17.0 * v), std::sin(19.0 * v));
  }
  Eigen::Matrix3Xd first_gradient;
  Eigen::MatrixXd first_hessian;
  long first_indefinite = 0;
  for (const int width : widths()) {
    System system(mesh.vertices());
    system.add(Potential::on_mesh("solid", kernel_of<NeoHookeanLaw>(width), mesh, 0, kStiff));
    Eigen::Matrix3Xd gradient;
    BlockMatrix matrix;
    const Evaluation all = system.hessian(x, Projection::clamp, gradient, matrix);
    if (width == 1) {
      first_gradient = gradient;
      first_hessian = to_dense(matrix);
      first_indefinite = all.indefinite;
      EXPECT_GT(first_indefinite, 100);
      continue;
    }
    EXPECT_LT(difference(gradient, first_gradient), 1e-13);
    EXPECT_LT(difference(to_dense(matrix), first_hessian), 1e-12);
    EXPECT_EQ(all.indefinite, first_indefinite);
  }
}

}  // namespace
}  // namespace ergon
