#include "tests/codegen/states.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace ergon::testing {
namespace {

double draw(const Range& range, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.02, 0.98);
  bool below = std::isfinite(range.lower), above = std::isfinite(range.upper);
  if (below && above) return range.lower + (range.upper - range.lower) * unit(random);
  double size = std::pow(10.0, 2 * unit(random) - 1);
  if (below) return range.lower + size;
  if (above) return range.upper - size;
  return std::normal_distribution<double>()(random);
}

std::vector<double> gaussian(int n, double size, std::mt19937& random) {
  std::normal_distribution<double> normal(0, size);
  std::vector<double> out(static_cast<size_t>(n));
  for (double& v : out) v = normal(random);
  return out;
}

// R diag(stretches) Q, column by column, for F of 3 x cols.
std::vector<double> deformation(const std::vector<double>& stretches, int cols, std::mt19937& random) {
  std::vector<double> r = random_rotation(random), q = random_rotation(random), f(static_cast<size_t>(3 * cols), 0);
  for (int j = 0; j < cols; ++j)
    for (int k = 0; k < cols; ++k)
      for (int i = 0; i < 3; ++i) {
        double qkj = cols == 3 ? q[static_cast<size_t>(3 * j + k)] : (j == k ? 1.0 : 0.0);
        f[static_cast<size_t>(3 * j + i)] +=
            r[static_cast<size_t>(3 * k + i)] * stretches[static_cast<size_t>(k)] * qkj;
      }
  return f;
}

// The rest position that goes with a point: "X0" for "x0", "P" for "p".
const Symbol* rest_of(const Energy& energy, const Symbol& dof) {
  std::string name = dof.name;
  name[0] = static_cast<char>(std::toupper(name[0]));
  const Symbol* s = energy.find(name);
  return s && s->role == Role::rest && s->shape == dof.shape ? s : nullptr;
}

void place_points(const Energy& energy, const std::string& kind, Inputs& inputs, std::mt19937& random) {
  std::vector<double> turn = random_rotation(random);
  const bool in_line = kind == "in line";
  double size = kind == "near rest" ? 1e-4 : kind == "random" ? 0.3 : in_line ? 0.02 : 1.5;
  for (const Symbol* dof : energy.with_role(Role::dof)) {
    const Symbol* rest = rest_of(energy, *dof);
    std::vector<double> at =
        rest && !in_line ? rotated(turn, inputs[rest->name]) : gaussian(dof->shape.size(), 1, random);
    if (in_line) at = {at[0] * turn[0], at[0] * turn[1], at[0] * turn[2]};
    std::vector<double> noise = gaussian(dof->shape.size(), size, random);
    for (size_t i = 0; i < at.size(); ++i) at[i] += noise[i];
    inputs[dof->name] = at;
  }
}

void place_deformation(const Energy& energy, const std::string& kind, Inputs& inputs, std::mt19937& random) {
  const Symbol* f = energy.with_role(Role::dof)[0];
  int cols = f->shape.cols;
  std::normal_distribution<double> normal;
  std::vector<double> s = {1, 1, 1};
  for (double& v : s)
    v = kind == "near rest" ? 1 + 1e-4 * normal(random)
        : kind == "random"  ? std::exp(0.2 * normal(random))
                            : std::exp(0.8 * normal(random));
  if (kind == "inverted") s[0] = -s[0];
  inputs[f->name] = deformation(s, cols, random);
}

}  // namespace

std::vector<double> random_rotation(std::mt19937& random) {
  std::vector<double> q = gaussian(4, 1, random);
  double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  double w = q[0] / n, x = q[1] / n, y = q[2] / n, z = q[3] / n;
  return {1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),
          2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),
          2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y)};
}

std::vector<double> rotated(const std::vector<double>& r, const std::vector<double>& columns) {
  std::vector<double> out(columns.size(), 0);
  for (size_t c = 0; c < columns.size(); c += 3)
    for (size_t k = 0; k < 3; ++k)
      for (size_t i = 0; i < 3; ++i) out[c + i] += r[3 * k + i] * columns[c + k];
  return out;
}

std::vector<State> draw_states(const Energy& energy, const std::string& case_name, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<State> out;
  for (const std::string kind : {"near rest", "random", "strongly deformed", "inverted", "in line"}) {
    int found = 0;
    if (kind == "in line" && energy.with_role(Role::dof).size() < 3) continue;
    for (int attempt = 0; attempt < 300 && found < 4; ++attempt) {
      State state{kind, {}};
      for (const Symbol& s : energy.symbols) {
        if (s.role == Role::dof) continue;
        std::vector<double> v(static_cast<size_t>(s.shape.size()));
        for (double& c : v) c = draw(s.range, random);
        state.inputs[s.name] = v;
      }
      if (energy.kind == Energy::Kind::density)
        place_deformation(energy, kind, state.inputs, random);
      else
        place_points(energy, kind, state.inputs, random);
      ReferenceValue at = evaluate_reference(energy, case_name, state.inputs, 20);
      if (!(std::abs(at.value) < 1e100)) continue;  // its parts may be beyond what a double holds
      auto holds = [](double margin) { return margin > 0; };
      if (!std::all_of(at.active.begin(), at.active.end(), holds) ||
          !std::all_of(at.require.begin(), at.require.end(), holds))
        continue;
      out.push_back(state);
      ++found;
    }
  }
  if (out.empty()) throw std::runtime_error(energy.name + ": no state found in which all conditions hold");
  return out;
}

}  // namespace ergon::testing
