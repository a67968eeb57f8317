// Laws of rods that twist, against rotations that are carried out.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "symbolic/reference.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

using Vector = Eigen::Vector3d;

std::vector<double> list(const Vector& v) { return {v[0], v[1], v[2]}; }

struct Corner {
  Vector x[3];
  double angle[2] = {0, 0};  // of the material frame
};

constexpr double kRadius = 0.25, kL = 1;

// A corner of edges of 1 m at rest, and what its law knows when the step begins.
struct Step {
  Corner rest, start;
  Vector axis = Vector::UnitZ();
  double twist0 = 0;
  Vector turn = Vector::Zero();
  double drift = 0;
  Vector moved[2] = {direction(start, 0) - direction(rest, 0), direction(start, 1) - direction(rest, 1)};

  static Vector direction(const Corner& corner, int edge) { return (corner.x[edge + 1] - corner.x[edge]).normalized(); }
  Inputs inputs(const Corner& now) const {
    Inputs in = {{"L0", {kL}},       {"L1", {kL}},         {"r", {kRadius}},     {"EI", {3}},       {"EI1", {3}},
                 {"EI2", {7}},       {"GJ", {5}},          {"k1", {0}},          {"k2", {0}},       {"tau", {0}},
                 {"d0", list(axis)}, {"twist0", {twist0}}, {"turn", list(turn)}, {"drift", {drift}}};
    for (int i = 0; i < 3; ++i) {
      const std::string number = std::to_string(i);
      in["x" + number] = list(now.x[i]);
      in["X" + number] = list(rest.x[i]);
      if (i == 2) continue;
      in["T" + number] = list(direction(rest, i));
      in["moved" + number] = list(moved[i]);
      in["u" + number] = {now.angle[i] * kRadius, 0.7, -0.3};  // the last two have no meaning
    }
    return in;
  }
  void accept(const std::string& law, const Corner& now) {
    const std::vector<double> update = evaluate_reference(test::shipped(law), "", inputs(now), 30).update;
    if (update.size() == 10) turn = Vector(update[0], update[1], update[2]);
    for (int i = 0; i < 3; ++i) {
      moved[0][i] = update[update.size() - 7 + static_cast<size_t>(i)];
      moved[1][i] = update[update.size() - 4 + static_cast<size_t>(i)];
    }
    drift = update.back();
    start = now;
  }
};

double value(const std::string& law, Inputs in) {
  const Energy& energy = test::shipped(law);
  Inputs own;
  for (const Symbol& symbol : energy.symbols) own[symbol.name] = in.at(symbol.name);
  return evaluate_reference(energy, "", own, 30).value;
}

Corner bent(const Vector& axis, double angle) {
  const Vector along = Vector::UnitX();
  const Vector after = Eigen::AngleAxisd(angle, axis) * along;
  return {{-along, Vector::Zero(), after}, {0, 0}};
}

Corner straight() { return bent(Vector::UnitZ(), 0); }

const char* const laws[] = {"round_rod", "discrete_rod", "curled_rod"};

TEST(RodLaws, StraightRodsTwistByTheDifferenceOfAngles) {
  const Step step{straight(), straight()};
  Corner turned = straight();
  turned.angle[0] = 0.3, turned.angle[1] = 7.5;  // more than a turn
  for (const char* law : laws) EXPECT_NEAR(value(law, step.inputs(turned)), 5 * 7.2 * 7.2 / 2, 1e-12) << law;
}

// 2 tan(angle/2) about each axis of the cross-section; turned by a right angle the axes change places.
TEST(RodLaws, EachAxisHasItsStiffness) {
  const double kappa = 2 * std::tan(0.2), square = kappa * kappa / 2;
  Corner about_z = bent(Vector::UnitZ(), 0.4), about_y = bent(Vector::UnitY(), 0.4);
  const Step from_z{straight(), about_z}, from_y{straight(), about_y};
  for (const char* law : {"discrete_rod", "curled_rod"}) {
    EXPECT_NEAR(value(law, from_z.inputs(about_z)), 3 * square, 1e-14) << law;
    EXPECT_NEAR(value(law, from_y.inputs(about_y)), 7 * square, 1e-14) << law;
    Corner turned = about_z;
    turned.angle[0] = turned.angle[1] = M_PI / 2;
    EXPECT_NEAR(value(law, from_z.inputs(turned)), 7 * square, 1e-14) << law;
    turned.angle[0] = turned.angle[1] = M_PI / 6;
    EXPECT_NEAR(value(law, from_z.inputs(turned)), (3 * 0.75 + 7 * 0.25) * square, 1e-14) << law;
  }
  EXPECT_NEAR(value("round_rod", from_z.inputs(about_z)), 3 * square, 1e-14);
  const Step drawn{about_z, about_z};
  EXPECT_EQ(value("discrete_rod", drawn.inputs(about_z)), 0);
}

Eigen::Matrix3d transport(const Vector& a, const Vector& b) {
  return Eigen::Quaterniond::FromTwoVectors(a, b).toRotationMatrix();
}

// Frames that are carried along step by step, and turned by the angles, tell what the laws make of angles and
// positions; the whole may turn in space.
TEST(RodLaws, ManyStepsKeepTheMaterialFrames) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  const auto noise = [&](double size) {
    return Vector(size * normal(random), size * normal(random), size * normal(random));
  };
  for (const char* law : laws) {
    Step step{straight(), straight()};
    Vector carried[2] = {Vector::UnitZ(), Vector::UnitZ()};  // references of both edges
    double before = 0;                                       // the twist, to count turns
    for (int k = 0; k < 30; ++k) {
      Corner now = step.start;
      for (Vector& x : now.x) x = Eigen::AngleAxisd(0.3, Vector(1, 2, -1).normalized()) * (x + noise(0.1));
      now.angle[0] += 0.2 * normal(random), now.angle[1] += 0.2 + 0.2 * normal(random);
      Vector t[2], d1[2], d2[2];
      for (int e = 0; e < 2; ++e) {
        t[e] = (now.x[e + 1] - now.x[e]).normalized();
        carried[e] = transport((step.start.x[e + 1] - step.start.x[e]).normalized(), t[e]) * carried[e];
        d1[e] = Eigen::AngleAxisd(now.angle[e], t[e]) * carried[e];
        d2[e] = t[e].cross(d1[e]);
      }
      const Vector kb = 2 * t[0].cross(t[1]) / (1 + t[0].dot(t[1])), there = transport(t[0], t[1]) * d1[0];
      double twist = std::atan2(there.cross(d1[1]).dot(t[1]), there.dot(d1[1]));
      twist += 2 * M_PI *
               std::round((before + now.angle[1] - now.angle[0] - step.start.angle[1] + step.start.angle[0] - twist) /
                          (2 * M_PI));
      before = twist;
      const Vector half1 = Eigen::AngleAxisd(twist / 2, t[0]) * d1[0], half2 = t[0].cross(half1);
      const double k1 = kb.dot(half1), k2 = kb.dot(half2);
      const double bend = std::string(law) == "round_rod" ? 3 * kb.squaredNorm() : 3 * k1 * k1 + 7 * k2 * k2;
      const double expected = (bend + 5 * twist * twist) / 2;
      EXPECT_NEAR(value(law, step.inputs(now)), expected, 1e-11 * expected) << law << " step " << k;
      step.accept(law, now);
    }
  }
}

// Vertices of a helix, with frames that turn as its curvature and twist say, cost nothing.
TEST(RodLaws, AHelixOfItsOwnCurvatureAndTwistIsFree) {
  const double turn = 0.3, radius = 1, pitch = 0.2;
  const auto at = [&](int i) { return Vector(radius * std::cos(turn * i), radius * std::sin(turn * i), pitch * i); };
  Vector t[3];
  for (int i = 0; i < 3; ++i) t[i] = (at(i + 1) - at(i)).normalized();
  const Vector kb[2] = {2 * t[0].cross(t[1]) / (1 + t[0].dot(t[1])), 2 * t[1].cross(t[2]) / (1 + t[1].dot(t[2]))};
  // Both corners have the first axis of the cross-section along kb, halfway between their edges: the twist between.
  const Vector across = kb[0].normalized(), next = kb[1].normalized();
  const double tau = std::atan2(across.cross(next).dot(t[1]), across.dot(next));
  const Corner drawn{{at(0), at(1), at(2)}, {0, 0}};
  Step step{drawn, drawn};
  step.axis = Eigen::AngleAxisd(-tau / 2, t[0]) * across;
  Corner helix = step.rest;
  helix.angle[1] = tau;
  Inputs in = step.inputs(helix);
  in["k1"] = {kb[0].norm()}, in["tau"] = {tau};
  EXPECT_LT(value("curled_rod", in), 1e-28);
  in["tau"] = {0};
  EXPECT_GT(value("curled_rod", in), 1e-4);
}

}  // namespace
}  // namespace ergon
