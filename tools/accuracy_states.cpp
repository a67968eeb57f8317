#include "tools/accuracy_states.h"

#include <cln/dfloat.h>

#include <algorithm>
#include <cmath>

#include "symbolic/sample_states.h"
#include "tools/sample.h"

namespace ergon {
namespace {

constexpr int digits = 50;
constexpr double no_overflow = 1e250;  // of values; what they are made of may be larger

double uniform(std::mt19937_64& random, double low, double high) {
  return low + (high - low) * double(random() >> 11) * 0x1p-53;
}

cln::cl_RA exact(double value) { return cln::rational(cln::cl_DF(value)); }

// Corners of the simplex of the coordinate axes, away from the origin.
std::vector<double> simplex(int edges) {
  const std::vector<double> origin = {0.25, 0.5, 0.125};
  std::vector<double> X;
  for (int point = 0; point <= edges; ++point)
    for (int c = 0; c < 3; ++c) X.push_back(origin[static_cast<size_t>(c)] + (point == c + 1 ? 1 : 0));
  return X;
}

// A vector among the lag data with the unit of a position: x is near it when a step begins.
const Symbol* lagged_position(const Energy& energy, const Symbol& dof) {
  for (const Symbol* symbol : energy.with_role(Role::lag))
    if (symbol->shape == dof.shape && symbol->unit == dof.unit) return symbol;
  return nullptr;
}

// Moves random points of a contact stencil to where it is degenerate: a point onto the face, an edge or a corner of its
// triangle; edges that cross, share an end, or are parallel. Every third hinge is flat.
void bring_together(const std::string& stencil, std::vector<double>& X, std::mt19937_64& random) {
  auto at = [&](size_t point, size_t c) -> double& { return X[3 * point + c]; };
  const unsigned kind = static_cast<unsigned>(random() % 3);
  const double s = uniform(random, 0.25, 0.5), t = uniform(random, 0.25, 0.5);
  for (size_t c = 0; c < 3; ++c) {
    if (stencil == "point_point") at(0, c) = at(1, c);
    if (stencil == "point_edge") at(0, c) = at(1, c) + (kind == 0 ? 0 : s) * (at(2, c) - at(1, c));
    if (stencil == "point_triangle") {
      const double to1 = at(2, c) - at(1, c), to2 = at(3, c) - at(1, c);
      at(0, c) = at(1, c) + (kind > 0 ? s * to1 : 0) + (kind > 1 ? t * to2 : 0);
    }
    if (stencil == "hinge" && kind == 0) at(3, c) = at(0, c) + s * (at(1, c) - at(0, c)) - t * (at(2, c) - at(0, c));
    if (stencil == "edge_edge") {
      const double edge = at(1, c) - at(0, c);
      if (kind == 0) at(2, c) = at(0, c);
      if (kind == 1) at(3, c) = at(2, c) + edge;
      if (kind == 2) at(3, c) = at(2, c) + (at(0, c) + s * edge - at(2, c)) / t;
    }
  }
}

std::vector<double> anchor(const Energy& energy, AccuracyState& state, std::mt19937_64& random) {
  if (energy.kind == Energy::Kind::density) return simplex(energy.with_role(Role::dof)[0]->shape.cols);
  const std::vector<const Symbol*> dofs = energy.with_role(Role::dof);
  std::vector<double> X(3 * dofs.size());
  for (double& x : X) x = uniform(random, -1, 1);
  if (energy.find("offset") == nullptr) bring_together(energy.geometry, X, random);
  for (size_t i = 0; i < dofs.size(); ++i) {
    const Symbol* rest = rest_position(energy, *dofs[i]);
    if (rest == nullptr) rest = lagged_position(energy, *dofs[i]);
    const auto first = X.begin() + 3 * static_cast<long>(i);
    if (rest != nullptr) state.inputs[rest->name].assign(first, first + 3);
  }
  return X;
}

// Makes the offset of a composed energy (symbolic/compose.h) the distance at X: its first condition is that of the gap.
void touch(const Energy& energy, const std::string& case_name, AccuracyState& state) {
  state.inputs["offset"] = {0};
  state.x = state.X;
  const ReferenceValue at = evaluate_reference_at(energy, case_name, exact_inputs(energy, state, false, {}), digits);
  state.inputs["offset"] = {std::max(at.require[0], 0.0)};
  state.x.clear();
}

bool admissible(const Energy& energy, const std::string& case_name, const AccuracyState& state) {
  const ReferenceValue at = evaluate_reference_at(energy, case_name, exact_inputs(energy, state, false, {}), digits);
  auto holds = [](double margin) { return margin > 0; };
  return std::abs(at.value) < no_overflow && std::all_of(at.active.begin(), at.active.end(), holds) &&
         std::all_of(at.require.begin(), at.require.end(), holds);
}

}  // namespace

std::optional<AccuracyState> accuracy_state(const Energy& energy, const std::string& case_name, double strain,
                                            std::mt19937_64& random) {
  for (int attempt = 0; attempt < 50; ++attempt) {
    AccuracyState state;
    for (const Role role : {Role::param, Role::rest, Role::lag})
      state.inputs.merge(sample_values(energy, role, static_cast<int>(random() % 1000)));
    state.X = anchor(energy, state, random);
    if (energy.find("offset") != nullptr) touch(energy, case_name, state);
    std::vector<double> direction(state.X.size());
    double size = 0;
    for (double& d : direction) d = uniform(random, -1, 1), size += d * d;
    for (size_t i = 0; i < state.X.size(); ++i) state.x.push_back(state.X[i] + strain * direction[i] / std::sqrt(size));
    if (admissible(energy, case_name, state)) return state;
  }
  return std::nullopt;
}

std::vector<double> kernel_points(const AccuracyState& state, bool displacement) {
  std::vector<double> points = state.x;
  for (size_t i = 0; displacement && i < points.size(); ++i) points[i] -= state.X[i];
  return points;
}

size_t input_count(const AccuracyState& state) {
  size_t count = state.x.size();
  for (const auto& [name, values] : state.inputs) count += values.size();
  return count;
}

ExactInputs exact_inputs(const Energy& energy, const AccuracyState& state, bool displacement,
                         const std::vector<double>& relative) {
  size_t next = 0;
  auto factor = [&] { return relative.empty() ? cln::cl_RA(1) : 1 + exact(relative[next++]); };
  ExactInputs out;
  for (const auto& [name, values] : state.inputs)
    for (const double value : values) out[name].push_back(exact(value) * factor());
  std::vector<cln::cl_RA> x;
  for (size_t i = 0; i < state.x.size(); ++i) {
    const cln::cl_RA origin = displacement ? exact(state.X[i]) : cln::cl_RA(0);
    x.push_back(origin + (exact(state.x[i]) - origin) * factor());
  }
  size_t i = 0;
  for (const Symbol* dof : energy.with_role(Role::dof))
    for (int c = 0; c < dof->shape.size(); ++c, ++i)
      out[dof->name].push_back(energy.kind == Energy::Kind::density ? x[i + 3] - x[i % 3] : x[i]);
  return out;
}

}  // namespace ergon
