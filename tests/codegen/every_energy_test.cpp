// What must hold for every file in energies/, at states from near rest to inverted: a new energy is tested by being
// there.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "codegen/interpret.h"
#include "runtime/lanes/projection_table.h"
#include "tests/codegen/diagonal_frame.h"
#include "tests/codegen/evaluate_kernel.h"
#include "tests/codegen/states.h"
#include "tests/symbolic/energy_files.h"

namespace ergon::testing {
namespace {

struct Case {
  std::string energy, case_name;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.energy << " " << c.case_name; }

std::vector<Case> cases_of_catalogue() {
  std::vector<Case> out;
  for (const Energy& energy : test::catalogue()) {
    if (energy.cases.empty()) out.push_back({energy.name, ""});
    for (const std::string& c : energy.cases) out.push_back({energy.name, c});
  }
  return out;
}

std::string test_name(const ::testing::TestParamInfo<Case>& info) {
  return test::name_of_test(info.param.energy, info.param.case_name);
}

double norm(const std::vector<double>& v) {
  double m = 0;
  for (double x : v) m = std::max(m, std::abs(x));
  return m;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double m = a.size() == b.size() ? 0 : INFINITY;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    m = std::isnan(a[i] - b[i]) ? INFINITY : std::max(m, std::abs(a[i] - b[i]));
  return m;
}

class EveryEnergy : public ::testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    energy = test::shipped(GetParam().energy);
    case_name = GetParam().case_name;
    states = draw_states(energy, case_name, 7);
  }

  ReferenceValue reference(const Inputs& inputs) const { return evaluate_reference(energy, case_name, inputs, 50); }
  KernelValue kernel(const Inputs& inputs, int lanes = 1) {
    return evaluate_kernel(energy, *test_kernel(energy, case_name, lanes).table, {inputs})[0];
  }
  bool moves(const std::string& name) const { return energy.find(name)->role == Role::dof; }
  double size_of_dofs(const Inputs& inputs) const {
    double m = 0;
    for (const Symbol* s : energy.with_role(Role::dof)) m = std::max(m, norm(inputs.at(s->name)));
    return m;
  }

  // How much results change, per unit of relative change of all inputs: what rounding of the inputs alone would do.
  struct Sensitivity {
    double value = 0, gradient = 0, hessian = 0, update = 0;
  };
  Sensitivity sensitivity(const Inputs& inputs, const ReferenceValue& at) {
    constexpr double step = 1e-7;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    Sensitivity out;
    for (int sample = 0; sample < 4; ++sample) {
      Inputs moved = inputs;
      for (auto& [name, values] : moved)
        for (double& v : values) v += v * step * unit(random);
      ReferenceValue near = reference(moved);
      out.value = std::max(out.value, std::abs(near.value - at.value) / step);
      out.gradient = std::max(out.gradient, distance(near.gradient, at.gradient) / step);
      out.hessian = std::max(out.hessian, distance(near.hessian, at.hessian) / step);
      out.update = std::max(out.update, distance(near.update, at.update) / step);
    }
    return out;
  }

  Energy energy;
  std::string case_name;
  std::vector<State> states;
};

// Errors are a few roundings of the result, of what rounding the inputs would change, and of the terms of a Taylor
// expansion that cancel near rest.
TEST_P(EveryEnergy, AgreesWithFiftyDigits) {
  constexpr double rounding = 2.22e-16, few = 40;
  for (const State& state : states) {
    ReferenceValue exact = reference(state.inputs);
    KernelValue got = kernel(state.inputs, test_widths().back());
    Sensitivity s = sensitivity(state.inputs, exact);
    double x = size_of_dofs(state.inputs), g = norm(exact.gradient), h = norm(exact.hessian);
    EXPECT_LE(std::abs(got.value - exact.value), few * rounding * (std::abs(exact.value) + s.value + g * x + h * x * x))
        << state.kind;
    EXPECT_LE(distance(got.gradient, exact.gradient), few * rounding * (g + s.gradient + h * x)) << state.kind;
    EXPECT_LE(distance(got.hessian, exact.hessian), few * rounding * (h + s.hessian)) << state.kind;
    EXPECT_LE(distance(got.update, exact.update), few * rounding * (norm(exact.update) + s.update)) << state.kind;
    EXPECT_GT(got.require, 0) << state.kind;
  }
}

TEST_P(EveryEnergy, AgreesWithCentralDifferences) {
  for (const State& state : states) {
    KernelValue at = kernel(state.inputs);
    ReferenceValue exact = reference(state.inputs);
    double x = size_of_dofs(state.inputs), step = 1e-5 * x;
    Sensitivity s = sensitivity(state.inputs, exact);
    size_t component = 0;
    for (const Symbol* dof : energy.with_role(Role::dof))
      for (int c = 0; c < dof->shape.size(); ++c, ++component) {
        Inputs up = state.inputs, down = state.inputs;
        double& above = up[dof->name][static_cast<size_t>(c)] += step;
        double& below = down[dof->name][static_cast<size_t>(c)] -= step;
        KernelValue a = kernel(up), b = kernel(down);
        double slope = (a.value - b.value) / (above - below);
        EXPECT_NEAR(at.gradient[component], slope, 1e-5 * (norm(at.gradient) + norm(at.hessian) * x + s.gradient))
            << state.kind;
        std::vector<double> column(at.gradient.size()), difference(at.gradient.size());
        for (size_t i = 0; i < column.size(); ++i) {
          column[i] = at.hessian[component * column.size() + i];
          difference[i] = (a.gradient[i] - b.gradient[i]) / (above - below);
        }
        EXPECT_LE(distance(column, difference), 1e-5 * (norm(at.hessian) + s.hessian)) << state.kind;
      }
  }
}

TEST_P(EveryEnergy, GraphInterpreterAgrees) {
  Generated generated = generate(energy, {.case_name = case_name});
  const Module& m = generated.module;
  for (const State& state : states) {
    GraphInputs in;
    in.params.resize(static_cast<size_t>(m.params));
    in.raw.resize(static_cast<size_t>(m.raw));
    std::vector<double> x;
    for (size_t i = 0; i < energy.symbols.size(); ++i) {
      const std::vector<double>& v = state.inputs.at(energy.symbols[i].name);
      if (energy.symbols[i].role == Role::dof)
        x.insert(x.end(), v.begin(), v.end());
      else
        std::copy(v.begin(), v.end(),
                  (energy.symbols[i].role == Role::param ? in.params : in.raw).begin() + m.offsets[i]);
    }
    if (m.stretches) {
      const DiagonalFrame frame(x);
      in.q = in.stretch = frame.s;
      for (double& s : in.q) s -= m.displacement ? 1 : 0;
      const ReferenceValue exact = reference(state.inputs);
      const Sensitivity s = sensitivity(state.inputs, exact);
      const double scale =
          std::abs(exact.value) + s.value + norm(exact.gradient) * norm(x) + norm(exact.hessian) * norm(x) * norm(x);
      const bool far = m.near >= 0 && !(interpret(m.graph, {m.near}, in)[0] > 0);
      EXPECT_NEAR(interpret(m.graph, {far ? m.far.value : m.value}, in)[0], exact.value, 1e-13 * scale) << state.kind;
      EXPECT_LE(distance(frame.hessian(interpret(m.graph, m.principal, in)), exact.hessian),
                1e-12 * (norm(exact.hessian) + s.hessian))
          << state.kind;
      continue;
    }
    in.q = m.points == 0 ? x : std::vector<double>(static_cast<size_t>(m.q_size()), 0);
    for (size_t i = 0; m.displacement && i < in.q.size(); i += 4) in.q[i] -= 1;  // F - I
    for (int k = 0; m.points > 0 && k < m.q_vectors; ++k)
      for (int p = 0; p < m.points; ++p)
        for (int c = 0; c < 3; ++c)
          in.q[static_cast<size_t>(3 * k + c)] +=
              m.weights[static_cast<size_t>(k * m.points + p)] * x[static_cast<size_t>(3 * p + c)];
    ReferenceValue exact = reference(state.inputs);
    Sensitivity s = sensitivity(state.inputs, exact);
    double size = size_of_dofs(state.inputs);
    const bool far = m.near >= 0 && !(interpret(m.graph, {m.near}, in)[0] > 0);
    EXPECT_NEAR(
        interpret(m.graph, {far ? m.far.value : m.value}, in)[0], exact.value,
        1e-13 * (std::abs(exact.value) + s.value + norm(exact.gradient) * size + norm(exact.hessian) * size * size));
    KernelValue got = kernel(state.inputs);
    EXPECT_LE(distance(interpret(m.graph, far ? m.far.hessian : m.hessian, in), got.q_hessian),
              1e-13 * (norm(exact.hessian) + s.hessian));
  }
}

TEST_P(EveryEnergy, AllWidthsAgree) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1e-6, 1e-6);
  for (const State& state : states) {
    std::vector<Inputs> nearby(11, state.inputs);  // more than a vector, with a tail
    for (size_t i = 1; i < nearby.size(); ++i)
      for (auto& [name, values] : nearby[i])
        if (energy.find(name)->role != Role::param)
          for (double& v : values) v += v * unit(random);
    std::vector<KernelValue> one = evaluate_kernel(energy, *test_kernel(energy, case_name, 1).table, nearby);
    ReferenceValue exact = reference(state.inputs);
    Sensitivity s = sensitivity(state.inputs, exact);
    double x = size_of_dofs(state.inputs), g = norm(exact.gradient), h = norm(exact.hessian);
    for (int lanes : test_widths()) {
      std::vector<KernelValue> many = evaluate_kernel(energy, *test_kernel(energy, case_name, lanes).table, nearby);
      ASSERT_EQ(many.size(), one.size());
      for (size_t i = 0; i < one.size(); ++i) {
        EXPECT_LE(std::abs(many[i].value - one[i].value),
                  1e-14 * (std::abs(exact.value) + s.value + g * x + h * x * x));
        EXPECT_LE(distance(many[i].gradient, one[i].gradient), 1e-14 * (g + s.gradient + h * x));
        EXPECT_LE(distance(many[i].hessian, one[i].hessian), 1e-14 * (h + s.hessian));
      }
    }
  }
}

// Points and their rest positions turn; a twist, a plane, a field or a lagged position stay. An energy must declare a
// fixed frame when it sees the difference, so both answers are checked.
TEST_P(EveryEnergy, InvariantUnderRotationUnlessItSaysOtherwise) {
  std::mt19937 random(5);
  double largest = 0;
  for (const State& state : states) {
    std::vector<double> r = random_rotation(random);
    Inputs turned = state.inputs;
    for (const Symbol& s : energy.symbols)
      if (s.shape.rows == 3 && (s.role == Role::dof || s.role == Role::rest) && !is_twist(energy, s))
        turned[s.name] = rotated(r, state.inputs.at(s.name));
    ReferenceValue at = reference(state.inputs);
    double x = size_of_dofs(state.inputs);
    double scale = std::abs(at.value) + norm(at.gradient) * x + norm(at.hessian) * x * x;
    largest = std::max(largest, std::abs(kernel(turned).value - kernel(state.inputs).value) / scale);
  }
  if (energy.fixed_frame)
    EXPECT_GT(largest, 1e-6);
  else
    EXPECT_LE(largest, 1e-13);
}

// Vector params are fixed in space (a plane, a field); without them an energy must not see where its points are.
TEST_P(EveryEnergy, InvariantUnderTranslation) {
  bool free_space = energy.kind == Energy::Kind::stencil && energy.part_of.empty();  // else the whole keeps under it
  for (const Symbol& s : energy.symbols) free_space = free_space && !(s.role == Role::param && s.shape.rows == 3);
  for (const State& state : states) {
    Inputs moved = state.inputs;
    for (const Symbol& s : energy.symbols)
      if (free_space && s.shape == Shape{3, 1} && !s.unit.dimensionless() && !is_twist(energy, s))  // directions stay
        for (size_t c = 0; c < 3; ++c) moved[s.name][c] += 0.25 * static_cast<double>(c + 1);
    ReferenceValue at = reference(state.inputs);
    double x = size_of_dofs(moved);
    double scale = std::abs(at.value) + norm(at.gradient) * x + norm(at.hessian) * x * x;
    EXPECT_NEAR(kernel(moved).value, kernel(state.inputs).value, 1e-13 * scale);
  }
}

TEST_P(EveryEnergy, ProjectedHessianHasNoNegativeEigenvalue) {
  for (int lanes : test_widths()) {
    CompiledKernel k = test_kernel(energy, case_name, lanes);
    const int m = 3 * k.table->q_vectors, entries = m * (m + 1) / 2;
    for (const State& state : states) {
      KernelValue v = evaluate_kernel(energy, *k.table, {state.inputs})[0];
      std::vector<double> storage(static_cast<size_t>(entries * lanes + 8));
      double* packed = storage.data();
      while (reinterpret_cast<std::uintptr_t>(packed) % 64 != 0) ++packed;
      for (int i = 0; i < entries; ++i)
        for (int lane = 0; lane < lanes; ++lane) packed[i * lanes + lane] = v.q_hessian[static_cast<size_t>(i)];
      lanes::projection_table(lanes).project[m](packed, false, (1u << lanes) - 1);
      double size = norm(v.q_hessian);
      // x'Hx by random vectors and the coordinate directions cannot be below rounding.
      std::mt19937 random(2);
      std::normal_distribution<double> normal;
      for (int sample = 0; sample < 200; ++sample) {
        std::vector<double> x(static_cast<size_t>(m));
        double length = 0, form = 0;
        for (double& c : x) c = normal(random), length += c * c;
        for (int i = 0, e = 0; i < m; ++i)
          for (int j = 0; j <= i; ++j, ++e)
            form += (i == j ? 1 : 2) * packed[e * lanes] * x[static_cast<size_t>(i)] * x[static_cast<size_t>(j)];
        EXPECT_GE(form, -1e-12 * size * length) << state.kind;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEnergy, ::testing::ValuesIn(cases_of_catalogue()), test_name);

}  // namespace
}  // namespace ergon::testing
