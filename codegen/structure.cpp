#include "codegen/structure.h"

#include <algorithm>

#include "codegen/closed_form.h"
#include "codegen/convexity.h"
#include "codegen/intervals.h"

namespace ergon {
namespace {

bool depends_on_q(const Graph& g, const std::vector<NodeId>& roots) {
  for (NodeId id : reachable(g, roots))
    if (g[id].kind == Node::Kind::input && g[id].source == Source::q) return true;
  return false;
}

// A diagonal without a negative entry.
bool is_nonnegative_diagonal(const Module& module) {
  const std::vector<Interval> intervals = find_intervals(module);
  for (int i = 0, k = 0; i < module.q_size(); ++i)
    for (int j = 0; j <= i; ++j, ++k) {
      const NodeId entry = module.hessian[static_cast<size_t>(k)];
      if (i == j ? !intervals[static_cast<size_t>(entry)].nonnegative() : !module.graph.is_constant(entry, 0))
        return false;
    }
  return true;
}

}  // namespace

void find_structure(Module& module) {
  const Graph& g = module.graph;
  if (module.stretches) return;             // what holds with respect to the stretches need not hold with respect to F
  const bool two_forms = module.near >= 0;  // each alone depends on q in what it computes
  module.constant_gradient = !two_forms && !depends_on_q(g, module.gradient);
  module.constant_hessian = !two_forms && !depends_on_q(g, module.hessian);
  module.zero_hessian =
      std::all_of(module.hessian.begin(), module.hessian.end(), [&](NodeId id) { return g.is_constant(id, 0); });

  // Both forms are one function; the second is the author's.
  module.psd_hessian =
      is_convex(module, two_forms ? module.far.value : module.value) || (!two_forms && is_nonnegative_diagonal(module));
  // What a density has of this kind is isotropic: find_principal().
  if (!module.psd_hessian && !two_forms && module.points > 0) find_closed_form(module);
}

}  // namespace ergon
