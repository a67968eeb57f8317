#include "codegen/rest_form.h"

#include <algorithm>
#include <exception>

#include "codegen/cancellations.h"
#include "codegen/lower.h"
#include "codegen/rest_algebra.h"
#include "symbolic/elaborate.h"
#include "symbolic/ginac_algebra.h"
#include "symbolic/isotropy.h"
#include "symbolic/jet.h"
#include "symbolic/sample_states.h"

namespace ergon {
namespace {

constexpr double kNear = 1.0 / 16;  // of |G|^2: there 1 + G is far from singular, and expansions are short

bool constant_zero(const Graph& g, const std::vector<NodeId>& nodes) {
  return std::all_of(nodes.begin(), nodes.end(), [&](NodeId id) { return g.is_constant(id, 0); });
}

struct AtRest {
  bool no_value = false, no_slope = false;
};

// Decides by exact algebra, for parameters that remain symbols; what that cannot decide, a comparison of parameters or
// a pole, counts as not at rest.
AtRest exactly_at_rest(const Energy& energy, const std::string& case_name) try {
  ExactInputs inputs;
  for (const Symbol* dof : energy.with_role(Role::dof)) inputs[dof->name] = undeformed(dof->shape);
  GinacAlgebra numbers(std::move(inputs));
  JetAlgebra<GinacAlgebra> jets(energy, numbers, JetAlgebra<GinacAlgebra>::Order::first);
  const Jet<GiNaC::ex> at = elaborate(energy, case_name, jets).value;
  auto zero = [](const GiNaC::ex& e) { return e.is_zero() || e.normal().is_zero(); };
  return {zero(at.value), std::all_of(at.gradient.begin(), at.gradient.end(), zero)};
} catch (const std::exception&) {
  return {};
}

// Whether the module was replaced by its expansion about rest.
bool expand_about_rest(Module& module) {
  const Energy& energy = *module.energy;
  if (energy.kind != Energy::Kind::density) return false;
  Module made = empty_module(energy, module.case_name);
  made.displacement = true;
  RestAlgebra algebra(made);
  const Elaborated<int> parts = elaborate(energy, module.case_name, algebra);
  if (!algebra.expands(parts.value)) return false;

  Graph& g = made.graph;
  const NodeId at_rest = algebra.at_rest(parts.value);
  AtRest rest{g.is_constant(at_rest, 0), constant_zero(g, algebra.slope_at_rest(parts.value))};
  if (!rest.no_value || !rest.no_slope) rest = exactly_at_rest(energy, module.case_name);
  if (!rest.no_slope) return false;
  // In the axes of an element at rest a law tied to those of space is another.
  if (energy.geometry != "solid" && !is_frame_invariant(energy, module.case_name)) return false;
  const NodeId remainder = algebra.remainder(parts.value);
  made.value = rest.no_value ? remainder : g.add(at_rest, remainder);
  for (const int margin : parts.active) made.active.push_back(algebra.direct(margin));
  for (const int margin : parts.require) made.require.push_back(algebra.direct(margin));
  for (const int component : parts.update) made.update.push_back(algebra.direct(component));
  if (!algebra.polynomial(parts.value)) {
    std::vector<Term> squares;
    for (int i = 0; i < made.q_size(); ++i) squares.push_back({-1, g.power(g.input(Source::q, i), 2)});
    made.near = g.sum(kNear, std::move(squares));
    made.far.value = algebra.direct(parts.value);
  }
  flatten(made);
  module = std::move(made);
  return true;
}

}  // namespace

void rest_form(Module& module) {
  if (!expand_about_rest(module)) remove_cancellations(module);
}

}  // namespace ergon
