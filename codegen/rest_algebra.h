#pragma once
// An energy's text in the algebra of expansions about the rest state q = 0 (see symbolic/elaborate.h): every scalar s
// is
//   s = c + l + r,   c its value at rest, l linear in q, r the remainder, of second order in q,
// with c and the coefficients of l free of q. Sums and products expand by algebra, functions by forms of their change
// and of their remainder in which nothing cancels. Where c and l of an energy vanish, its remainder is the energy, and
// it is computed from small numbers only: neither it nor its gradient loses digits near rest.

#include <string>
#include <unordered_map>
#include <vector>

#include "codegen/graph_algebra.h"

namespace ergon {

class RestAlgebra {
 public:
  using Scalar = int;  // an expansion, by its number

  // A module of displacements whose graph receives all nodes.
  explicit RestAlgebra(Module& module);

  Scalar number(const std::string& decimal) { return fixed(graph_.number(decimal)); }
  Scalar add(Scalar a, Scalar b) { return sum(a, b, 1); }
  Scalar subtract(Scalar a, Scalar b) { return sum(a, b, -1); }
  Scalar multiply(Scalar a, Scalar b);
  Scalar divide(Scalar a, Scalar b);
  Scalar negate(Scalar a);
  Scalar power(Scalar a, long num, long den);
  Scalar power(Scalar a, Scalar b);
  Scalar call(Function f, const std::vector<Scalar>& arguments);
  Scalar input(const Symbol& symbol, int component);
  std::vector<Scalar> stretches(const Tensor<Scalar>& F);
  Scalar named(const std::string& let, int component, int size, Scalar a);

  // The scalar as its author wrote it.
  NodeId direct(Scalar s) const { return at(s).direct; }
  // Whether every operation that the scalar is made of has an expansion.
  bool expands(Scalar s) const { return at(s).op != Op::opaque; }
  // Whether only sums and products are in it, so that its expansion holds as well far from rest.
  bool polynomial(Scalar s) const { return at(s).polynomial; }
  NodeId at_rest(Scalar s) const { return at(s).c; }
  const std::vector<NodeId>& slope_at_rest(Scalar s) const { return at(s).l; }  // empty: zero
  // r; called once, for the scalar whose remainder is wanted.
  NodeId remainder(Scalar s);

 private:
  enum class Op {
    fixed,
    input,
    scale,
    sum,
    product,
    square,
    larger,
    reciprocal,
    root,
    power,
    log,
    exp,
    sin,
    cos,
    tan,
    atan,
    opaque
  };

  // An expansion. Its change d = c + l - value at rest and its remainder r become nodes when asked for.
  struct Part {
    Op op = Op::fixed;
    Scalar a = -1, b = -1;
    double sign = 1;       // of b in a sum
    int num = 1, den = 1;  // of a power
    NodeId direct = -1;
    NodeId c = -1;
    std::vector<NodeId> l;  // by component of q; empty when zero
    bool polynomial = true;
    std::string name;
    bool needs_remainder = false, needs_change = false;
    NodeId d = -1, r = -1;
  };

  Part& at(Scalar s) { return parts_[static_cast<size_t>(s)]; }
  const Part& at(Scalar s) const { return parts_[static_cast<size_t>(s)]; }
  Scalar append(Part part);
  Scalar fixed(NodeId node);
  Scalar opaque(NodeId direct);
  Scalar sum(Scalar a, Scalar b, double sign);
  Scalar scaled(NodeId factor, Scalar a, NodeId direct);
  Scalar larger(Scalar a, Scalar b, NodeId direct);
  Scalar function(Op op, Scalar a, NodeId direct, NodeId c, NodeId slope);
  bool is_fixed(Scalar s) const { return at(s).op == Op::fixed; }

  // Without the marks that keep an author's intermediate results, when that makes it a number: differences at rest
  // cancel exactly.
  NodeId settled(NodeId node);
  NodeId bare(NodeId node);
  std::vector<NodeId> combined(const std::vector<NodeId>& x, NodeId cx, const std::vector<NodeId>& y, NodeId cy);
  bool cancels(const Part& s) const;

  void need_remainder(Scalar s);
  void need_change(Scalar s);
  void spread_change(Scalar s);
  NodeId r_of(Scalar s);
  NodeId d_of(Scalar s);
  NodeId linear(Scalar s);
  NodeId changed(Scalar s);
  NodeId change_of_function(const Part& p);
  NodeId remainder_of_function(const Part& p);
  NodeId slope(const Part& p);
  NodeId ratio(const Part& p) { return g_.divide(d_of(p.a), at(p.a).c); }

  Module& module_;
  Graph& g_;
  GraphAlgebra graph_;
  std::vector<Part> parts_;
  std::unordered_map<NodeId, Scalar> by_direct_;
  std::vector<NodeId> bare_;
  std::vector<Scalar> changes_;  // asked for, not yet spread to operands
};

}  // namespace ergon
