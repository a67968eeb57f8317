#include <gtest/gtest.h>

#include <string>

#include "runtime/contact/ccd.h"
#include "runtime/contact/ccd_inclusion.h"
#include "tests/runtime/exact_distance.h"
#include "tools/contact_cases.h"
#include "tools/exact_collision.h"

namespace ergon {
namespace {

using Eigen::Vector3d;

struct Pair {
  const char* name;
  bool edges;
  int kinds;
  double (*step)(const CcdQuery&);
  bool (*collides)(const Vector3d*, const Vector3d*, double);
  mpq_class (*gap2)(const exact::Point&, const exact::Point&, const exact::Point&, const exact::Point&);
};
const Pair kPairs[] = {
    {"point and triangle", false, ContactCases::kPointTriangleKinds, point_triangle_step, point_triangle_collides,
     exact::point_triangle},
    {"edge and edge", true, ContactCases::kEdgeEdgeKinds, edge_edge_step, edge_edge_collides, exact::edge_edge}};

std::string name(const Pair& pair, int kind, int motion, int trial) {
  return std::string(pair.name) + ", kind " + std::to_string(kind) + ", motion " + std::to_string(motion) + ", trial " +
         std::to_string(trial);
}

// Every placement with every motion: what is said to be free is free, by a decision without rounding.
void expect_none_missed(int trials, unsigned seed) {
  ContactCases cases(seed);
  for (const Pair& pair : kPairs) {
    for (int kind = 0; kind < pair.kinds; ++kind) {
      for (int motion = 0; motion < ContactCases::kMotionKinds; ++motion) {
        for (int trial = 0; trial < trials; ++trial) {
          const FourPoints x = pair.edges ? cases.edge_edge(kind) : cases.point_triangle(kind);
          const FourPoints m = cases.motion(motion, x, pair.edges ? 2 : 1);
          const double step = pair.step({x.data(), m.data()});
          ASSERT_GE(step, 0) << name(pair, kind, motion, trial);
          ASSERT_LE(step, 1) << name(pair, kind, motion, trial);
          if (step == 0) continue;
          EXPECT_FALSE(pair.collides(x.data(), m.data(), step)) << name(pair, kind, motion, trial) << ", " << step;
        }
      }
    }
  }
}

TEST(ContactCcd, MissesNothing) { expect_none_missed(20, 1); }
TEST(SlowContactCcd, MissesNothing) { expect_none_missed(1000, 2); }

exact::Point at(const Vector3d& x, const Vector3d& motion, double t) {
  exact::Point p;
  for (int i = 0; i < 3; ++i) p[static_cast<size_t>(i)] = mpq_class(x(i)) + mpq_class(motion(i)) * mpq_class(t);
  return p;
}
mpq_class gap2(const Pair& pair, const FourPoints& x, const FourPoints& m, double t) {
  return pair.gap2(at(x[0], m[0], t), at(x[1], m[1], t), at(x[2], m[2], t), at(x[3], m[3], t));
}

TEST(ContactCcd, KeepsTheFractionOfTheGapBeyondTheSeparation) {
  ContactCases cases(3);
  int moved = 0;
  for (const Pair& pair : kPairs) {
    for (int kind = 0; kind < pair.kinds; ++kind) {
      for (int motion = 0; motion < ContactCases::kMotionKinds; ++motion) {
        for (int trial = 0; trial < 10; ++trial) {
          const FourPoints x = pair.edges ? cases.edge_edge(kind) : cases.point_triangle(kind);
          const FourPoints m = cases.motion(motion, x, pair.edges ? 2 : 1);
          const double gap = std::sqrt(gap2(pair, x, m, 0).get_d());
          const double separation = trial % 2 == 0 ? 0 : cases.uniform(0, 1.01) * gap, kept = cases.uniform(0.01, 0.9);
          const double step = pair.step({x.data(), m.data(), separation, kept});
          if (step == 0) continue;
          ++moved;
          // gap is rounded, to a few units in the last place of itself.
          const double limit = (separation + kept * (gap - separation)) - 1e-14 * gap;
          for (const double t : {0.0, 0.25 * step, 0.5 * step, 0.75 * step, step}) {
            EXPECT_GT(gap2(pair, x, m, t), mpq_class(limit) * mpq_class(limit))
                << name(pair, kind, motion, trial) << ", at " << t << " of " << step;
          }
        }
      }
    }
  }
  EXPECT_GT(moved, 1500);
}

TEST(ContactCcd, RestAndCommonMotionAreNotHeldUp) {
  ContactCases cases(4);
  for (const Pair& pair : kPairs) {
    for (int kind = 0; kind < pair.kinds; ++kind) {
      for (const int motion : {0, 3}) {
        for (int trial = 0; trial < 100; ++trial) {
          const FourPoints x = pair.edges ? cases.edge_edge(kind) : cases.point_triangle(kind);
          const FourPoints m = cases.motion(motion, x, pair.edges ? 2 : 1);
          const bool apart = gap2(pair, x, m, 0) > 0;
          EXPECT_EQ(pair.step({x.data(), m.data()}), apart ? 1 : 0) << name(pair, kind, motion, trial);
        }
      }
    }
  }
}

TEST(ContactCcd, SlidingIsNotHeldUp) {
  for (const double gap : {1.0, 1e-3, 1e-6, 1e-9, 1e-12, 1e-16}) {
    for (const double offset : {0.0, 1e6}) {
      const Vector3d o(offset, -offset, 0);  // the plane is at z = 0, where gaps of 1e-16 can be told
      const Vector3d above[] = {o + Vector3d(0.25, 0.25, gap), o, o + Vector3d(1, 0, 0), o + Vector3d(0, 1, 0)};
      const Vector3d across[] = {{6, 0.1, 0}, {0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0}};
      EXPECT_EQ(point_triangle_step({above, across}), 1) << gap << " " << offset;
      const Vector3d edges[] = {o + Vector3d(0.25, -1, gap), o + Vector3d(0.25, 1, gap), o, o + Vector3d(1, 1, 0)};
      EXPECT_EQ(edge_edge_step({edges, across}), 1) << gap << " " << offset;
    }
  }
  // In one plane, along an edge.
  const Vector3d flat[] = {{-0.9, 1e-9, 0}, {-1, 0, 0}, {1, 0, 0}, {0, -1, 0}};
  const Vector3d along[] = {{6, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(point_triangle_step({flat, along}), 1);
}

TEST(ContactCcd, StepsAreAsLongAsTheyMayBe) {
  for (const double gap : {1.0, 1e-4, 1e-8, 1e-12, 1e-15}) {
    for (const double separation : {0.0, 0.5 * gap}) {
      for (const double kept : {0.5, 0.1, 0.01}) {
        // The gap beyond the separation goes linearly, to minus itself at time 1.
        const double by = -2 * (gap - separation);
        const Vector3d fall[] = {{0, 0, by}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        const Vector3d x[] = {{0.2, 0.2, gap}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        const double step = (1 - kept) / 2;
        EXPECT_NEAR(point_triangle_step({x, fall, separation, kept}), step, 1e-3 * step) << gap;
        const Vector3d corner[] = {{0, 0, gap}, {0, 0, 0}, {1, 0, -1}, {0, 1, -1}};
        EXPECT_NEAR(point_triangle_step({corner, fall, separation, kept}), step, 1e-3 * step) << gap;
        const Vector3d both[] = {{0, 0, by}, {0, 0, by}, {0, 0, 0}, {0, 0, 0}};
        const Vector3d e[] = {{-1, 0.1, gap}, {1, 0.1, gap}, {0, -1, 0}, {0, 1, 0}};
        EXPECT_NEAR(edge_edge_step({e, both, separation, kept}), step, 1e-3 * step) << gap;
        const Vector3d above[] = {{0, 0.1, gap}, {0, -1, 0}, {0, 1, 0}};
        EXPECT_NEAR(point_edge_step({above, fall, separation, kept}), step, 1e-3 * step) << gap;
        EXPECT_NEAR(point_point_step({corner, fall, separation, kept}), step, 1e-3 * step) << gap;
      }
    }
  }
}

TEST(ContactCcd, LongerStepsThanAskedForAreNotLookedFor) {
  ContactCases cases(5);
  for (const Pair& pair : kPairs) {
    for (int trial = 0; trial < 1000; ++trial) {
      const ContactCases::Moving m = cases.near_contact(pair.edges);
      const double free = pair.step({m.x.data(), m.motion.data()});
      for (const double most : {0.7, 0.2, 0.01}) {
        EXPECT_EQ(pair.step({m.x.data(), m.motion.data(), 0, 0.1, most}), std::min(most, free)) << trial;
      }
    }
  }
}

// Whole coordinates have exact differences anywhere.
TEST(ContactCcd, DoesNotDependOnWhereTheOriginIs) {
  ContactCases cases(6);
  for (const Pair& pair : kPairs) {
    for (int trial = 0; trial < 500; ++trial) {
      FourPoints x = pair.edges ? cases.edge_edge(4) : cases.point_triangle(4);
      const FourPoints m = cases.motion(7, x, pair.edges ? 2 : 1);
      const double here = pair.step({x.data(), m.data()});
      for (Vector3d& p : x) p += Vector3d(1e6, -3e6, 1e9);
      EXPECT_EQ(pair.step({x.data(), m.data()}), here) << trial;
    }
  }
}

TEST(ContactCcd, StartsThatTouchOrAreTooCloseGetNoStep) {
  const Vector3d x[] = {{0.2, 0.2, 1e-3}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const Vector3d away[] = {{0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(point_triangle_step({x, away}), 1);
  EXPECT_EQ(point_triangle_step({x, away, 0.9e-3}), 1);
  EXPECT_EQ(point_triangle_step({x, away, 1e-3}), 0);
  EXPECT_EQ(point_triangle_step({x, away, 2e-3}), 0);
  const Vector3d on[] = {{0.2, 0.2, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(point_triangle_step({on, away}), 0);
  const double nan = std::nan("");
  const Vector3d lost[] = {{0, nan, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(point_triangle_step({x, lost}), 0);
}

// Of random queries near contact, few that do not collide are shortened: 3 percent at most.
TEST(ContactCcd, FewFalsePositives) {
  ContactCases cases(7);
  for (const Pair& pair : kPairs) {
    int shortened = 0, trials = 4000;
    for (int trial = 0; trial < trials; ++trial) {
      const ContactCases::Moving m = cases.near_contact(pair.edges);
      const double step = pair.step({m.x.data(), m.motion.data()});
      if (step < 1 && !pair.collides(m.x.data(), m.motion.data(), 1)) ++shortened;
      EXPECT_FALSE(step > 0 && pair.collides(m.x.data(), m.motion.data(), step)) << trial;
    }
    EXPECT_LT(shortened, 0.03 * trials) << pair.name;
  }
}

// Both methods establish the same; what one gets out of it the other does, but for what each stops short.
TEST(ContactCcd, SubdivisionAgrees) {
  ContactCases cases(8);
  for (const Pair& pair : kPairs) {
    const auto subdivided = pair.edges ? edge_edge_step_by_inclusion : point_triangle_step_by_inclusion;
    int close = 0, trials = 300;
    for (int trial = 0; trial < trials; ++trial) {
      const ContactCases::Moving m = cases.near_contact(pair.edges);
      const double step = pair.step({m.x.data(), m.motion.data()}), other = subdivided({m.x.data(), m.motion.data()});
      ASSERT_TRUE(other >= 0 && other <= 1);
      EXPECT_FALSE(other > 0 && pair.collides(m.x.data(), m.motion.data(), other)) << trial;
      EXPECT_FALSE(other > 0 && step < 1 && other > 1.3 * step) << trial << ": " << other << " and " << step;
      close += other > 0.9 * step ? 1 : 0;
    }
    EXPECT_GT(close, 0.95 * trials) << pair.name;
    for (int trial = 0; trial < 100; ++trial) {
      const ContactCases::Moving m = cases.any(pair.edges);
      const double other = subdivided({m.x.data(), m.motion.data(), 0, 0.1, 0.5});
      EXPECT_TRUE(other >= 0 && other <= 0.5);
      EXPECT_FALSE(other > 0 && pair.collides(m.x.data(), m.motion.data(), other)) << trial;
    }
  }
}

}  // namespace
}  // namespace ergon
