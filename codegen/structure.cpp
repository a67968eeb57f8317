#include "codegen/structure.h"

#include <algorithm>

namespace ergon {
namespace {

bool depends_on_q(const Graph& g, const std::vector<NodeId>& roots) {
  for (NodeId id : reachable(g, roots))
    if (g[id].kind == Node::Kind::input && g[id].source == Source::q) return true;
  return false;
}

// Whether each param and raw component is known not to be negative from its declared range.
bool declared_nonnegative(const Module& module, Source source, int index) {
  const Energy& energy = *module.energy;
  for (size_t i = 0; i < energy.symbols.size(); ++i) {
    const Symbol& s = energy.symbols[i];
    bool matches = (s.role == Role::param) == (source == Source::param) && s.role != Role::dof;
    int first = module.offsets[i];
    if (matches && index >= first && index < first + s.shape.size()) return s.range.lower >= 0;
  }
  return false;
}

std::vector<char> find_nonnegative(const Module& module) {
  const Graph& g = module.graph;
  std::vector<char> out(static_cast<size_t>(g.size()), 0);
  for (NodeId id = 0; id < g.size(); ++id) {
    const Node& n = g[id];
    bool nonnegative = false;
    switch (n.kind) {
      case Node::Kind::constant:
        nonnegative = n.constant >= 0;
        break;
      case Node::Kind::input:
        nonnegative =
            (n.source == Source::param || n.source == Source::raw) && declared_nonnegative(module, n.source, n.index);
        break;
      case Node::Kind::sum:
        nonnegative = n.constant >= 0 && std::all_of(n.terms.begin(), n.terms.end(), [&](const Term& t) {
                        return t.coefficient >= 0 && out[static_cast<size_t>(t.node)];
                      });
        break;
      case Node::Kind::product:
        nonnegative = std::all_of(n.factors.begin(), n.factors.end(), [&](const Factor& f) {
          return f.den % 2 == 0 || f.num % 2 == 0 || out[static_cast<size_t>(f.base)];
        });
        break;
      case Node::Kind::call:
        nonnegative = n.call == Call::exp || n.call == Call::abs ||
                      (n.call == Call::keep && out[static_cast<size_t>(n.arguments[0])]);
        break;
    }
    out[static_cast<size_t>(id)] = nonnegative;
  }
  return out;
}

}  // namespace

void find_structure(Module& module) {
  const Graph& g = module.graph;
  const bool two_forms = module.near >= 0;  // each alone depends on q in what it computes
  module.constant_gradient = !two_forms && !depends_on_q(g, module.gradient);
  module.constant_hessian = !two_forms && !depends_on_q(g, module.hessian);
  module.zero_hessian =
      std::all_of(module.hessian.begin(), module.hessian.end(), [&](NodeId id) { return g.is_constant(id, 0); });

  std::vector<char> nonnegative = find_nonnegative(module);
  module.psd_hessian = !two_forms;
  for (int i = 0, k = 0; i < module.q_size(); ++i)
    for (int j = 0; j <= i; ++j, ++k) {
      NodeId entry = module.hessian[static_cast<size_t>(k)];
      bool fits = i == j ? nonnegative[static_cast<size_t>(entry)] : g.is_constant(entry, 0);
      module.psd_hessian = module.psd_hessian && fits;
    }
}

}  // namespace ergon
