#include "tools/verify/elastica.h"

#include <cmath>

namespace ergon {
namespace {

// The angle at the tip, between level and down, for which `excess`, which grows with it, is 0.
template <typename Excess>
double tip_angle(const Excess& excess) {
  double low = 0, high = M_PI / 2;
  for (int halving = 0; halving < 60; ++halving) {
    const double angle = (low + high) / 2;
    (excess(angle) < 0 ? low : high) = angle;
  }
  return (low + high) / 2;
}

struct HeavyBeam {
  double angle, slope, down, along;  // the slope by arc length; the place from the tip
};

// From the tip, whose angle is given, to the clamp: the method of Runge and Kutta of order 4.
HeavyBeam clamp_end(double load, double angle) {
  constexpr int steps = 2000;
  constexpr double ds = 1.0 / steps;
  const auto rates = [load](double s, const HeavyBeam& at) {
    return HeavyBeam{at.slope, -load * s * std::cos(at.angle), std::sin(at.angle), std::cos(at.angle)};
  };
  const auto moved = [](const HeavyBeam& at, double by, const HeavyBeam& rate) {
    return HeavyBeam{at.angle + by * rate.angle, at.slope + by * rate.slope, at.down + by * rate.down,
                     at.along + by * rate.along};
  };
  HeavyBeam at{angle, 0, 0, 0};
  for (int k = 0; k < steps; ++k) {
    const double s = k * ds;
    const HeavyBeam first = rates(s, at), second = rates(s + ds / 2, moved(at, ds / 2, first)),
                    third = rates(s + ds / 2, moved(at, ds / 2, second)), last = rates(s + ds, moved(at, ds, third));
    at = moved(moved(moved(moved(at, ds / 6, first), ds / 3, second), ds / 3, third), ds / 6, last);
  }
  return at;
}

}  // namespace

ElasticaTip elastica_tip(double load) {
  if (load == 0) return {0, 0};
  struct Integrals {
    double alpha, second;  // sqrt(load); the difference of the integrals of the second kind
  };
  const auto integrals = [](double angle) {
    const double modulus = std::sqrt((1 + std::sin(angle)) / 2);
    const double amplitude = std::atan(1 / std::sqrt(std::sin(angle)));  // its sine is 1/(modulus sqrt(2))
    return Integrals{std::comp_ellint_1(modulus) - std::ellint_1(modulus, amplitude),
                     std::comp_ellint_2(modulus) - std::ellint_2(modulus, amplitude)};
  };
  const double alpha = std::sqrt(load);
  const double angle = tip_angle([&](double guess) { return integrals(guess).alpha - alpha; });
  return {1 - 2 * integrals(angle).second / alpha, 1 - std::sqrt(2 * std::sin(angle)) / alpha};
}

ElasticaTip heavy_elastica_tip(double load) {
  const double angle = tip_angle([&](double guess) { return clamp_end(load, guess).angle; });
  const HeavyBeam clamp = clamp_end(load, angle);
  return {clamp.down, 1 - clamp.along};
}

}  // namespace ergon
