#pragma once
// The algebra in which an energy's text is a graph (see symbolic/elaborate.h).

#include <string>
#include <vector>

#include "codegen/module.h"
#include "symbolic/functions.h"
#include "symbolic/tensor.h"

namespace ergon {

class GraphAlgebra {
 public:
  using Scalar = NodeId;
  explicit GraphAlgebra(Module& module) : module_(module), graph_(module.graph) {}

  NodeId number(const std::string& decimal) { return graph_.constant(std::stod(decimal)); }
  NodeId add(NodeId a, NodeId b) { return graph_.add(a, b); }
  NodeId subtract(NodeId a, NodeId b) { return graph_.subtract(a, b); }
  NodeId multiply(NodeId a, NodeId b) { return graph_.multiply(a, b); }
  NodeId divide(NodeId a, NodeId b) { return graph_.divide(a, b); }
  NodeId negate(NodeId a) { return graph_.scale(-1, a); }
  NodeId power(NodeId a, long num, long den) { return graph_.power(a, static_cast<int>(num), static_cast<int>(den)); }
  NodeId power(NodeId a, NodeId b) { return graph_.call(Call::pow, {a, b}); }
  NodeId call(Function f, const std::vector<NodeId>& arguments);
  // F is I + q where the module is one of displacements, and diag(s) where it is one of stretches.
  NodeId input(const Symbol& symbol, int component);
  std::vector<NodeId> stretches(const Tensor<NodeId>& F);
  // Lets of parameters and rest or lag data alone become values of their own.
  NodeId named(const std::string& let, int component, int size, NodeId value);

  // Whether the node depends on a degree of freedom.
  bool moves(NodeId id);

 private:
  Module& module_;
  Graph& graph_;
  std::vector<char> moves_;
};

}  // namespace ergon
