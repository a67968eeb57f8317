// The scenes of cloth and rods that come with the program, or their first steps, each tested exactly after every step.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

void expect_sound(const FinishedScene& scene) {
  EXPECT_EQ(scene.summary.failure, "");
  EXPECT_EQ(scene.summary.unconverged_steps, 0);
  EXPECT_GT(scene.summary.smallest_gap, 0);
  // A step of bdf2 may give back a little of what those before it have dissipated.
  const double rise = scene.built.step.creates_no_energy ? 0.01 : 1e-6;
  EXPECT_LE(scene.summary.max_energy_rise, rise * std::abs(scene.summary.start_energy));
  EXPECT_LE(scene.summary.end_energy, scene.summary.start_energy + 1e-6 * std::abs(scene.summary.start_energy));
}

double lowest(const FinishedScene& scene, size_t body) {
  const Body& b = scene.built.bodies[body];
  return scene.end.x.row(2).segment(b.first_vertex, b.ordered.vertices()).minCoeff();
}
double highest(const FinishedScene& scene, size_t body) {
  const Body& b = scene.built.bodies[body];
  return scene.end.x.row(2).segment(b.first_vertex, b.ordered.vertices()).maxCoeff();
}

TEST(SlowClothScenes, a_cloth_hangs_from_two_corners) {
  const FinishedScene cloth = finish("hanging_cloth.toml");
  expect_sound(cloth);
  EXPECT_EQ(highest(cloth, 0), 0);  // of the corners
  EXPECT_LT(lowest(cloth, 0), -0.4);
  EXPECT_LT(cloth.summary.newton_iterations, 12 * cloth.built.steps);
}

TEST(SlowClothScenes, a_cloth_lies_on_a_box_and_hangs_down_around_it) {
  const FinishedScene cloth = finish("cloth_on_box.toml");
  expect_sound(cloth);
  EXPECT_GT(highest(cloth, 0), 0.08);
  EXPECT_LT(highest(cloth, 0), 0.1);
  EXPECT_LT(lowest(cloth, 0), 0);
  EXPECT_LT(cloth.summary.newton_iterations, 40 * cloth.built.steps);
}

TEST(SlowClothScenes, a_cloth_of_60_cells_wraps_around_a_sphere) {
  const FinishedScene cloth = finish("cloth_on_sphere.toml", 20);
  expect_sound(cloth);
  for (int v = 0; v < 61 * 61; ++v) EXPECT_GT(cloth.end.x.col(v).norm(), 0.148);  // a faceted sphere of 0.15 m
  EXPECT_NEAR(highest(cloth, 0), 0.151, 1e-3);
  EXPECT_LT(lowest(cloth, 0), 0.1);
}

TEST(SlowClothScenes, a_cloth_of_60_cells_hangs_over_the_edge_of_a_sheet) {
  const FinishedScene cloth = finish("cloth_on_knife.toml", 20);
  expect_sound(cloth);
  EXPECT_GT(highest(cloth, 0), 0);
  EXPECT_LT(highest(cloth, 0), 5e-3);
  EXPECT_LT(lowest(cloth, 0), -0.1);
}

TEST(SlowClothScenes, twenty_layers_of_cloth_fall_into_a_tray) {
  const FinishedScene layers = finish("cloth_layers.toml", 7);
  expect_sound(layers);
  ASSERT_EQ(layers.built.bodies.size(), 21u);
  EXPECT_LT(layers.summary.smallest_gap, 1e-3);
  for (size_t i = 0; i < 20; ++i) EXPECT_GT(lowest(layers, i), 0) << i;
  for (size_t i = 1; i < 20; ++i) EXPECT_GT(mean(layers, layers.end.x, i, 2), mean(layers, layers.end.x, i - 1, 2));
}

TEST(SlowClothScenes, a_sheet_hangs_between_needles_that_are_points) {
  const FinishedScene sheet = finish("cloth_on_needles.toml", 40);
  expect_sound(sheet);
  EXPECT_LT(lowest(sheet, 0), -0.003);               // between them
  EXPECT_GT(highest(sheet, 0), 0);                   // on them
  EXPECT_GT(mean(sheet, sheet.end.x, 0, 2), -0.05);  // it was not pierced
}

// The invariant of degree two of a long knot, which runs from one end far out to the other, by the formula of Polyak
// and Viro: pairs of crossings, as seen along z, that are passed in turn, first over one and under the other. Zero for
// a line that can be drawn straight, 1 for an overhand knot.
int invariant_of_knot(const std::vector<Eigen::Vector3d>& line) {
  struct Crossing {
    double first, second;  // where it is passed
    bool first_is_over;
    int sign;
  };
  std::vector<Crossing> crossings;
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    for (size_t j = i + 2; j + 1 < line.size(); ++j) {
      const Eigen::Vector3d a = line[i + 1] - line[i], b = line[j + 1] - line[j], c = line[j] - line[i];
      const double across = a.x() * b.y() - a.y() * b.x();
      const double s = (c.x() * b.y() - c.y() * b.x()) / across, t = (c.x() * a.y() - c.y() * a.x()) / across;
      if (!(s > 0 && s < 1 && t > 0 && t < 1)) continue;
      const bool over = s * a.z() > c.z() + t * b.z();
      crossings.push_back({double(i) + s, double(j) + t, over, (across > 0) == over ? 1 : -1});
    }
  }
  int sum = 0;
  for (const Crossing& a : crossings) {
    for (const Crossing& b : crossings) {
      if (!(a.first < b.first && b.first < a.second && a.second < b.second)) continue;
      if (a.first_is_over && !b.first_is_over) sum += a.sign * b.sign;
    }
  }
  return sum;
}

std::vector<Eigen::Vector3d> line_of(const FinishedScene& scene, const Eigen::Matrix3Xd& x) {
  const Body& body = scene.built.bodies[0];
  std::vector<Eigen::Vector3d> line(static_cast<size_t>(body.ordered.vertices()));
  for (size_t i = 0; i < line.size(); ++i)
    line[static_cast<size_t>(body.vertex_from[i])] = x.col(static_cast<Eigen::Index>(i));
  return line;
}

TEST(SlowClothScenes, a_knot_in_a_rod_is_pulled_tight_and_stays_one) {
  const FinishedScene rope = finish("knot.toml");
  EXPECT_EQ(rope.summary.failure, "");
  EXPECT_GT(rope.summary.smallest_gap, 0);
  const std::vector<Eigen::Vector3d> start = line_of(rope, rope.built.start.x), end = line_of(rope, rope.end.x);
  EXPECT_EQ(invariant_of_knot(start), 1);
  EXPECT_EQ(invariant_of_knot(end), 1);
  std::vector<Eigen::Vector3d> straight;
  for (size_t i = 0; i < start.size(); ++i)
    straight.emplace_back(0.01 * double(i), std::sin(0.2 * double(i)), std::cos(0.3 * double(i)));
  EXPECT_EQ(invariant_of_knot(straight), 0);
  EXPECT_GT((end.back() - end.front()).norm(), 0.78);  // of 0.91
  // Where parts far along the rod are nearest they are its thickness of 8 mm apart, and not much more.
  double nearest = 1;
  for (size_t i = 0; i < end.size(); ++i)
    for (size_t j = i + 8; j < end.size(); ++j) nearest = std::min(nearest, (end[i] - end[j]).norm());
  EXPECT_GT(nearest, 0.008);
  EXPECT_LT(nearest, 0.0105);
}

}  // namespace
}  // namespace ergon
