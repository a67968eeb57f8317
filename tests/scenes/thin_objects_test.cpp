// Shells, rods, loose points and copies, from their text to what is built of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "scenes/run.h"
#include "scenes/surface_check.h"
#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

const std::string head = "gravity = [0, 0, 0]\n[time]\ndt = 0.01\nsteps = 2\n";

std::string object(const std::string& keys, const std::string& energy) {
  return "[[object]]\nname = \"thing\"\ndensity = 1000\n" + keys + "\nenergy = [{ " + energy + " }]\n";
}

// Of the first object's first law.
double energy_of(const BuiltScene& built, const Eigen::Matrix3Xd& x) {
  for (int i = 0; i < built.system->potential_count(); ++i) {
    Potential& potential = built.system->potential(i);
    if (potential.name() != "inertia") continue;
    potential.set_lag("dt", {1});
    potential.set_lag("xhat", {0, 0, 0});
  }
  return built.system->value(x).by_potential[0];
}

const std::string cloth =
    "box = { size = [0.3, 0.2, 1], cells = [3, 2, 1] }\nelement = \"tri3\"\nthickness = \"2 mm\"\n";
const std::string hinge = "law = \"discrete_shell_hinge\", k = 1";

TEST(thin_objects, hinges_lie_between_the_triangles_of_a_cloth) {
  const BuiltScene built = build_text(head + object(cloth, hinge));
  EXPECT_EQ(built.system->potential(0).stencil_count(), 6 + 3 * 1 + 2 * 2);  // diagonals, inner edges along x and y
  EXPECT_NEAR(built.mass.sum(), 1000 * 0.06 * 0.002, 1e-15);
  EXPECT_EQ(energy_of(built, built.start.x), 0);
}

TEST(thin_objects, a_law_whose_h_is_left_out_takes_the_thickness_of_the_object) {
  const auto stretched = [](const std::string& more) {
    const BuiltScene built =
        build_text(head + object(cloth, "law = \"st_venant_kirchhoff_membrane\", E = 1e5, nu = 0.3" + more));
    return energy_of(built, 1.1 * built.start.x);
  };
  EXPECT_EQ(stretched(""), stretched(", h = \"2 mm\""));
  EXPECT_NEAR(stretched(", h = \"1 mm\""), stretched("") / 2, 1e-12 * stretched(""));
}

TEST(thin_objects, a_surface_may_be_kept_as_a_shell) {
  for (const std::string element : {"tri3", "tri6"}) {
    const BuiltScene built = build_text(
        head + object("sphere = { radius = 0.1, cuts = 16 }\nthickness = \"1 mm\"\nelement = \"" + element + "\"",
                      "law = \"st_venant_kirchhoff_membrane\", E = 1e5, nu = 0.3"));
    EXPECT_EQ(built.bodies[0].mesh.cell_count(), 20 * 16 * 16);
    EXPECT_NEAR(built.mass.sum(), 1000 * 0.001 * 4 * M_PI * 0.01, 0.01 * 0.13);
  }
}

TEST(thin_objects, rods_bend_at_their_corners_by_the_lengths_of_their_edges) {
  const std::string rod =
      object("curve.points = [[0, 0, 0], [0.2, 0, 0], [0.2, 0.3, 0], [0.2, 0.4, 0]]\ncross_section = \"1 cm^2\"",
             "law = \"rod_bending\", EI = 3");
  const BuiltScene built = build_text(head + rod);
  EXPECT_EQ(built.system->potential(0).stencil_count(), 2);
  // 4 EI/(L0 + L1) tan(angle/2)^2
  EXPECT_NEAR(energy_of(built, built.start.x), 4 * 3 / 0.5, 1e-12);
  EXPECT_NEAR(built.mass.sum(), 1000 * 0.6 * 1e-4, 1e-15);
  std::string circle;
  for (int i = 0; i < 12; ++i) circle += fmt::format("[{}, {}, 0],", std::cos(M_PI * i / 6), std::sin(M_PI * i / 6));
  const BuiltScene ring =
      build_text(head + object("curve = { points = [" + circle + "], closed = true, cells = 100 }\n" +
                                   "cross_section = \"1 cm^2\"",
                               "law = \"rod_bending\", EI = 3"));
  EXPECT_EQ(ring.system->potential(0).stencil_count(), 100);
  // EI/2 times curvature^2, over a length of 2 pi, of what is nearly a circle
  EXPECT_NEAR(energy_of(ring, ring.start.x), 3 * M_PI, 0.5);
}

TEST(thin_objects, loose_points_have_the_mass_of_their_volume) {
  const BuiltScene built = build_text(
      head + object("points = [[0, 0, 0], [1, 0, 0], [0, 2, 0]]\nvolume = \"2 cm^3\"", "law = \"drag\", rate = 1"));
  for (const double mass : built.mass) EXPECT_NEAR(mass, 0.002, 1e-15);
  EXPECT_EQ(built.system->potential(0).stencil_count(), 3);
}

TEST(thin_objects, copies_are_objects_of_their_own) {
  const BuiltScene built =
      build_text(head + "[contact]\n[[contact.pair]]\nfirst = \"thing_1\"\nsecond = \"thing_3\"\nignore = true\n" +
                 object(cloth + "copies = { count = 3, translate = [0, 0.1, 0.5] }\n", hinge));
  ASSERT_EQ(built.bodies.size(), 3u);
  EXPECT_EQ(built.bodies[2].name, "thing_3");
  const Eigen::Vector3d moved = built.bodies[2].mesh.X.col(4) - built.bodies[0].mesh.X.col(4);
  EXPECT_LT((moved - Eigen::Vector3d(0, 0.2, 1)).norm(), 1e-15);
  EXPECT_FALSE(built.surfaces->surface().meet[0][2]);
  EXPECT_TRUE(built.surfaces->surface().meet[0][1]);
}

TEST(thin_objects, obstacles_may_be_sheets_lines_and_points) {
  const BuiltScene built = build_text(
      head + "[contact]\n" + object(cloth, hinge) +
      "[[obstacle]]\nname = \"sheet\"\nbox = { size = [1, 1, 1], cells = [2, 2, 1] }\nelement = \"tri3\"\n"
      "translate = [0, 0, -1]\n[[obstacle]]\nname = \"wire\"\ncurve.points = [[0, 0, -2], [1, 0, -2], [1, 1, -2]]\n"
      "[[obstacle]]\nname = \"needles\"\npoints = [[0, 0, -3], [1, 0, -3]]\n");
  const CollisionSurface& surface = built.surfaces->surface();
  EXPECT_EQ(surface.triangles.size(), 12u + 8u);
  EXPECT_EQ(surface.points.size(), 12u + 9u + 3u + 2u);
  EXPECT_EQ(built.bodies[3].ordered.element, Element::point);
}

// Loose points fall on loose points, on a wire and on a sheet, exactly above them; friction keeps them there.
TEST(thin_objects, points_fall_on_points_wires_and_sheets) {
  const FinishedScene run = finish_text(
      "[time]\ndt = 0.01\nsteps = 40\n[contact]\ndhat = \"5 mm\"\nmu = 1\n" +
      object("points = [[0, 0, 0.05], [1, 0, 0.05], [2, 0, 0.05]]\nvolume = \"1 cm^3\"", "law = \"drag\", rate = 1") +
      "[[obstacle]]\nname = \"needle\"\npoints = [[0, 0, 0]]\n"
      "[[obstacle]]\nname = \"wire\"\ncurve.points = [[0.9, -0.1, 0], [1.1, 0.1, 0]]\n"
      "[[obstacle]]\nname = \"sheet\"\nbox = { size = [0.2, 0.2, 1], cells = [1, 1, 1] }\nelement = \"tri3\"\n"
      "translate = [1.87, -0.09, 0]\n");
  ASSERT_EQ(run.summary.failure, "");
  for (int v = 0; v < 3; ++v) {
    EXPECT_GT(run.end.x(2, v), 0) << v;
    EXPECT_LT(run.end.x(2, v), 0.006) << v;
  }
}

// A rod of edges of 2 cm and a thickness of 10 cm is laid down on a floor of its own thickness, and so is a cloth.
TEST(thin_objects, objects_may_be_thicker_than_their_edges_are_long) {
  const std::string floor =
      "[[obstacle]]\nname = \"floor\"\nbox = { size = [4, 4, 1], cells = [1, 1, 1] }\nelement = \"tri3\"\n"
      "translate = [-1, -1, -0.1]\n";
  const std::string start = "[time]\ndt = 0.01\nsteps = 30\n[contact]\n";
  const FinishedScene rod =
      finish_text(start +
                  object("curve = { points = [[0, 0, 0], [1, 0, 0]], cells = 50 }\noffset = \"5 cm\"\n"
                         "cross_section = \"78 cm^2\"",
                         "law = \"rod_stretching\", EA = 1e4 }, { law = \"rod_bending\", EI = 1") +
                  floor);
  ASSERT_EQ(rod.summary.failure, "");
  EXPECT_GT(rod.end.x.row(2).head(51).minCoeff(), -0.05);
  EXPECT_LT(rod.end.x.row(2).head(51).maxCoeff(), -0.049);
  const FinishedScene sheet = finish_text(
      start +
      object("box = { size = [0.3, 0.3, 1], cells = [10, 10, 1] }\nelement = \"tri3\"\nthickness = \"8 cm\"\n"
             "offset = \"4 cm\"\n",
             "law = \"st_venant_kirchhoff_membrane\", E = 1e5, nu = 0.3 }, { " + hinge) +
      floor);
  ASSERT_EQ(sheet.summary.failure, "");
  EXPECT_GT(sheet.end.x.row(2).head(121).minCoeff(), -0.06);
  EXPECT_LT(sheet.end.x.row(2).head(121).maxCoeff(), -0.058);
}

}  // namespace
}  // namespace ergon
