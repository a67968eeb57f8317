#include "symbolic/compose.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "symbolic/print.h"
#include "symbolic/reference.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

const std::string squared_law = "barrier squared\nparam k J/m^2\nvalue k*gap2\n";
const std::string law = "barrier linear\nparam k N\nparam dhat m\nactive gap < dhat\nvalue k*(dhat - gap)\n";
const std::string both = "barrier both\nparam k J/m^2\nparam c N\nlet g = gap2\nvalue k*g + c*gap\n";
const std::string two_points = "distance two_points point_point\ndof p q m\nlet gap2 = norm2(p - q)\n";
const std::string plane = "distance plane point\nframe fixed\ndof x m\nlet gap = x[2]\n";

Energy composed(const std::string& barrier, const std::string& distance, Offset offset = Offset::none) {
  return compose(parse_energy(barrier, "law.energy"), parse_energy(distance, "distance.energy"), offset);
}

TEST(Compose, TheSquareOfADistanceIsTakenAsItIs) {
  const Energy energy = composed(squared_law, two_points);
  EXPECT_EQ(energy.name, "squared:two_points");
  EXPECT_EQ(energy.file, "law.energy:two_points");
  EXPECT_EQ(energy.kind, Energy::Kind::stencil);
  EXPECT_EQ(energy.geometry, "point_point");
  EXPECT_EQ(formula_text(energy), "let gap2 = norm2(p - q)\nrequire 0 < gap2\nvalue k*gap2\n");
}

TEST(Compose, WhatTheLawUsesFollowsFromWhatTheDistanceGives) {
  EXPECT_EQ(
      formula_text(composed(law, two_points)),
      "let gap2 = norm2(p - q)\nlet gap = sqrt(gap2)\nactive gap < dhat\nrequire 0 < gap2\nvalue k*(dhat - gap)\n");
  EXPECT_EQ(formula_text(composed(law, plane)),
            "let gap = x[2]\nactive gap < dhat\nrequire 0 < gap\nvalue k*(dhat - gap)\n");
  EXPECT_EQ(formula_text(composed(both, plane)),
            "let gap = x[2]\nlet gap2 = gap^2\nlet g = gap2\nrequire 0 < gap\nvalue k*g + c*gap\n");
  EXPECT_TRUE(composed(law, plane).fixed_frame);
  EXPECT_FALSE(composed(law, two_points).fixed_frame);
}

TEST(Compose, AnOffsetIsTakenOffTheDistance) {
  const Energy energy = composed(squared_law, two_points, Offset::per_stencil);
  EXPECT_EQ(energy.name, "squared:two_points:offset");
  EXPECT_EQ(formula_text(energy),
            "let distance2 = norm2(p - q)\nlet distance = sqrt(distance2)\nlet gap = distance - offset\n"
            "let gap2 = gap^2\nrequire 0 < gap\nvalue k*gap2\n");
  ASSERT_NE(energy.find("offset"), nullptr);
  EXPECT_EQ(energy.find("offset")->role, Role::rest);
  EXPECT_EQ(formula_text(composed(law, plane, Offset::per_stencil)),
            "let distance = x[2]\nlet gap = distance - offset\nactive gap < dhat\nrequire 0 < gap\n"
            "value k*(dhat - gap)\n");
}

TEST(Compose, OfTwoFormsTheOneIsTakenThatTheLawUses) {
  const std::string plain = "distance plane point\nframe fixed\ndof x m\nlet gap2 = x[2]^2\nlet gap = abs(x[2])\n";
  EXPECT_EQ(formula_text(composed(squared_law, plain)), "let gap2 = x[2]^2\nrequire 0 < gap2\nvalue k*gap2\n");
  EXPECT_EQ(formula_text(composed(law, plain)),
            "let gap = abs(x[2])\nactive gap < dhat\nrequire 0 < gap\nvalue k*(dhat - gap)\n");
  EXPECT_EQ(formula_text(composed(squared_law, plain, Offset::per_stencil)),
            "let distance = abs(x[2])\nlet gap = distance - offset\nlet gap2 = gap^2\nrequire 0 < gap\n"
            "value k*gap2\n");
}

TEST(Compose, CasesAndWeightAreThoseOfTheDistance) {
  const Energy energy =
      composed(squared_law,
               "distance d point_edge\ndof p a b m\ncase one gap2 = norm2(p - a)\ncase two gap2 = norm2(p - b)\n"
               "let weight = gap2/norm2(b - a)\nrequire norm2(b - a) > gap2\n",
               Offset::per_stencil);
  EXPECT_EQ(energy.cases, (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(formula_text(energy),
            "case one distance2 = norm2(p - a)\ncase two distance2 = norm2(p - b)\n"
            "let weight = distance2/norm2(b - a)\nlet distance = sqrt(distance2)\nlet gap = distance - offset\n"
            "let gap2 = gap^2\nrequire 0 < gap\nrequire distance2 < norm2(b - a)\nvalue weight*(k*gap2)\n");
}

TEST(Compose, ANameThatBothDeclareIsToldWithBothPlaces) {
  try {
    composed("barrier b\nparam p N/m\nvalue p*gap2\n", two_points);
    FAIL();
  } catch (const SourceError& error) {
    EXPECT_STREQ(error.what(), "law.energy:2:7: 'p' is declared twice; the first time at distance.energy:2:5");
  }
}

TEST(Compose, Names) {
  auto read = [](const std::string& name) {
    const ComposedName n = split_name(name);
    return n.law + "|" + n.distance + (n.offset == Offset::none ? "" : "|offset");
  };
  EXPECT_EQ(read("spring"), "spring|");
  EXPECT_EQ(read("b:point_edge"), "b|point_edge");
  EXPECT_EQ(read("b:point_edge:offset"), "b|point_edge|offset");
  EXPECT_EQ(read("a:b/c.energy:point_edge"), "a:b/c.energy|point_edge");
  for (const char* wrong : {"b:", ":d", "b:d:", "b:d:thick", "b:d:offset:offset"})
    EXPECT_THROW(split_name(wrong), std::invalid_argument) << wrong;
}

// The offset energy at distance d is the energy without offset at d less the offset.
TEST(Compose, OffsetsShiftTheBarrier) {
  for (const char* name : {"log_barrier", "squared_log_barrier", "cubic_barrier"}) {
    const Inputs at = {{"p", {0, 0, 0.75}}, {"q", {0, 0, 0}}, {"dhat", {0.5}}, {"kappa", {3}}};
    Inputs shifted = at;
    shifted["p"] = {0, 0, 1};
    shifted["offset"] = {0.75};
    Inputs near = at;
    near["p"] = {0, 0, 0.25};
    const ReferenceValue thin = evaluate_reference(test::shipped(name + std::string(":point_point")), "", near, 50);
    const ReferenceValue thick =
        evaluate_reference(test::shipped(name + std::string(":point_point:offset")), "", shifted, 50);
    EXPECT_NEAR(thick.value, thin.value, 1e-15 * thin.value) << name;
    EXPECT_NEAR(thick.gradient[2], thin.gradient[2], 1e-15 * std::abs(thin.gradient[2])) << name;
    EXPECT_LT(thin.gradient[2], 0) << name;
  }
}

// Ando 2024, Eq. 1: -2/3 kappa/dhat (gap - dhat)^3, so that the curvature at contact is 4 kappa.
TEST(Compose, CubicBarrierHasItsStiffnessAtContact) {
  const Inputs at = {{"x", {0, 0, 1e-9}}, {"n", {0, 0, 1}}, {"height", {0}}, {"dhat", {0.5}}, {"kappa", {3}}};
  const ReferenceValue v = evaluate_reference(test::shipped("cubic_barrier:half_space"), "", at, 50);
  EXPECT_NEAR(v.value, 2.0 / 3 * 3 * 0.25, 1e-8);
  EXPECT_NEAR(v.hessian.back(), 4 * 3, 1e-7);
}

}  // namespace
}  // namespace ergon
