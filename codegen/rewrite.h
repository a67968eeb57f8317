#pragma once
// Rebuilding a module's graph from its roots.

#include <functional>

#include "codegen/module.h"

namespace ergon {

// Makes node `id` of `from` again in `to`, given the new numbers of the old nodes.
NodeId copy_node(const Graph& from, NodeId id, const std::vector<NodeId>& renumbered, Graph& to);

// Rebuilds the graph: `rule(old graph, id, renumbered, new graph)` makes each node that the roots need, operands first.
// All roots of the module are renumbered; names are kept.
using RewriteRule = std::function<NodeId(const Graph&, NodeId, const std::vector<NodeId>&, Graph&)>;
void rewrite(Module& module, const RewriteRule& rule);

}  // namespace ergon
