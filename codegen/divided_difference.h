#pragma once
// Divided differences of nodes by algebra, so that no two nearly equal numbers are subtracted.
//
// For a node n and an exchange of two inputs a and b, D n = (n - n')/(a - b), where n' is n with a and b exchanged.
//   D a = 1, D b = -1,   D(u + v) = D u + D v,   D(u v) = D u (v + v')/2 + (u + u')/2 D v,   D f(u) = f[u, u'] D u
// with f[x, y] = (f(x) - f(y))/(x - y) in a form that is exact where x = y: sums of products for whole powers,
// 1/(sqrt x + sqrt y) for roots, log1p and expm1 of what differs for logarithms, exponentials and other powers.

#include <string>
#include <vector>

#include "codegen/graph.h"

namespace ergon {

class DividedDifference {
 public:
  // a and b are inputs.
  DividedDifference(Graph& graph, NodeId a, NodeId b) : g_(graph), a_(a), b_(b) {}

  // D node. Throws UnknownDifference for a function that has no form.
  NodeId of(NodeId node);
  // n'
  NodeId exchanged(NodeId node);

  struct UnknownDifference {
    std::string function;
  };

 private:
  NodeId mean(NodeId node);
  NodeId of_product(const Node& n);
  NodeId of_call(NodeId node);
  NodeId of_power(NodeId base, int num, int den);
  NodeId of_choice(NodeId node, NodeId condition, NodeId above, NodeId below);
  NodeId whole_power(NodeId x, NodeId y, int exponent);
  NodeId log_slope(NodeId x, NodeId y);
  NodeId exp_slope(NodeId x, NodeId y);
  NodeId power_slope(NodeId x, NodeId y, NodeId exponent);

  Graph& g_;
  NodeId a_, b_;
  std::vector<NodeId> exchanged_, difference_;  // by node; -1 where not known
};

}  // namespace ergon
