// The scenes that come with the program do what their descriptions say.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "tests/paths.h"
#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

TEST(shipped_scenes, all_are_read_and_built) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source("/scenes"))) {
    if (entry.path().extension() != ".toml") continue;
    ++scenes;
    EXPECT_NO_THROW(build_scene(read_scene(entry.path().string()), shipped_energies(), real_kernels)) << entry.path();
  }
  EXPECT_GE(scenes, 2);
}

TEST(SlowScenes, a_block_slides_down_a_slope_as_coulomb_says) {
  const FinishedScene slope = finish("slope.toml");
  ASSERT_EQ(slope.summary.failure, "");
  // g (sin - mu cos)/2 t^2 = 0.274 m, and implicit Euler's factor of 1 + dt/t; a little more for how it starts.
  EXPECT_NEAR(mean(slope, slope.end.x, 0, 0) - mean(slope, slope.built.start.x, 0, 0), 0.2753, 0.01);
}

// The tangent of the angle is 0.5: there static friction holds the block where it is at rest at the start, but for what
// it creeps below epsv.
TEST(Scenes, a_block_stays_on_a_slope_up_to_the_angle_of_friction) {
  Scene scene = shipped_scene("slope_stays.toml");
  scene.time.integrator = "implicit_euler";
  const FinishedScene stays = finish(scene);
  ASSERT_EQ(stays.summary.failure, "");
  EXPECT_LT(
      std::abs(stays.end.x(0, stays.built.probes[0].vertex) - stays.built.start.x(0, stays.built.probes[0].vertex)),
      1e-5 * 2.5);
  scene.contact->mu = 0.49;
  const FinishedScene slides = finish(scene);
  ASSERT_EQ(slides.summary.failure, "");
  EXPECT_NEAR(mean(slides, slides.end.x, 0, 0) - mean(slides, slides.built.start.x, 0, 0), 0.2753, 0.0005);
}

TEST(SlowScenes, a_ball_at_1000_metres_per_second_does_not_pass_a_plate) {
  const FinishedScene impact = finish("fast_impact.toml");
  ASSERT_EQ(impact.summary.failure, "");
  EXPECT_GT(impact.end.x.row(2).head(impact.built.bodies[0].ordered.vertices()).minCoeff(), 0);
  EXPECT_LT(impact.summary.largest_speed, 1000);
  EXPECT_LE(impact.summary.max_energy_rise, 0.01 * impact.summary.start_energy);
  EXPECT_LT(impact.summary.end_energy, impact.summary.start_energy);
}

TEST(SlowScenes, a_stack_of_light_and_heavy_cubes_stands) {
  const FinishedScene stack = finish("cube_stack.toml");
  ASSERT_EQ(stack.summary.failure, "");
  EXPECT_LT(stack.summary.largest_speed, 1e-2);
  for (size_t i = 0; i < 5; ++i) {
    const double sunk = mean(stack, stack.built.start.x, i, 2) - mean(stack, stack.end.x, i, 2);
    EXPECT_GT(sunk, -0.01) << i;
    EXPECT_LT(sunk, 0.05) << i;
  }
}

TEST(SlowScenes, a_ball_goes_through_a_tube_that_is_narrower) {
  const FinishedScene tube = finish("ball_through_tube.toml");
  ASSERT_EQ(tube.summary.failure, "");
  EXPECT_GT(mean(tube, tube.end.x, 0, 0), 0.2);  // beyond the tube's end
}

// 12 mm of the piston in a step, a third of the ball's radius.
TEST(SlowScenes, a_ball_is_pushed_into_the_tube_by_long_steps) {
  const FinishedScene tube = finish("ball_through_tube.toml", 12, 0.04);
  ASSERT_EQ(tube.summary.failure, "");
  EXPECT_GT(mean(tube, tube.end.x, 0, 0), 0.03);
}

TEST(SlowScenes, a_cup_that_is_pressed_together_squeezes_a_ball) {
  const auto ball = [](const FinishedScene& cup) {
    return Eigen::Matrix3Xd(cup.end.x.leftCols(cup.built.bodies[0].ordered.vertices()));
  };
  const auto width = [&](const FinishedScene& cup) { return ball(cup).topRows<2>().colwise().norm().maxCoeff(); };
  const auto height = [&](const FinishedScene& cup) {
    return ball(cup).row(2).maxCoeff() - ball(cup).row(2).minCoeff();
  };
  const FinishedScene pressed = finish("squeezed_ball.toml", 60);
  ASSERT_EQ(pressed.summary.failure, "");
  const FinishedScene open = finish("squeezed_ball.toml");
  ASSERT_EQ(open.summary.failure, "");
  EXPECT_LT(width(pressed), 0.047);      // the wall is at 0.0386 to 0.042 m where it touches the ball
  EXPECT_NEAR(width(open), 0.05, 5e-3);  // it sags
  EXPECT_GT(height(pressed), height(open));
  // The cup is as it was.
  const Body& cup = open.built.bodies[1];
  const auto at_end = open.end.x.middleCols(cup.first_vertex, cup.ordered.vertices());
  EXPECT_LT((at_end - cup.ordered.X).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SlowScenes, a_mat_is_twisted_by_its_ends) {
  const FinishedScene mat = finish("twisted_mat.toml");
  ASSERT_EQ(mat.summary.failure, "");
  EXPECT_LT(mat.summary.smallest_gap, 1e-3);  // it touches itself
}

// How often an open line winds around itself, seen from all sides: Gauss's double integral, which of two straight edges
// is the area of a quadrangle on the sphere.
double writhe(const std::vector<Eigen::Vector3d>& x) {
  double sum = 0;
  for (size_t i = 0; i + 1 < x.size(); ++i)
    for (size_t j = i + 2; j + 1 < x.size(); ++j) {
      const Eigen::Vector3d a = x[j] - x[i], b = x[j + 1] - x[i], c = x[j + 1] - x[i + 1], d = x[j] - x[i + 1];
      const Eigen::Vector3d n[4] = {a.cross(b).normalized(), b.cross(c).normalized(), c.cross(d).normalized(),
                                    d.cross(a).normalized()};
      double area = 0;
      for (int k = 0; k < 4; ++k) area += std::asin(std::clamp(n[k].dot(n[(k + 1) % 4]), -1.0, 1.0));
      sum += std::copysign(area, (x[j + 1] - x[j]).cross(x[i + 1] - x[i]).dot(a)) / (2 * M_PI);
    }
  return sum;
}

// A loop alone winds once. The twist that the cord has lost since it was turned is its writhe: what links the two edges
// of a ribbon is the sum of both (Calugareanu, White, Fuller).
TEST(SlowScenes, a_cord_that_is_twisted_coils_around_itself) {
  const FinishedScene cord = finish("twisted_rod.toml");
  ASSERT_EQ(cord.summary.failure, "");
  const Body& body = cord.built.bodies[0];
  std::vector<Eigen::Vector3d> line(static_cast<size_t>(body.ordered.vertices()) + 2);
  for (int v = 0; v < body.ordered.vertices(); ++v)
    line[static_cast<size_t>(body.vertex_from[static_cast<size_t>(v)]) + 1] = cord.end.x.col(body.first_vertex + v);
  line.front() = line[1] - Eigen::Vector3d::UnitX() * 1000;  // the ends go on straight
  line.back() = line[line.size() - 2] + Eigen::Vector3d::UnitX() * 1000;
  double drift = 0;
  for (const StencilData& remembered : cord.end.internal)
    if (remembered.contains("drift"))
      for (const double angle : remembered.at("drift")) drift += angle;
  EXPECT_GT(writhe(line), 2);
  EXPECT_NEAR(-drift / (2 * M_PI), writhe(line), 0.01);
}

TEST(SlowScenes, two_bunnies_fall_on_each_other) {
  const FinishedScene bunnies = finish("two_bunnies.toml", 25);
  ASSERT_EQ(bunnies.summary.failure, "");
  EXPECT_LT(bunnies.summary.smallest_gap, 1e-3);
  EXPECT_LE(bunnies.summary.max_energy_rise, 1e-6 * bunnies.summary.start_energy);
}

TEST(SlowScenes, the_bunny_comes_to_rest_on_the_floor) {
  const FinishedScene bunny = finish("bunny_drop.toml");
  const Eigen::Matrix3Xd &start = bunny.built.start.x, &end = bunny.end.x;
  // 194.288 is the volume of the mesh in its own unit.
  EXPECT_NEAR(bunny.built.mass.sum(), 1000 * 194.288 * std::pow(0.0207, 3), 1e-5);
  EXPECT_NEAR(start.row(2).maxCoeff() - start.row(2).minCoeff(), 0.2, 1e-3);

  EXPECT_EQ(bunny.summary.failure, "");
  EXPECT_EQ(bunny.summary.unconverged_steps, 0);
  EXPECT_GT(bunny.summary.smallest_gap, 0);  // over all vertices and steps
  EXPECT_LT(bunny.summary.largest_speed, 1e-3);
  // The energy never rises by itself: implicit Euler takes energy out, and so does friction.
  EXPECT_LE(bunny.summary.max_energy_rise, 1e-9 * bunny.summary.start_energy);

  EXPECT_GT(end.row(2).minCoeff(), 0);
  EXPECT_LT(end.row(2).minCoeff(), 1e-3);
  // It stands as it fell, a little flatter, and carries its weight.
  EXPECT_GT(end.row(2).maxCoeff(), 0.15);
  double force = 0;
  for (const GroundContact::Force& f : bunny.built.ground->forces(end)) force += f.newton;
  EXPECT_NEAR(force, 9.81 * bunny.built.mass.sum(), 0.01 * 9.81 * bunny.built.mass.sum());
}

// How far the vertex that moves most does.
double most_moved(const FinishedScene& scene) {
  return std::sqrt((scene.end.x - scene.built.start.x).colwise().squaredNorm().maxCoeff());
}

TEST(SlowScenes, a_tower_of_affine_boxes_stands) {
  const FinishedScene tower = finish("affine_tower.toml");
  ASSERT_EQ(tower.summary.failure, "");
  EXPECT_EQ(tower.built.system->free_vertices(), 40);
  EXPECT_LT(tower.summary.largest_speed, 1e-6);
  EXPECT_LT(most_moved(tower), 0.01);  // ten joints close a little
}

TEST(SlowScenes, a_chain_of_affine_rings_hangs_together) {
  const FinishedScene chain = finish("affine_chain.toml");
  ASSERT_EQ(chain.summary.failure, "");
  EXPECT_LE(chain.summary.end_energy, chain.summary.start_energy);
  // Neighbours stay linked: their centres no further apart than taut ones.
  for (size_t link = 1; link <= 10; ++link) {
    Eigen::Vector3d apart;
    for (int axis = 0; axis < 3; ++axis)
      apart[axis] = mean(chain, chain.end.x, link, axis) - mean(chain, chain.end.x, link - 1, axis);
    EXPECT_LT(apart.norm(), 0.049) << link;
  }
  EXPECT_LT(chain.end.x.row(2).minCoeff(), -0.2);  // it fell
}

TEST(SlowScenes, affine_boxes_lie_on_a_cloth) {
  const FinishedScene cloth = finish("boxes_on_cloth.toml", 60);
  ASSERT_EQ(cloth.summary.failure, "");
  EXPECT_LT(cloth.summary.smallest_gap, 1e-3);
  for (size_t box = 1; box <= 5; ++box) {
    EXPECT_LT(mean(cloth, cloth.end.x, box, 2), mean(cloth, cloth.built.start.x, box, 2)) << box;
    EXPECT_GT(mean(cloth, cloth.end.x, box, 2), -0.5) << box;
  }
}

// With another coefficient of friction everywhere.
FinishedScene finish_with_friction(const std::string& name, double mu) {
  Scene scene = read_scene(test::source("/scenes/") + name);
  scene.contact->mu = mu;
  for (SceneGround& ground : scene.grounds) ground.mu = mu;
  FinishedScene out{build_scene(scene, shipped_energies(), real_kernels), {}, {}};
  RunOptions options;
  options.last_state = &out.end;
  options.verify = true;
  out.summary = run_scene(scene, out.built, options);
  return out;
}

TEST(SlowScenes, an_arch_of_stones_stands_by_friction_alone) {
  const FinishedScene arch = finish("masonry_arch.toml");
  ASSERT_EQ(arch.summary.failure, "");
  EXPECT_LT(most_moved(arch), 5e-3);
  EXPECT_LT(arch.summary.largest_speed, 1e-4);
  const FinishedScene smooth = finish_with_friction("masonry_arch.toml", 0);
  ASSERT_EQ(smooth.summary.failure, "");
  EXPECT_LT(mean(smooth, smooth.end.x, 4, 2), mean(smooth, smooth.built.start.x, 4, 2) - 0.5);  // the keystone
}

TEST(SlowScenes, a_house_of_cards_stands_by_friction_alone) {
  const FinishedScene house = finish("card_house.toml");
  ASSERT_EQ(house.summary.failure, "");
  EXPECT_LT(most_moved(house), 1e-3);
  EXPECT_LT(house.summary.largest_speed, 1e-4);
  const FinishedScene smooth = finish_with_friction("card_house.toml", 0);
  ASSERT_EQ(smooth.summary.failure, "");
  EXPECT_LT(mean(smooth, smooth.end.x, 4, 2), 0.03);  // the floor of the upper storey lay 84 mm high
}

// Vertical deflection of the tip of a thin inextensible beam of length L under its weight q (N/m), bending stiffness EI
// (N m^2): EI theta'' = -q (L - s) cos(theta), theta(0) = 0, theta'(L) = 0, by shooting and midpoint steps. theta is
// the angle below the horizontal.
double elastica_deflection(double q, double L, double EI) {
  const int n = 4000;
  const double h = L / n;
  auto shoot = [&](double curvature, double& deflection) {
    double theta = 0;
    deflection = 0;
    for (int i = 0; i < n; ++i) {
      const double s = (i + 0.5) * h;
      const double slope = -q * (L - i * h) * std::cos(theta) / EI;
      const double middle = theta + 0.5 * h * curvature;
      theta += h * (curvature + 0.5 * h * slope);
      curvature -= h * q * (L - s) * std::cos(middle) / EI;
      deflection += h * std::sin(middle);
    }
    return curvature;
  };
  double low = 0, high = q * L * L / EI, deflection = 0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (shoot(middle, deflection) > 0 ? high : low) = middle;
  }
  return deflection;
}

TEST(SlowScenes, the_cantilever_bends_as_the_elastica_does) {
  const double side = 0.05;
  // A light load bends as q L^4 / (8 EI), which holds the elastica itself to a closed form.
  EXPECT_NEAR(elastica_deflection(1e-3, 1, 1), 1e-3 / 8, 1e-9);

  const FinishedScene beam = finish("cantilever.toml");
  EXPECT_EQ(beam.summary.failure, "");
  EXPECT_LE(beam.summary.max_energy_rise, 1e-9 * beam.summary.start_energy);
  double tip = 0;
  int count = 0;
  for (int v = 0; v < beam.end.x.cols(); ++v) {
    if (beam.built.start.x(0, v) < 0.4 - 1e-9) continue;
    tip += beam.built.start.x(2, v) - beam.end.x(2, v);
    ++count;
  }
  const double thin = elastica_deflection(1100 * 9.81 * side * side, 0.4, 1e6 * std::pow(side, 4) / 12);
  // Shear and stretch, which the elastica leaves out, are of the order (side/length)^2 = 1.6 percent.
  EXPECT_NEAR(tip / count, thin, 0.03 * thin);
}

}  // namespace
}  // namespace ergon
