// The closed forms that beams are verified by, against published tables and small loads.

#include "tools/verify/elastica.h"

#include <gtest/gtest.h>

namespace ergon {
namespace {

TEST(Elastica, HasThePublishedDeflections) {
  // Mattiasson 1981, Numerical results from large deflection beam and frame problems analysed by means of elliptic
  // integrals, IJNME 17: P L^2/EI, w/L, u/L.
  const double published[][3] = {
      {1, 0.30172, 0.05643}, {2, 0.49346, 0.16064}, {5, 0.71379, 0.38763}, {10, 0.81061, 0.55500}};
  for (const auto& [load, down, back] : published) {
    EXPECT_NEAR(elastica_tip(load).down, down, 5.1e-6) << load;
    EXPECT_NEAR(elastica_tip(load).back, back, 5.1e-6) << load;
  }
}

TEST(Elastica, IsThatOfLinearTheoryUnderSmallLoads) {
  EXPECT_NEAR(elastica_tip(1e-3).down / 1e-3, 1. / 3, 1e-7);
  EXPECT_NEAR(heavy_elastica_tip(1e-3).down / 1e-3, 1. / 8, 1e-7);
  EXPECT_EQ(elastica_tip(0).down, 0);
  EXPECT_EQ(elastica_tip(0).back, 0);
}

TEST(Elastica, HangsDownUnderItsWeightAsPublished) {
  // Romero et al. 2021, Physical validation of simulators in computer graphics, TOG 40(4), test Cantilever: rho g A
  // L^3/EI, drop over reach.
  const double published[][2] = {{1, 0.1246}, {10, 1.0668}, {100, 5.8881}};
  for (const auto& [load, ratio] : published) {
    const ElasticaTip tip = heavy_elastica_tip(load);
    EXPECT_NEAR(tip.down / (1 - tip.back), ratio, 5.1e-5) << load;
  }
}

}  // namespace
}  // namespace ergon
