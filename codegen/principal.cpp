#include "codegen/principal.h"

#include "codegen/differentiate.h"
#include "codegen/divided_difference.h"
#include "codegen/lower.h"
#include "codegen/rewrite.h"
#include "symbolic/isotropy.h"
#include "symbolic/typing.h"

namespace ergon {
namespace {

// The Hessian of a module with diag(s) for F, in a graph that may be the module's own.
class DiagonalHessian {
 public:
  DiagonalHessian(const Module& module, Graph& to) : module_(module), to_(to) {
    const std::vector<NodeId> order = reachable(module.graph, module.hessian);
    at_.assign(static_cast<size_t>(module.graph.size()), -1);
    for (NodeId id : order) at_[static_cast<size_t>(id)] = substitute(id);
  }

  // Entry of components (row a, column c) and (row b, column d) of F.
  NodeId operator()(int a, int c, int b, int d) const {
    const int i = 3 * c + a, j = 3 * d + b;
    const int entry = i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i;
    return at_[static_cast<size_t>(module_.hessian[static_cast<size_t>(entry)])];
  }

 private:
  NodeId substitute(NodeId id) {
    const Node n = module_.graph[id];
    if (n.kind != Node::Kind::input || n.source != Source::q) return copy_node(module_.graph, id, at_, to_);
    if (n.index % 4 != 0) return to_.constant(0);
    const NodeId s = to_.input(Source::stretch, n.index / 4);
    to_.set_name(s, "s" + std::to_string(n.index / 4));
    return s;
  }

  const Module& module_;
  Graph& to_;
  std::vector<NodeId> at_;
};

// The blocks of a density in principal stretches, by twists and flips of its slopes g_i.
class StretchBlocks {
 public:
  // The derivatives of `from` by its stretches, made again in the graph `to`.
  StretchBlocks(const Module& from, Graph& to) : from_(from), g_(to) {
    for (int i = 0; i < from.q_vectors; ++i) {
      s_.push_back(to.input(Source::stretch, i));
      to.set_name(s_.back(), "s" + std::to_string(i));
    }
    std::vector<NodeId> roots = from.gradient;
    roots.insert(roots.end(), from.hessian.begin(), from.hessian.end());
    const std::vector<NodeId> order = reachable(from.graph, roots);
    at_.assign(static_cast<size_t>(from.graph.size()), -1);
    for (NodeId id : order) {
      const Node n = from.graph[id];
      const bool stretch = n.kind == Node::Kind::input && n.source == Source::q;
      at_[static_cast<size_t>(id)] = stretch ? s_[static_cast<size_t>(n.index)] : copy_node(from.graph, id, at_, to);
    }
  }

  std::vector<NodeId> stretch() const {
    std::vector<NodeId> out;
    for (NodeId h : from_.hessian) out.push_back(at_[static_cast<size_t>(h)]);
    return out;
  }
  // Away from collapse the divisor is not small.
  NodeId twist(size_t i, size_t j) { return g_.divide(g_.add(slope(i), slope(j)), g_.add(s_[i], s_[j])); }
  // g_j is g_i with s_i and s_j exchanged, because g is symmetric.
  NodeId flip(size_t i, size_t j) { return DividedDifference(g_, s_[i], s_[j]).of(slope(i)); }
  NodeId normal(size_t i) { return g_.divide(slope(i), s_[i]); }

 private:
  NodeId slope(size_t i) const { return at_[static_cast<size_t>(from_.gradient[i])]; }

  const Module& from_;
  Graph& g_;
  std::vector<NodeId> s_, at_;
};

void find_principal_of_stretches(Module& module) try {
  Module direct;
  if (module.displacement) {
    direct = lower(*module.energy, module.case_name);
    differentiate(direct);
  }
  StretchBlocks blocks(module.displacement ? direct : module, module.graph);
  const auto axes = static_cast<size_t>(module.q_vectors);
  module.principal = blocks.stretch();
  if (axes == 3) {
    for (size_t k = 0; k < 3; ++k) module.principal.push_back(blocks.twist((k + 1) % 3, (k + 2) % 3));
    for (size_t k = 0; k < 3; ++k) module.principal.push_back(blocks.flip((k + 1) % 3, (k + 2) % 3));
    return;
  }
  if (axes == 2) module.principal.insert(module.principal.end(), {blocks.twist(0, 1), blocks.flip(0, 1)});
  for (size_t i = 0; i < axes; ++i) module.principal.push_back(blocks.normal(i));
} catch (const DividedDifference::UnknownDifference& unknown) {
  throw SourceError(start_of(*module.energy->value),
                    "no exact divided difference is known of '" + unknown.function +
                        "' of the stretches; known are sqrt, log, exp, log1p, expm1, abs, min, max and powers");
}

}  // namespace

void find_principal(Module& module) {
  if (module.stretches) return find_principal_of_stretches(module);
  if (module.points != 0 || module.constant_hessian || module.psd_hessian) return;
  if (!is_isotropic(*module.energy, module.case_name)) return;
  Graph& g = module.graph;
  // Over F itself: with F - I, small stretches would lose digits.
  Module direct;
  if (module.displacement) {
    direct = lower(*module.energy, module.case_name);
    differentiate(direct);
  }
  const DiagonalHessian h(module.displacement ? direct : module, g);
  const int axes = module.q_vectors;
  for (int i = 0; i < axes; ++i)
    for (int j = 0; j <= i; ++j) module.principal.push_back(h(i, i, j, j));
  const auto twist = [&](int i, int j) { return g.subtract(h(i, j, i, j), h(i, j, j, i)); };
  const auto flip = [&](int i, int j) { return g.add(h(i, j, i, j), h(i, j, j, i)); };
  if (axes == 3) {
    for (int k = 0; k < 3; ++k) module.principal.push_back(twist((k + 1) % 3, (k + 2) % 3));
    for (int k = 0; k < 3; ++k) module.principal.push_back(flip((k + 1) % 3, (k + 2) % 3));
    return;
  }
  if (axes == 2) module.principal.insert(module.principal.end(), {twist(0, 1), flip(0, 1)});
  for (int i = 0; i < axes; ++i) module.principal.push_back(h(2, i, 2, i));
}

}  // namespace ergon
