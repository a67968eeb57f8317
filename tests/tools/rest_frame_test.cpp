// Membranes and lines whose kernel is given F - I in the axes of the element at rest, against the same law over F: on
// tilted and curved sheets and lines, for all projections and widths; and near rest, where only the former has digits.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>
#include <vector>

#include "runtime/lanes/lanes.h"
#include "tests/runtime/dense_oracle.h"
#include "tools/installation.h"
#include "tools/problem.h"
#include "tools/sample.h"

namespace ergon {
namespace {

Kernel kernel_of(const Energy& energy, int lanes, bool stable) {
  CompileOptions options = compile_options("", lanes);
  options.stable = stable;
  const CompiledKernel compiled = compile(energy, options);
  return {compiled.library, compiled.table};
}

Values values_of(const Energy& energy) {
  Values values;
  for (const Symbol* symbol : needed_inputs(energy))
    values[symbol->name] = sample_values(energy, symbol->role, 0).at(symbol->name);
  return values;
}

// Bent and turned, away from the origin.
Mesh curved(Element element) {
  Mesh mesh = sample_mesh(element, 3);
  for (Eigen::Index v = 0; v < mesh.X.cols(); ++v) mesh.X(2, v) += 0.2 * std::sin(2 * mesh.X(0, v) + mesh.X(1, v));
  const Eigen::AngleAxisd turn(1.1, Eigen::Vector3d(1, -2, 0.5).normalized());
  mesh.X = (turn.toRotationMatrix() * mesh.X).colwise() + Eigen::Vector3d(3, -1, 2);
  return mesh;
}

struct Evaluated {
  Evaluation all;
  double value = 0;
  Eigen::Matrix3Xd gradient, gradient_alone;
  Eigen::MatrixXd hessian;
};

Evaluated evaluate(const Energy& energy, const Kernel& kernel, const Mesh& mesh, const Eigen::Matrix3Xd& x,
                   Projection projection) {
  System system = make_system(energy, kernel, mesh, {}, values_of(energy));
  Evaluated out;
  BlockMatrix matrix;
  out.value = system.value(x).value;
  system.gradient(x, out.gradient_alone);
  out.all = system.hessian(x, projection, out.gradient, matrix);
  out.hessian = testing::to_dense(matrix);
  return out;
}

struct Case {
  const char* energy;
  std::vector<Element> elements;
};
const std::vector<Case> kCases = {
    {"st_venant_kirchhoff_membrane", {Element::tri3, Element::quad9}},
    {"ogden_membrane", {Element::tri3, Element::quad4}},
    {"neo_hookean_membrane", {Element::tri3, Element::tri6, Element::quad4}},
    {"baraff_witkin", {Element::tri3}},
    {"orthotropic_membrane", {Element::tri3, Element::quad4}},
    {"green_rod", {Element::edge2, Element::edge3}},
    {"rod_stretching", {Element::edge2, Element::edge3}},
};

class RestFrame : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (GetParam() > lanes::best_lanes()) GTEST_SKIP() << "this machine lacks such vectors";
  }
};

TEST_P(RestFrame, GivesWhatTheLawOverFGives) {
  for (const Case& c : kCases) {
    const Energy energy = find_energy(c.energy);
    const Kernel small = kernel_of(energy, GetParam(), true), plain = kernel_of(energy, GetParam(), false);
    ASSERT_EQ(small->displacement, 1) << c.energy;
    ASSERT_EQ(plain->displacement, 0) << c.energy;
    for (const Element element : c.elements) {
      const Mesh mesh = curved(element);
      const Eigen::Matrix3Xd x = displaced(mesh.X, 0.3, 0.06);
      for (const Projection projection : {Projection::none, Projection::clamp, Projection::absolute}) {
        SCOPED_TRACE(std::string(c.energy) + " on " + std::string(name_of(element)));
        const Evaluated a = evaluate(energy, small, mesh, x, projection),
                        b = evaluate(energy, plain, mesh, x, projection);
        EXPECT_NEAR(a.value / b.value, 1, 1e-12);
        EXPECT_NEAR(a.all.value / b.value, 1, 1e-12);
        EXPECT_LE((a.gradient - b.gradient).norm(), 1e-12 * b.gradient.norm());
        EXPECT_LE((a.gradient_alone - b.gradient).norm(), 1e-12 * b.gradient.norm());
        EXPECT_LE((a.hessian - b.hessian).norm(), 1e-12 * b.hessian.norm());
        EXPECT_EQ(a.all.indefinite > 0, b.all.indefinite > 0);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Lanes, RestFrame, ::testing::ValuesIn(lanes::kWidths));

// To first order forces are the Hessian at rest times the displacements. At strains of 1e-10 what is formed of F has
// six digits of them.
TEST(RestFrameDigits, AreThoseOfTheDisplacements) {
  for (const char* name : {"st_venant_kirchhoff_membrane", "neo_hookean_membrane", "green_rod"}) {
    const Energy energy = find_energy(name);
    const Mesh mesh = curved(default_element(energy));
    const Eigen::Matrix3Xd x = displaced(mesh.X, 0.3, 3e-11), u = x - mesh.X;
    double error[2];
    for (const bool stable : {false, true}) {
      const Kernel kernel = kernel_of(energy, lanes::best_lanes(), stable);
      const Eigen::MatrixXd stiffness = evaluate(energy, kernel, mesh, mesh.X, Projection::none).hessian;
      const Eigen::Matrix3Xd force = evaluate(energy, kernel, mesh, x, Projection::none).gradient;
      const Eigen::VectorXd linear = stiffness * u.reshaped();
      error[stable] = (force.reshaped() - linear).norm() / linear.norm();
    }
    EXPECT_LE(error[1], 1e-8) << name;
    EXPECT_GE(error[0], 1e-7) << name << ": the test shows nothing";
  }
}

}  // namespace
}  // namespace ergon
