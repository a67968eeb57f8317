// Loads on parts of objects, and vertices that are held along some axes.

#include <gtest/gtest.h>

#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

// An eighth of a block by symmetry, pulled along x. Long steps of implicit Euler come to rest.
std::string pulled(const std::string& load) {
  return R"(
gravity = [0, 0, 0]
[time]
dt = 10
steps = 8
[solver]
tolerance = 1e-9
[[object]]
name = "block"
element = "hex20"
box = { size = [0.2, 0.1, 0.1], cells = [2, 1, 1] }
density = 1000
velocity = [1e-3, 2e-3, 3e-3]
energy = [{ law = "linear_elasticity", E = 1e6, nu = 0.25 }]
[[object.fixed]]
max = [0, inf, inf]
axes = "x"
[[object.fixed]]
max = [inf, 0, inf]
axes = "y"
[[object.fixed]]
max = [inf, inf, 0]
axes = "z"
[[object.load]]
min = [0.2, -inf, -inf]
)" + load;
}

TEST(loads, traction_and_planes_of_symmetry_stretch_a_block_evenly) {
  for (const char* load : {"traction = [\"1 kPa\", 0, 0]\n", "force = [10, 0, 0]\n"}) {
    const FinishedScene block = finish_text(pulled(load));
    ASSERT_EQ(block.summary.failure, "");
    const Eigen::Matrix3Xd& X = block.built.start.x;
    Eigen::Matrix3Xd exact = X;
    exact.row(0) *= 1 + 1e-3;
    exact.bottomRows<2>() *= 1 - 0.25e-3;
    EXPECT_LT((block.end.x - exact).cwiseAbs().maxCoeff(), 1e-9) << load;
  }
}

TEST(loads, vertices_start_without_velocity_along_axes_that_hold_them) {
  const BuiltScene built = build_text(pulled("force = [1, 0, 0]\n"));
  for (int v = 0; v < built.system->vertices(); ++v)
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(built.start.v(axis, v), built.start.x(axis, v) < 1e-9 ? 0 : 1e-3 * (axis + 1));
  EXPECT_EQ(built.system->free_vertices(), built.system->vertices() - 1);  // three planes meet in one vertex
}

TEST(loads, forces_without_faces_go_to_edges_and_vertices) {
  const auto shares = [](const std::string& box) {
    const BuiltScene built = build_text(pulled("force = [1, 0, 0]\n[[object.load]]\nforce = [0, 0, 4]\n" + box));
    return built.bodies[0].loads[1];
  };
  EXPECT_EQ(shares("min = [0.2, -inf, 0.1]\n").dimension, 1);
  EXPECT_EQ(shares("min = [0.2, 0.1, 0.1]\n").dimension, 0);
  EXPECT_EQ(shares("min = [-inf, -inf, 0.1]\n").dimension, 2);
}

// A body without degrees of freedom of its own vertices takes loads at its control points.
TEST(loads, push_an_affine_body) {
  const FinishedScene body = finish_text(R"(
gravity = [0, 0, 0]
[time]
dt = 0.01
steps = 10
[[object]]
name = "block"
kinematics = "affine"
box = { size = [0.1, 0.1, 0.1], cells = [1, 1, 1] }
density = 1000
[[object.load]]
force = [2, 0, 0]
)");
  ASSERT_EQ(body.summary.failure, "");
  EXPECT_NEAR(body.end.v(0, 0), 2.0 * 0.1, 1e-6);  // 1 kg for 0.1 s
}

}  // namespace
}  // namespace ergon
