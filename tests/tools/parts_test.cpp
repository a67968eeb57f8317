// Hessians that fall apart, against the same law with a coupling whose factor is 0, which the compiler cannot know:
// over elements, stencils, widths and precisions, and what they cost.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "codegen/compile.h"
#include "runtime/lanes/lanes.h"
#include "tests/runtime/dense_oracle.h"
#include "tools/installation.h"
#include "tools/problem.h"
#include "tools/sample.h"
#include "tools/stencils.h"

namespace ergon {
namespace {

struct Law {
  std::string header, value, unit, coupling;  // the unit is that of the coupling's factor c
  std::vector<int> parts;
};

const Law kSprings = {"energy two_springs edge_edge\ndof a0 a1 b0 b1 m\nrest A0[3] A1[3] B0[3] B1[3] m\nparam k N/m\n",
                      "k/2*(norm(a1 - a0) - norm(A1 - A0))^2 + k*(norm(b1 - b0) - norm(B1 - B0))^2",
                      "N/m",
                      "c*dot(a1 - a0, b1 - b0)",
                      {0, 1}};
const Law kPull = {"energy pull edge_edge\nframe fixed\ndof a0 a1 b0 b1 m\nparam k N/m\nparam l m\nparam f N\n",
                   "k/2*(norm(a1 - a0) - l)^2 + f*(b1 - b0)[0]",
                   "N/m",
                   "c*dot(a1 - a0, b1 - b0)",
                   {0, -1}};
const Law kThreads = {"density threads membrane\nparam k N/m\n",
                      "k*(norm(column(F, 0)) - 1)^2 + 2*k*(norm(column(F, 1)) - 1)^2",
                      "N/m",
                      "c*dot(column(F, 0), column(F, 1))^2",
                      {0, 1}};
const Law kColumns = {"density columns solid\nparam k Pa\n",
                      "k*(norm(column(F, 0) + column(F, 2)) - 1)^2 + k*(norm(column(F, 1)) - 1)^2",
                      "Pa",
                      "c*dot(column(F, 0), column(F, 1))^2",
                      {0, 1, 0}};

Energy apart(const Law& law) { return parse_energy(law.header + "value " + law.value + "\n", "apart.energy"); }
Energy whole(const Law& law) {
  return parse_energy(law.header + "param c " + law.unit + "\nvalue " + law.value + " + " + law.coupling + "\n",
                      "whole.energy");
}

const Values kValues = {{"k", {3.0}}, {"c", {0.0}}, {"l", {0.3}}, {"f", {2.0}}};

Values values_of(const Energy& energy) {
  Values values;
  for (const Symbol* symbol : needed_inputs(energy)) values[symbol->name] = kValues.at(symbol->name);
  return values;
}

struct Evaluated {
  Evaluation all;
  Eigen::Matrix3Xd gradient;
  Eigen::MatrixXd hessian;
  size_t stored = 0;  // numbers of the matrix
};

struct Setting {
  Mesh mesh;
  std::vector<int> stencils;
  int lanes = 1;
  Precision precision = Precision::double_;
};

Evaluated evaluate(const Energy& energy, const Setting& on, Projection projection) {
  System system =
      make_system(energy, load_kernel(energy, "", on.lanes, on.precision), on.mesh, on.stencils, values_of(energy));
  Evaluated out;
  BlockMatrix matrix;
  out.all = system.hessian(displaced(on.mesh.X, 0.4, 0.12), projection, out.gradient, matrix);
  out.hessian = testing::to_dense(matrix);
  out.stored = matrix.values().size();
  return out;
}

void compare(const Law& law, const Setting& on) {
  const Energy a = apart(law), w = whole(law);
  const Kernel kernel = load_kernel(a, "", on.lanes, on.precision);
  ASSERT_NE(kernel->parts, nullptr);
  EXPECT_EQ(std::vector<int>(kernel->parts, kernel->parts + kernel->q_vectors), law.parts);
  EXPECT_EQ(load_kernel(w, "", on.lanes, on.precision)->parts, nullptr);
  const double bound = on.precision == Precision::double_ ? 1e-12 : 1e-5;
  for (const Projection projection : {Projection::none, Projection::clamp, Projection::absolute}) {
    const Evaluated x = evaluate(a, on, projection), y = evaluate(w, on, projection);
    EXPECT_NEAR(x.all.value / y.all.value, 1, bound);
    EXPECT_LE((x.gradient - y.gradient).norm(), bound * y.gradient.norm());
    EXPECT_LE((x.hessian - y.hessian).norm(), bound * y.hessian.norm());
    EXPECT_EQ(x.all.indefinite > 0, projection != Projection::none);
    EXPECT_EQ(x.all.indefinite > 0, y.all.indefinite > 0);
    if (kernel->density == 0) {
      EXPECT_LT(x.stored, y.stored) << "couplings that are zero have no place";
    }
  }
}

class Parts : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (GetParam() > lanes::best_lanes()) GTEST_SKIP() << "this machine lacks such vectors";
  }
};

TEST_P(Parts, StencilsAreThoseOfTheWholeLaw) {
  for (const Law& law : {kSprings, kPull}) {
    for (const Precision precision : {Precision::double_, Precision::single}) {
      SCOPED_TRACE(law.header);
      const StencilSample sample = sample_stencils("edge_edge", 3);
      compare(law, {sample.mesh, sample.stencils, GetParam(), precision});
    }
  }
}

TEST_P(Parts, DensitiesOnEveryKindOfElementAreThoseOfTheWholeLaw) {
  for (const Element element : {Element::tri3, Element::quad4, Element::tri6})
    compare(kThreads, {sample_mesh(element, 3), {}, GetParam()});
  for (const Element element : {Element::tet4, Element::tet10, Element::hex27})
    compare(kColumns, {sample_mesh(element, 2), {}, GetParam()});
  compare(kColumns, {sample_mesh(Element::tet4, 2), {}, GetParam(), Precision::single});
}

INSTANTIATE_TEST_SUITE_P(Lanes, Parts, ::testing::ValuesIn(lanes::kWidths));

EntryCost cost_of(const Energy& energy, const std::string& entry) {
  for (const EntryCost& cost : generate(energy, {}).costs)
    if (cost.entry == entry) return cost;
  return {};
}

// Value and gradient are 1 + 6 numbers, the Hessian 21 whole, 12 in two parts, 6 in one.
TEST(PartsCost, WhatVanishesIsNeitherComputedNorStored) {
  EXPECT_EQ(cost_of(whole(kSprings), "hessian").bytes_out, 8 * (7 + 21));
  EXPECT_EQ(cost_of(apart(kSprings), "hessian").bytes_out, 8 * (7 + 12));
  EXPECT_EQ(cost_of(apart(kPull), "hessian").bytes_out, 8 * (7 + 6));
  // Two springs take twice the operations of one, but for the sum of their values and the parameter they share.
  const int one = cost_of(find_energy("spring"), "hessian").operations;
  EXPECT_LE(cost_of(apart(kSprings), "hessian").operations, 2 * one + 4);
}

}  // namespace
}  // namespace ergon
