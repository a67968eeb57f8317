#pragma once
// The compiler's expression graph: hash-consed, with n-ary sums and products in a normal form, so that equal
// expressions are one node however they came about. Nodes are numbered in order of creation, every list of operands is
// sorted by number and nothing depends on an address, so that the same energy text gives the same graph in every
// process.
//
// Normal form
//   sum      constant + sum of coefficient*node; no zero coefficients, each node once, the first coefficient positive
//            (the sign moves out). "Scaled": one term, constant 0, coefficient not 1.
//   product  product of node^(num/den); each base once, no constant and no scaled sum among the bases.
// Sums within sums are kept (they may be shared); products within products are spliced (schedule() finds shared parts
// again).

#include <cstdint>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace ergon {

using NodeId = std::int32_t;

struct Term {
  double coefficient;
  NodeId node;
  bool operator==(const Term&) const = default;
};

// base^(num/den), in lowest terms, den > 0.
struct Factor {
  NodeId base;
  int num = 1;
  int den = 1;
  bool operator==(const Factor&) const = default;
};

// Functions of a graph. select(c, a, b) is a where c > 0, else b. keep(a) is a, as a value that nothing is simplified
// across: the author's own intermediate results that do not depend on the degrees of freedom, which are computed once
// and read.
// log1pmx(x) is log(1 + x) - x, expm1mx(x) is exp(x) - 1 - x, sinmx(x) is sin(x) - x, atanmx(x) is atan(x) - x, all
// without cancellation near 0.
enum class Call {
  log,
  exp,
  log1p,
  expm1,
  log1pmx,
  expm1mx,
  sinmx,
  atanmx,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  pow,
  abs,
  min,
  max,
  select,
  keep
};
const char* name_of(Call call);
// The function's value in double precision.
double evaluate(Call call, const std::vector<double>& arguments);

// Where an input comes from; its index counts within the kind. stretch: singular values of F; negative: what becomes of
// an eigenvalue x < 0, over -x: 0 or 1.
enum class Source { param, raw, point, q, stretch, negative };

struct Node {
  enum class Kind { constant, input, sum, product, call };
  Kind kind = Kind::constant;
  double constant = 0;  // a constant's value, or the constant term of a sum
  Source source = Source::param;
  int index = 0;
  std::vector<Term> terms;
  std::vector<Factor> factors;
  Call call = Call::log;
  std::vector<NodeId> arguments;
};

class Graph {
 public:
  NodeId constant(double value);
  NodeId input(Source source, int index);
  NodeId sum(double constant, std::vector<Term> terms);
  NodeId product(double coefficient, std::vector<Factor> factors);
  NodeId call(Call call, std::vector<NodeId> arguments);

  NodeId add(NodeId a, NodeId b) { return sum(0, {{1, a}, {1, b}}); }
  NodeId subtract(NodeId a, NodeId b) { return sum(0, {{1, a}, {-1, b}}); }
  NodeId scale(double c, NodeId a) { return sum(0, {{c, a}}); }
  NodeId multiply(NodeId a, NodeId b) { return product(1, {{a}, {b}}); }
  NodeId divide(NodeId a, NodeId b);
  NodeId power(NodeId a, int num, int den = 1) { return product(1, {{a, num, den}}); }

  const Node& operator[](NodeId id) const { return nodes_[static_cast<size_t>(id)]; }
  NodeId size() const { return static_cast<NodeId>(nodes_.size()); }
  bool is_constant(NodeId id) const { return (*this)[id].kind == Node::Kind::constant; }
  bool is_constant(NodeId id, double value) const { return is_constant(id) && (*this)[id].constant == value; }

  // node = coefficient*core, where core is not a scaled sum (a constant is its own core, with coefficient 1).
  Term unscaled(NodeId id) const;
  // The operands of a node, in its order.
  std::vector<NodeId> operands(NodeId id) const;

  // A name for printed and emitted code; the first one given stays.
  void set_name(NodeId id, const std::string& name);
  const std::string& name(NodeId id) const;

 private:
  NodeId intern(Node node);
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, std::vector<NodeId>> by_hash_;
  std::unordered_map<NodeId, std::string> names_;
};

// All nodes that the roots depend on, operands before users.
std::vector<NodeId> reachable(const Graph& graph, std::span<const NodeId> roots);

// One line per node that the roots depend on.
std::string to_string(const Graph& graph, std::span<const NodeId> roots);

// Throws std::logic_error naming the node when the normal form stated above does not hold.
void verify(const Graph& graph);

}  // namespace ergon
