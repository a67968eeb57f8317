// Several energies on one object add up.
#include <gtest/gtest.h>

#include "scenes/run.h"
#include "symbolic/reference.h"
#include "tests/scenes/real_kernels.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

// A block in free space, of rubber with muscle fibres along x. Implicit Euler brings it to rest.
const std::string contracting = R"(
gravity = [0, 0, 0]
[time]
dt = 0.5
steps = 40
[solver]
tolerance = 1e-8
[[object]]
name = "block"
box = { size = [0.2, 0.1, 0.1], cells = [2, 1, 1] }
element = "tet4"
density = 1000
[[object.energy]]
law = "neo_hookean"
E = 1000
nu = 0.3
[[object.energy]]
law = "muscle"
tension = 100
activation = 0.5
a = [1, 0, 0]
)";

TEST(several_energies, a_muscle_contracts_until_the_rubber_around_it_bears_its_tension) {
  const Scene scene = read_scene_text(contracting, "muscle.toml");
  BuiltScene built = build_scene(scene, shipped_energies(), real_kernels);
  State end;
  RunOptions options;
  options.last_state = &end;
  const RunSummary summary = run_scene(scene, built, options);
  ASSERT_EQ(summary.failure, "");
  // It may turn a little on the way: lengths of edges from the first corner, to its neighbours along x, y and z.
  const auto edge = [&](const Eigen::Vector3d& corner) {
    Eigen::Index at = 0;
    (built.start.x.colwise() - corner).colwise().norm().minCoeff(&at);
    return (end.x.col(at) - end.x.col(0)).norm();
  };
  ASSERT_NEAR(built.start.x.col(0).norm(), 0, 1e-12);
  const double along = edge({0.2, 0, 0}) / 0.2, across = edge({0, 0.1, 0}) / 0.1;
  EXPECT_LT(along, 0.97);
  EXPECT_NEAR(edge({0, 0, 0.1}) / 0.1, across, 1e-6);
  const Inputs stretched = {{"F", {along, 0, 0, 0, across, 0, 0, 0, across}}, {"E", {1000}}, {"nu", {0.3}}};
  const ReferenceValue rubber = evaluate_reference(test::shipped("neo_hookean"), "", stretched);
  EXPECT_NEAR(rubber.gradient[0], -0.5 * 100, 1e-2);
  EXPECT_NEAR(rubber.gradient[4], 0, 1e-2);
}

}  // namespace
}  // namespace ergon
