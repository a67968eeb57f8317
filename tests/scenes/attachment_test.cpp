// Attachments of scenes: closed forms of what hangs by them, what joints conserve, what they may join.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scenes/finish_scene.h"

namespace ergon {
namespace {

constexpr double g = 9.81;  // m/s^2

std::string block(const std::string& name, const std::string& more) {
  return "\n[[object]]\nname = \"" + name +
         "\"\ndensity = 1000\nenergy = [{ law = \"stable_neo_hookean\", E = 1e6, nu = 0.3 }]\n" +
         "box = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }\n" + more;
}

std::string quasi_static(int steps = 1) {
  return "[time]\nintegrator = \"quasi_static\"\ndt = 0.01\nsteps = " + std::to_string(steps) + "\n";
}

Eigen::Vector3d mean_of(const Eigen::Matrix3Xd& x, const std::vector<int>& vertices) {
  Eigen::Vector3d out = Eigen::Vector3d::Zero();
  for (const int v : vertices) out += x.col(v) / static_cast<double>(vertices.size());
  return out;
}

// Vertices of body 0 that start at this height.
std::vector<int> at_height(const BuiltScene& built, double z) {
  std::vector<int> out;
  for (int v = 0; v < built.bodies[0].ordered.vertices(); ++v)
    if (std::fabs(built.start.x(2, v) - z) < 1e-9) out.push_back(v);
  return out;
}

// n attachments of stiffness k carry the weight m g: their mean stretch is m g/(n k).
TEST(Attachments, CarryTheWeightOfWhatHangsByThem) {
  for (const char* element : {"tet4", "tet10", "hex20"}) {
    SCOPED_TRACE(element);
    const FinishedScene hanging =
        finish_text(quasi_static() + block("block", "element = \"" + std::string(element) + "\"\n") +
                    "[[attachment]]\nobject = \"block\"\nmin = [-inf, -inf, 0.099]\nk = \"100 N/m\"\n");
    ASSERT_EQ(hanging.summary.failure, "");
    const std::vector<int> top = at_height(hanging.built, 0.1);
    ASSERT_GE(top.size(), 9u);
    const Eigen::Vector3d moved = mean_of(hanging.end.x, top) - mean_of(hanging.built.start.x, top);
    EXPECT_NEAR(moved[2], -g / (100 * static_cast<double>(top.size())), 1e-7);
  }
}

// The stiffness varies over the object: what each attachment carries adds up to the weight all the same. A stiffness in
// time that doubles halves the stretch.
TEST(Attachments, TakeParamsThatVary) {
  const auto hanging = [](const std::string& stiffness) {
    return finish_text(quasi_static() + block("block", "element = \"tet4\"\n") +
                       "[[attachment]]\nobject = \"block\"\nmin = [-inf, -inf, 0.099]\n" + stiffness);
  };
  const FinishedScene over_x =
      hanging("k = { formula = \"k0*(1 + X[0]/L)\", k0 = \"100 N/m\", L = \"5 cm\" }\nweight = 2\n");
  ASSERT_EQ(over_x.summary.failure, "");
  double carried = 0;
  for (const int v : at_height(over_x.built, 0.1))
    carried += 2 * 100 * (1 + over_x.built.start.x(0, v) / 0.05) * (over_x.built.start.x(2, v) - over_x.end.x(2, v));
  EXPECT_NEAR(carried, g, 1e-5 * g);
  const FinishedScene in_time = hanging("k = { formula = \"k0*(1 + t/s)\", k0 = \"100 N/m\", s = \"10 ms\" }\n");
  const std::vector<int> top = at_height(in_time.built, 0.1);
  EXPECT_NEAR((mean_of(in_time.end.x, top) - mean_of(in_time.built.start.x, top))[2], -g / (200 * 9), 1e-7);
}

TEST(Attachments, KeepAToleranceHoweverSoftTheyAre) {
  const FinishedScene kept = finish_text("[time]\ndt = 0.01\nsteps = 10\n" + block("block", "element = \"tet4\"\n") +
                                         "[[attachment]]\nobject = \"block\"\nmin = [-inf, -inf, 0.099]\nk = 1\n"
                                         "constraint_tolerance = \"0.1 mm\"\n");
  ASSERT_EQ(kept.summary.failure, "");
  for (const int v : at_height(kept.built, 0.1))
    EXPECT_LE((kept.end.x.col(v) - kept.built.start.x.col(v)).norm(), 1e-4);
}

// A block of 1 kg on 27 attachments of k/27 with the damping ratio tau*w/2, w^2 = k/m: v0/wd exp(-tau w^2 t/2) sin(wd
// t).
TEST(Attachments, AreDampedByTheirStiffness) {
  const double k = 900, tau = 0.01, w = std::sqrt(k), ratio = tau * w / 2, wd = w * std::sqrt(1 - ratio * ratio);
  for (const int steps : {50, 150, 250}) {
    const FinishedScene swung = finish_text(
        "gravity = [0, 0, 0]\n[time]\nintegrator = \"bdf2\"\ndt = 0.001\nsteps = " + std::to_string(steps) + "\n" +
        block("block", "element = \"tet4\"\nvelocity = [0, 0, 0.1]\n") +
        "[[attachment]]\nobject = \"block\"\nk = " + std::to_string(k / 27) + "\nstiffness_damping = \"10 ms\"\n");
    ASSERT_EQ(swung.summary.failure, "");
    double moved = 0;  // of the centre of mass
    for (int v = 0; v < 27; ++v) moved += swung.built.mass[v] * (swung.end.x(2, v) - swung.built.start.x(2, v));
    const double t = 0.001 * steps;
    EXPECT_NEAR(moved, 0.1 / wd * std::exp(-ratio * w * t) * std::sin(wd * t), 0.02 * 0.1 / wd) << steps;
  }
}

// Each pair: a soft block and what is above it, joined in one way, 3 cm apart or less at the start.
struct Joined {
  const char* name;
  std::string text;
};
std::vector<Joined> joined_pairs() {
  const std::string soft = block("block", "element = \"tet10\"\nvelocity = [1, 0, 0.5]\n");
  const std::string lid =
      "\n[[object]]\nname = \"lid\"\nkinematics = \"affine\"\ndensity = 500\nbox = { size = [0.1, 0.1, 0.05], cells = "
      "[2, 2, "
      "1] }\ntranslate = [0.01, 0.005, 0.1]\n";
  const std::string above =
      "\n[[object]]\nname = \"lid\"\nkinematics = \"affine\"\ndensity = 500\nbox = { size = [0.1, 0.1, 0.05], cells = "
      "[2, 2, "
      "1] }\ntranslate = [0.01, 0.005, 0.11]\n";
  const std::string sheet =
      "\n[[object]]\nname = \"lid\"\nelement = \"tri3\"\ndensity = 500\nthickness = \"1 mm\"\nbox = { size = [0.2, "
      "0.2, 1], "
      "cells = [3, 3, 1] }\ntranslate = [-0.05, -0.05, 0.1]\nenergy = [{ law = \"st_venant_kirchhoff_membrane\", E = "
      "1e5, "
      "nu = 0.3 }]\n";
  const std::string rope =
      "\n[[object]]\nname = \"lid\"\ncurve = { points = [[0, 0, 0.1], [0, 0, 0.2], [0, 0.1, 0.2]] }\ndensity = 1000\n"
      "cross_section = 1e-4\nenergy = [{ law = \"rod_stretching\", EA = 100 }]\n";
  const std::string joint = "[[attachment]]\nobject = \"block\"\nmin = [-inf, -inf, 0.099]\nto = \"lid\"\nk = 1e3\n";
  const std::string seam = "[[attachment]]\nobject = \"lid\"\nto = \"block\"\nk = 1e3\n";
  return {{"affine_surface", soft + lid + joint + "at = \"surface\"\nwithin = 0.03\n"},
          {"affine_vertices", soft + lid + joint + "within = 0.03\n"},
          {"surface_of_tet10", soft + lid + seam + "max = [inf, inf, 0.101]\nat = \"surface\"\nwithin = 0.03\n"},
          {"across_a_gap", soft + above + joint + "at = \"surface\"\nwithin = 0.02\nlaw = \"held_above_triangle\"\n"},
          {"places_of_an_affine_body", soft + above + joint + "at = \"place\"\n"},
          {"ball_joint",
           "\n[[object]]\nname = \"block\"\nkinematics = \"affine\"\ndensity = 1000\nvelocity = [1, 0, 0.5]\n"
           "box = { size = [0.1, 0.1, 0.1], cells = [1, 1, 1] }\n" +
               above +
               "[[attachment]]\nobject = \"block\"\nplaces = [[0.05, 0.05, 0.105]]\nto = \"lid\"\nat = \"place\"\nk = "
               "1e3\n"},
          {"sheet", soft + sheet + joint + "at = \"surface\"\nwithin = \"1 mm\"\n"},
          {"rope", soft + rope + seam + "max = [0, 0, 0.1]\nwithin = \"1 mm\"\n"},
          {"spring", soft + lid + joint + "within = 0.03\nlaw = \"spring\"\n"}};
}

// Joints act and react: linear and angular momentum stay, which `midpoint` keeps; energy is accounted for.
TEST(Attachments, OfTwoBodiesConserveMomentumAndEnergy) {
  for (const Joined& pair : joined_pairs()) {
    SCOPED_TRACE(pair.name);
    const Scene scene = read_scene_text(
        "gravity = [0, 0, 0]\n[time]\nintegrator = \"midpoint\"\ndt = 0.005\nsteps = 20\n[solver]\ntolerance = 1e-6\n" +
            pair.text,
        "a.toml");
    BuiltScene built = build_scene(scene, shipped_energies(), real_kernels);
    TimeStepper stepper = stepper_of(built);
    State state = built.start;
    StepRecord first, last;
    for (int i = 0; i < 20; ++i) {
      last = stepper.step(state);
      ASSERT_TRUE(last.converged) << last.reason;
      if (i == 0) first = last;
      EXPECT_LT(std::fabs(last.budget.residual), 1e-5 * last.energy.total);
    }
    const double total = built.mass.sum();
    EXPECT_NEAR(last.momentum.linear[0], 1, 1e-9);
    EXPECT_NEAR(last.momentum.linear[2], 0.5, 1e-9);
    EXPECT_LT((last.momentum.angular - first.momentum.angular).norm(), 1e-6 * last.momentum.angular.norm());
    // The block gave of its own.
    const std::vector<int> lid = {built.bodies[1].first_vertex};
    EXPECT_GT(mean_of(state.x, lid)[0] - mean_of(built.start.x, lid)[0], 0.01 / total);
  }
}

TEST(Attachments, LetJoinedBodiesFallTogether) {
  const FinishedScene fall = finish_text(
      "[time]\nintegrator = \"midpoint\"\ndt = 0.01\nsteps = 10\n" + block("block", "element = \"tet4\"\n") +
      block("lid", "element = \"tet4\"\ntranslate = [0.03, 0.02, 0.1]\n") +
      "[[attachment]]\nobject = \"block\"\nmin = [0.04, 0.04, 0.099]\nto = \"lid\"\nat = \"surface\"\n"
      "within = \"1 um\"\nk = 1e3\n");
  ASSERT_EQ(fall.summary.failure, "");
  for (int v = 0; v < fall.end.x.cols(); ++v)
    EXPECT_LT((fall.end.x.col(v) - fall.built.start.x.col(v) - Eigen::Vector3d(0, 0, -g * 0.01 / 2)).norm(), 1e-6);
}

// A spring has the length that it has at the start, and so no force; what joins points draws them together.
TEST(Attachments, KnowTheDistanceAtTheStart) {
  const auto first_energy = [](const std::string& law) {
    const Scene scene = read_scene_text(
        "gravity = [0, 0, 0]\n[time]\ndt = 0.01\nsteps = 1\n" + block("block", "element = \"tet4\"\n") +
            block("lid", "element = \"tet4\"\ntranslate = [0, 0, 0.12]\n") +
            "[[attachment]]\nobject = \"block\"\nmin = [-inf, -inf, 0.099]\nto = \"lid\"\nwithin = 0.03\n" + law,
        "a.toml");
    BuiltScene built = build_scene(scene, shipped_energies(), real_kernels);
    const Energies energies = stepper_of(built).energies(built.start);
    EXPECT_EQ(energies.kinetic, 0);
    return energies.total;
  };
  EXPECT_EQ(first_energy("law = \"spring\"\nk = 100\n"), 0);
  EXPECT_NEAR(first_energy("k = 100\n"), 9 * 100.0 / 2 * 0.02 * 0.02, 1e-12);
  // Of a law of one's own: the length and both rest positions.
  EXPECT_NEAR(first_energy("text = '''\nenergy  own  edge\ndof   p q   m\nrest  L       m  (0, inf)   length\n"
                           "rest  P[3] Q[3]  m     start\nparam k    N/m (0, inf)   stiffness\n"
                           "value k/2*(norm(p - q) - (L + norm(P - Q))/4)^2\n'''\nk = 100\n"),
              9 * 100.0 / 2 * 0.01 * 0.01, 1e-12);
}

// An obstacle needs no contact to hold something, and moves it by its script, whose work is in the budget.
TEST(Attachments, FollowAnObstacleThatMoves) {
  const Scene scene = read_scene_text(quasi_static(4) + block("block", "element = \"tet4\"\n") +
                                          "[[obstacle]]\nname = \"bar\"\nbox = { size = [0.2, 0.2, 0.02], cells = [1, "
                                          "1, 1] }\ntranslate = [-0.05, -0.05, "
                                          "0.1]\nkey = [{ time = 0.04, translate = [0.1, 0, 0.2] }]\n"
                                          "[[attachment]]\nobject = \"block\"\nmin = [-inf, -inf, 0.099]\nto = "
                                          "\"bar\"\nat = \"surface\"\nwithin = \"1 mm\"\n"
                                          "k = 100\n",
                                      "a.toml");
  BuiltScene built = build_scene(scene, shipped_energies(), real_kernels);
  TimeStepper stepper = stepper_of(built);
  State state = built.start;
  double script = 0, change = 0;
  for (int i = 0; i < 4; ++i) {
    const StepRecord record = stepper.step(state);
    ASSERT_TRUE(record.converged) << record.reason;
    script += record.budget.script;
    change += record.budget.change;
  }
  const std::vector<int> top = at_height(built, 0.1);
  const Eigen::Vector3d moved = mean_of(state.x, top) - mean_of(built.start.x, top);
  EXPECT_NEAR(moved[0], 0.1, 1e-6);
  EXPECT_NEAR(moved[2], 0.2 - g / (100 * 9), 1e-6);
  EXPECT_GT(script, 0);
  EXPECT_GT(change, 0);
}

// A board of affine kinematics that hangs by a hinge, gravity being tilted a little: a physical pendulum of the period
// 2 pi sqrt(I/(m g d)), so that after a quarter of it it hangs in the direction of gravity. The hinge is two vertices
// of the board's upper edge, or two places above it.
TEST(Attachments, AreHingesOfAffineBodies) {
  const double a = 0.1, h = 0.3, angle = 0.01;
  const auto check = [&](double pivot, const std::string& joined) {
    SCOPED_TRACE(joined);
    const double d = pivot - h / 2, period = 2 * M_PI * std::sqrt(((a * a + h * h) / 12 + d * d) / (g * d));
    const auto swung = [&](int steps) {
      const FinishedScene board = finish_text(
          "gravity = [" + std::to_string(g * angle) + ", 0, " + std::to_string(-g) +
          "]\n[time]\nintegrator = \"bdf2\"\ndt = " + std::to_string(period / 200) +
          "\nsteps = " + std::to_string(steps) +
          "\n[[object]]\nname = \"board\"\nkinematics = \"affine\"\ndensity = 1000\n"
          "box = { size = [0.1, 0.1, 0.3], cells = [2, 1, 3] }\n[[attachment]]\nobject = \"board\"\nk = 1e6\n" +
          joined);
      EXPECT_EQ(board.summary.failure, "");
      const int control = board.built.bodies[0].first_control;
      return (board.end.x.middleCols<4>(control) - board.built.start.x.middleCols<4>(control)).row(0).mean();
    };
    const double hanging = angle * d;
    EXPECT_NEAR(swung(50), hanging, 0.02 * hanging);
    EXPECT_NEAR(swung(100), 2 * hanging, 0.02 * hanging);
    EXPECT_NEAR(swung(150), hanging, 0.04 * hanging);
  };
  check(0.3, "min = [0.04, -inf, 0.299]\nmax = [0.06, inf, inf]\n");
  check(0.4, "places = [[0.05, 0, 0.4], [0.05, 0.1, 0.4]]\n");
}

// What is joined at places of an obstacle turns with it, across a gap.
TEST(Attachments, AtPlacesTurnWithAnObstacle) {
  const FinishedScene turned = finish_text(
      quasi_static(4) + block("block", "element = \"tet4\"\n") +
      "[[obstacle]]\nname = \"bar\"\ncurve = { points = [[0, 0, 0.2], [0.1, 0, 0.2]] }\ncenter = [0.05, 0.05, 0.2]\n"
      "key = [{ time = 0.04, rotate = [0, 0, \"90 deg\"] }]\n"
      "[[attachment]]\nobject = \"block\"\nmin = [-inf, -inf, 0.099]\nto = \"bar\"\nat = \"place\"\nk = 1e6\n");
  ASSERT_EQ(turned.summary.failure, "");
  for (const int v : at_height(turned.built, 0.1)) {
    const Eigen::Vector3d X = turned.built.start.x.col(v);
    EXPECT_LT((turned.end.x.col(v) - Eigen::Vector3d(0.1 - X[1], X[0], 0.1)).norm(), 1e-4);
  }
}

TEST(Attachments, LinkTheBoxesOfAChain) {
  const FinishedScene chain = finish("box_chain.toml", 60);
  ASSERT_EQ(chain.summary.failure, "");
  EXPECT_LT(mean(chain, chain.end.x, 9, 2), -0.3);
  EXPECT_LT(chain.end.x.col(chain.built.bodies[0].first_place).norm(), 1e-2);
  for (size_t i = 0; i + 1 < 10; ++i) {
    const int own = chain.built.bodies[i].first_place + 1, next = chain.built.bodies[i + 1].first_place;
    EXPECT_EQ(chain.built.start.x.col(own), chain.built.start.x.col(next));
    EXPECT_LT((chain.end.x.col(own) - chain.end.x.col(next)).norm(), 2e-3) << i;
  }
}

// A ring of one object: its ends are joined to one another.
TEST(Attachments, JoinPartsOfOneObject) {
  const FinishedScene ring = finish_text(
      "gravity = [0, 0, 0]\n[time]\ndt = 0.01\nsteps = 5\n"
      "\n[[object]]\nname = \"rope\"\ncurve = { points = [[0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0.01, "
      "0.1, 0], [0.01, "
      "0.01, 0]] }\ndensity = 1000\ncross_section = 1e-4\nfixed = [{ min = [0.05, -inf, -inf] }]\n"
      "energy = [{ law = \"rod_stretching\", EA = 100 }, { law = \"rod_bending\", EI = 1e-2 }]\n"
      "[[attachment]]\nobject = \"rope\"\nmax = [0, 0, inf]\nto = \"rope\"\nto_min = [0.005, 0.005, "
      "-inf]\nto_max = [0.02, "
      "0.02, inf]\nwithin = \"2 cm\"\nk = 1\nconstraint_tolerance = \"0.1 mm\"\n");
  ASSERT_EQ(ring.summary.failure, "");
  const auto end = [&](int number) {
    const std::vector<int>& from = ring.built.bodies[0].vertex_from;
    return Eigen::Vector3d(ring.end.x.col(std::find(from.begin(), from.end(), number) - from.begin()));
  };
  EXPECT_LE((end(0) - end(4)).norm(), 1e-4);
}

// Without inertia something must hold one of those that are joined.
TEST(Attachments, HoldOnlyWhatSomethingHolds) {
  const auto message = [](const std::string& more) -> std::string {
    const Scene scene = read_scene_text(quasi_static() + block("block", "element = \"tet4\"\n" + more) +
                                            block("lid", "element = \"tet4\"\ntranslate = [0, 0, 0.1]\n") +
                                            "[[attachment]]\nobject = \"lid\"\nmax = [inf, inf, 0.1]\nto = \"block\"\n"
                                            "within = \"1 mm\"\nk = 100\n",
                                        "a.toml");
    try {
      build_scene(scene, shipped_energies(), real_kernels);
    } catch (const SourceError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message("fixed = [{ max = [inf, inf, 0.01] }]\n"), "");
  EXPECT_THAT(message(""), testing::StartsWith("a.toml:6:1: nothing holds object 'block' and what is attached to it "
                                               "along ["));
}

// Contact does not know of joints; the message says what to do.
TEST(Attachments, WhereBodiesTouchNeedAPairThatIsIgnored) {
  const auto message = [](const std::string& more) -> std::string {
    const Scene scene = read_scene_text(
        "[time]\ndt = 0.01\nsteps = 1\n[contact]\n" + more + block("block", "element = \"tet4\"\n") +
            "\n[[object]]\nname = \"tip\"\ncurve = { points = [[0.02, 0.03, 0.1], [0.02, 0.03, 0.2]] }\ndensity = "
            "1000\n"
            "cross_section = 1e-4\nenergy = [{ law = \"rod_stretching\", EA = 10 }]\n"
            "[[attachment]]\nobject = \"tip\"\nmax = [inf, inf, 0.1]\nto = \"block\"\nat = \"surface\"\n"
            "within = \"1 mm\"\nk = 100\n",
        "a.toml");
    try {
      build_scene(scene, shipped_energies(), real_kernels);
    } catch (const SourceError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message("[[contact.pair]]\nfirst = \"tip\"\nsecond = \"block\"\nignore = true\n"), "");
  EXPECT_EQ(message(""),
            "a.toml:13:1: surfaces collide at the start: edge 0-1 of 'tip' crosses triangle 21-18-22 of 'block' near "
            "[0.02, 0.03, 0.1] m; move them apart with 'translate', or look at them: ergon run SCENE "
            "--report-intersections FILE.vtu; what is joined may touch by [[contact.pair]] first = \"tip\", second = "
            "\"block\", ignore = true");
}

// A board that is held beside a block, across twice the gap at which contact acts: what is held turns with the block.
TEST(Attachments, AcrossAGapNeedNoPairThatIsIgnored) {
  const FinishedScene held = finish_text(
      "[time]\ndt = 0.01\nsteps = 20\n[contact]\n" +
      block("block", "element = \"tet4\"\nfixed = [{ max = [0.001, inf, inf] }]\n") +
      "\n[[object]]\nname = \"board\"\nkinematics = \"affine\"\ndensity = 500\n"
      "box = { size = [0.02, 0.1, 0.1], cells = [1, 2, 2] }\ntranslate = [0.102, 0.01, 0.01]\n"
      "[[attachment]]\nobject = \"block\"\nmin = [0.099, 0.01, 0.01]\nto = \"board\"\nat = \"surface\"\n"
      "within = \"5 mm\"\nlaw = \"held_above_triangle\"\nk = \"10 kN/m\"\nconstraint_tolerance = \"0.1 mm\"\n");
  ASSERT_EQ(held.summary.failure, "");
  EXPECT_EQ(held.summary.most_contacts, 0);
  EXPECT_LT(mean(held, held.end.x, 1, 2), mean(held, held.built.start.x, 1, 2));
  EXPECT_NEAR((held.end.x - held.built.start.x).cwiseAbs().maxCoeff(), 0, 0.02);
}

TEST(Attachments, HoldTheSwingTogether) {
  const FinishedScene swing = finish("swing.toml", 40);
  ASSERT_EQ(swing.summary.failure, "");
  const Body &board = swing.built.bodies[1], &rope = swing.built.bodies[2];
  // One end of the rope started at a corner of the board.
  const auto nearest = [&](const Body& body) {
    Eigen::Index v = 0;
    (body.ordered.X.colwise() - Eigen::Vector3d(-0.15, 0, 0.02)).colwise().squaredNorm().minCoeff(&v);
    return body.first_vertex + static_cast<int>(v);
  };
  EXPECT_LT((swing.end.x.col(nearest(board)) - swing.end.x.col(nearest(rope))).norm(), 1e-3);
  EXPECT_GT((swing.end.x.col(nearest(rope)) - swing.built.start.x.col(nearest(rope))).norm(), 0.01);
}

}  // namespace
}  // namespace ergon
