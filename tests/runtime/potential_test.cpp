#include "runtime/potential.h"

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/system.h"
#include "tests/runtime/jet_kernels.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

using namespace testing;  // NOLINT

const Parameters kStiff{{"mu", {3.0}}, {"lambda", {7.0}}};

std::string solid_message(const Parameters& params, const Mesh& mesh = box_tets({1, 1, 1}, {1, 1, 1})) {
  return message_of([&] { Potential::on_mesh("block", kernel_of<NeoHookeanLaw>(1), mesh, 0, params); });
}

const Eigen::Matrix3Xd kThree = Eigen::Matrix3Xd::Identity(3, 3);

std::string spring_message(const std::vector<int>& stencils, const std::map<std::string, std::vector<double>>& rest) {
  return message_of([&] {
    Potential::on_stencils("ropes", kernel_of<SpringLaw>(1), stencils, kThree, {{"k", {1.0}}}, rest);
  });
}

TEST(Potential, SaysWhatItHolds) {
  const Mesh mesh = to_quadratic(box_tets({1, 1, 1}, {1, 1, 1}), Element::tet10);
  const Potential solid = Potential::on_mesh("block", kernel_of<NeoHookeanLaw>(1), mesh, 5, kStiff);
  EXPECT_EQ(solid.name(), "block");
  EXPECT_STREQ(solid.kernel().energy, "neo");
  EXPECT_EQ(solid.stencil_count(), 6);
  EXPECT_EQ(solid.points_per_stencil(), 10);
  EXPECT_EQ(solid.quadrature_points(), 4);
  EXPECT_EQ(solid.stencils().front(), mesh.cells.front() + 5);
  Potential springs =
      Potential::on_stencils("ropes", kernel_of<SpringLaw>(1), {0, 1, 2, 0}, kThree, {{"k", {1.0}}}, {});
  EXPECT_EQ(springs.stencil_count(), 2);
  EXPECT_EQ(springs.quadrature_points(), 1);
  springs.set_stencils({1, 2}, kThree, {});
  EXPECT_EQ(springs.stencils(), (std::vector<int>{1, 2}));
}

TEST(Potential, RefusesParamsThatAreMissingUnknownOrOfTheWrongSize) {
  EXPECT_EQ(solid_message({{"mu", {3.0}}}), "potential 'block': param 'lambda' of neo is missing; give 1 value");
  EXPECT_EQ(solid_message({{"mu", {3.0}}, {"lambda", {7.0}}, {"lamda", {7.0}}}),
            "potential 'block': 'lamda' is not a param of neo; did you mean 'lambda'?");
  EXPECT_EQ(solid_message({{"mu", {3.0}}, {"lambda", {7.0}}, {"density", {7.0}}}),
            "potential 'block': 'density' is not a param of neo; neo has mu, lambda");
  EXPECT_EQ(solid_message({{"mu", {3.0, 4.0}}, {"lambda", {7.0}}}),
            "potential 'block': param 'mu' of neo takes 1 value, got 2");
  EXPECT_EQ(solid_message({{"mu", {std::nan("")}}, {"lambda", {7.0}}}),
            "potential 'block': param 'mu' of neo is nan, not a finite number");
  Potential solid = Potential::on_mesh("block", kernel_of<NeoHookeanLaw>(1), box_tets({1, 1, 1}, {1, 1, 1}), 0, kStiff);
  EXPECT_EQ(message_of([&] { solid.set_param("Mu", {1.0}); }),
            "potential 'block': 'Mu' is not a param of neo; did you mean 'mu'?");
  EXPECT_EQ(message_of([&] { solid.set_lag("kappa", {1.0}); }),
            "potential 'block': 'kappa' is not a lag of neo; neo has none");
}

TEST(Potential, RefusesElementsTheDensityCannotLiveOn) {
  Mesh sheet;
  sheet.X = kThree;
  sheet.element = Element::tri3;
  sheet.cells = {0, 1, 2};
  EXPECT_EQ(solid_message(kStiff, sheet),
            "potential 'block': neo is a density of a solid; Tri3 cells have dimension 2");
  EXPECT_EQ(message_of([&] {
              Potential::on_stencils("block", kernel_of<NeoHookeanLaw>(1), {0, 1, 2}, kThree, kStiff, {});
            }),
            "potential 'block': neo is a density: it needs a mesh, not stencils");
  EXPECT_EQ(message_of([&] {
              Potential::on_mesh("ropes", kernel_of<SpringLaw>(1), sheet, 0, {{"k", {1.0}}});
            }),
            "potential 'ropes': spring is a stencil energy, not a density");
}

TEST(Potential, RefusesCellsThatAreInvertedFlatOrOutOfRange) {
  Mesh mesh;
  mesh.source = "two.msh";
  mesh.X.resize(3, 5);
  mesh.X << 0, 1, 0, 0, 1,  //
      0, 0, 1, 0, 1,        //
      0, 0, 0, 1, 0;
  mesh.cells = {0, 1, 2, 3, 0, 2, 1, 3};
  EXPECT_EQ(
      solid_message(kStiff, mesh),
      "two.msh: cell 1 (Tet4, vertices 0 2 1 3) is inverted: volume -0.166667 m^3; 1 of 2 cells inverted or flat; "
      "reverse the order of its vertices or repair the mesh");
  mesh.cells = {0, 1, 2, 4, 0, 1, 2, 3};
  EXPECT_EQ(
      solid_message(kStiff, mesh),
      "two.msh: cell 0 (Tet4, vertices 0 1 2 4) is flat: volume 0 m^3; 1 of 2 cells inverted or flat; remove it or "
      "repair the mesh");
  mesh.cells = {0, 1, 2, 3, 0, 1, 2, 5};
  EXPECT_EQ(solid_message(kStiff, mesh), "potential 'block': cell 1 names vertex 5; vertices are 0 to 4");
}

TEST(Potential, RefusesStencilsThatAreNotWholeOutOfRangeOrDegenerate) {
  EXPECT_EQ(spring_message({0, 1, 2}, {}), "potential 'ropes': 3 vertices do not make whole stencils of 2 points");
  EXPECT_EQ(spring_message({0, 1, 2, 3}, {}), "potential 'ropes': stencil 1 names vertex 3; vertices are 0 to 2");
  EXPECT_EQ(spring_message({0, 1, -1, 2}, {}), "potential 'ropes': stencil 1 names vertex -1; vertices are 0 to 2");
  EXPECT_EQ(spring_message({0, 1, 2, 2}, {}), "potential 'ropes': stencil 1 names vertex 2 twice");
}

TEST(Potential, RefusesRestAndLagDataThatDoNotFit) {
  EXPECT_EQ(spring_message({0, 1}, {{"X2", {0, 0, 0}}}),
            "potential 'ropes': 'X2' is not a rest of spring; did you mean 'X0'?");
  EXPECT_EQ(spring_message({0, 1}, {{"X0", {0, 0}}}),
            "potential 'ropes': rest 'X0' of spring takes 3 values for 1 stencils, got 2");
  EXPECT_EQ(message_of([] {
              Potential::on_stencils("fold", kernel_of<HingeLaw>(1), {0, 1, 2, 3}, Eigen::Matrix3Xd::Zero(3, 4),
                                     {{"k", {1.0}}}, {});
            }),
            "potential 'fold': rest 'area' of hinge is missing; give 1 value per stencil");
  Potential inertia =
      Potential::on_stencils("inertia", kernel_of<InertiaLaw>(1), {0, 1, 2}, kThree, {}, {{"mass", {1, 1, 1}}});
  EXPECT_EQ(message_of([&] {
              inertia.set_lag("xhat", {1, 2, 3, 4});
            }),
            "potential 'inertia': lag 'xhat' of inertia takes 3 values for all stencils or 9 values for 3, got 4");
  EXPECT_EQ(message_of([&] {
              inertia.set_lag("xht", {1, 2, 3});
            }),
            "potential 'inertia': 'xht' is not a lag of inertia; did you mean 'xhat'?");
}

TEST(Potential, RefusesKernelsItCannotEvaluate) {
  ErgonKernel old = *kernel_of<NeoHookeanLaw>(1).table;
  old.abi = 0;
  const Mesh mesh = box_tets({1, 1, 1}, {1, 1, 1});
  EXPECT_EQ(message_of([&] {
              Potential::on_mesh("block", {nullptr, &old}, mesh, 0, kStiff);
            }),
            "potential 'block': the kernel of neo has ABI 0, expected 7; compile it again");
  ErgonKernel large = *kernel_of<SpringLaw>(1).table;
  large.q_vectors = 6;
  EXPECT_EQ(message_of([&] {
              Potential::on_stencils("ropes", {nullptr, &large}, {0, 1}, kThree, {{"k", {1.0}}}, {});
            }),
            "potential 'ropes': spring has 2 points and 6 vectors in q; at most 27 and 5 can be evaluated");
}

TEST(Potential, EvaluationNeedsEveryLag) {
  System system(3);
  system.add(Potential::on_stencils("inertia", kernel_of<InertiaLaw>(1), {0, 1, 2}, kThree, {}, {{"mass", {1, 1, 1}}}));
  const auto message = [&]() -> std::string {
    try {
      system.value(kThree);
    } catch (const std::logic_error& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_EQ(message(), "potential 'inertia': lag 'dt' of inertia was never set");
  system.potential(0).set_lag("dt", {0.1});
  EXPECT_EQ(message(), "potential 'inertia': lag 'xhat' of inertia was never set");
  system.potential(0).set_lag("xhat", {0, 0, 0});
  EXPECT_EQ(message(), "no error");
  system.potential(0).set_stencils({0, 2}, kThree, {{"mass", {1, 1}}});
  EXPECT_EQ(message(), "potential 'inertia': lag 'dt' of inertia was never set");
  system.potential(0).set_stencils({}, kThree, {{"mass", {}}});
  EXPECT_EQ(message(), "no error");
}

TEST(Potential, IsOneOfTheSystemsVertices) {
  System system(2);
  EXPECT_EQ(message_of([&] {
              system.add(Potential::on_stencils("ropes", kernel_of<SpringLaw>(1), {0, 2}, kThree, {{"k", {1.0}}}, {}));
            }),
            "potential 'ropes' names vertex 2; the system has vertices 0 to 1");
}

TEST(Lanes, OfWidthsThatDoNotExistAreRefused) {
  EXPECT_EQ(lanes::lane_operations(1).lanes, 1);
  EXPECT_EQ(lanes::lane_operations(2).lanes, 2) << "every machine that this is built for has them";
  EXPECT_EQ(lanes::lane_operations(lanes::best_lanes()).lanes, lanes::best_lanes());
  EXPECT_THROW(lanes::lane_operations(3), std::invalid_argument);
}

}  // namespace
}  // namespace ergon
