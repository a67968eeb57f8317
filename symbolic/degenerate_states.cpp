#include "symbolic/critical_states.h"

namespace ergon {
namespace {

using Vector = std::vector<Rational>;

Vector combined(const Vector& a, const Rational& s, const Vector& b) {
  Vector r;
  for (size_t i = 0; i < a.size(); ++i) r.push_back(a[i] + s * (b[i] - a[i]));
  return r;
}

// Points that coincide two by two, lie on one line three by three, or in one plane.
void add_degenerate_points(const Energy& energy, const std::vector<const Symbol*>& points, StateSampler& sampler,
                           std::vector<ExactInputs>& states) {
  const size_t n = points.size();
  auto at = [&](ExactInputs& inputs, size_t i) -> Vector& { return inputs.at(points[i]->name); };
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = i + 1; j < n; ++j) {
      ExactInputs pair = sampler.any(energy);
      at(pair, j) = at(pair, i);
      states.push_back(std::move(pair));
    }
  }
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = i + 1; j < n; ++j) {
      for (size_t k = j + 1; k < n; ++k) {
        for (const int halves : {3, -1, 1}) {  // each in turn is the middle one
          ExactInputs line = sampler.any(energy);
          at(line, k) = combined(at(line, i), Rational(halves) / 2, at(line, j));
          states.push_back(std::move(line));
        }
      }
    }
  }
  if (n != 4) return;
  for (const Rational& s : {Rational(1) / 4, Rational(-3) / 4}) {  // the last point on either side of a line
    ExactInputs plane = sampler.any(energy);
    at(plane, 3) = combined(combined(at(plane, 0), Rational(3) / 2, at(plane, 1)), s, at(plane, 2));
    states.push_back(std::move(plane));
  }
}

// Columns of 3.
Vector product(const Vector& R, const Vector& F) {
  Vector r;
  for (size_t j = 0; j < F.size(); j += 3)
    for (size_t i = 0; i < 3; ++i) r.push_back(R[i] * F[j] + R[3 + i] * F[j + 1] + R[6 + i] * F[j + 2]);
  return r;
}

void add_degenerate_F(const Energy& energy, StateSampler& sampler, std::vector<ExactInputs>& states) {
  const Shape shape = energy.symbols[0].shape;
  auto add = [&](const Vector& F) {
    ExactInputs inputs = sampler.any(energy);
    inputs.at("F") = F;
    states.push_back(std::move(inputs));
  };
  auto stretched = [&](std::initializer_list<Rational> stretches) {
    Vector F = undeformed(shape);
    for (size_t j = 0; j < static_cast<size_t>(shape.cols); ++j) F[4 * j] = stretches.begin()[j];
    return F;
  };
  const Rational two(2), half = Rational(1) / 2;
  add(undeformed(shape));
  add(product(sampler.rotation(), undeformed(shape)));
  add(stretched({two, two, two}));
  add(stretched({two, two, half}));
  add(stretched({half, two, half}));
  add(product(sampler.rotation(), stretched({half, half, half})));
  add(stretched({two, half, Rational(0)}));
  add(stretched({two, Rational(0), Rational(0)}));
  add(stretched({Rational(0), Rational(0), Rational(0)}));
}

}  // namespace

std::vector<ExactInputs> degenerate_states(const Energy& energy, StateSampler& sampler) {
  std::vector<ExactInputs> states;
  if (energy.kind == Energy::Kind::density) {
    add_degenerate_F(energy, sampler, states);
    return states;
  }
  const auto dofs = energy.with_role(Role::dof);
  std::vector<const Symbol*> at_rest;
  for (const Symbol* dof : dofs)
    if (const Symbol* rest = rest_position(energy, *dof)) at_rest.push_back(rest);
  add_degenerate_points(energy, dofs, sampler, states);
  add_degenerate_points(energy, at_rest, sampler, states);
  if (at_rest.size() == dofs.size()) {
    ExactInputs rest = sampler.any(energy);
    for (size_t i = 0; i < dofs.size(); ++i) rest.at(dofs[i]->name) = rest.at(at_rest[i]->name);
    states.push_back(std::move(rest));
  }
  // Where a point is at the start of a step.
  for (const Symbol* lag : energy.with_role(Role::lag)) {
    if (lag->shape != Shape{3, 1}) continue;
    for (const Symbol* dof : dofs) {
      if (dof->unit != lag->unit) continue;
      ExactInputs still = sampler.any(energy);
      still.at(dof->name) = still.at(lag->name);
      states.push_back(std::move(still));
    }
  }
  return states;
}

}  // namespace ergon
