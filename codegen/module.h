#pragma once
// What the passes of compile.cpp hand from one to the next: an energy as a graph, and what is known of it so far.

#include <string>
#include <vector>

#include "codegen/graph.h"
#include "symbolic/energy.h"

namespace ergon {

struct Module {
  const Energy* energy = nullptr;
  std::string case_name;

  Graph graph;
  NodeId value = -1;           // J, or J per rest volume
  std::vector<NodeId> active;  // margins, positive where the condition holds
  std::vector<NodeId> require;
  std::vector<NodeId> update;  // components of Energy::updates, one after the other

  // Layout of the inputs: first component of every param in `params`, of rest and lag in the raw element data; symbols
  // in order of declaration, components column by column.
  std::vector<int> offsets;  // per symbol of the energy; a dof's offset counts the components of points
  int params = 0;
  int raw = 0;
  int points = 0;  // 0 for a density

  // Set by frontier(): q = (weights (x) I3) x, weights [q_vectors][points]; for a density q is F, or F - I, and weights
  // are empty.
  int q_vectors = 0;
  std::vector<double> weights;
  // Set by lower(): a density in principal stretches. q is then the q_vectors singular values of F, or those less 1
  // where `displacement` is set, and derivatives are with respect to these; F is diag(s).
  bool stretches = false;
  int q_size() const { return stretches ? q_vectors : 3 * q_vectors; }

  // Set by differentiate(): with respect to q; the lower triangle packed by rows.
  std::vector<NodeId> gradient;
  std::vector<NodeId> hessian;

  // Set by rest_form(): q is F - I, of a membrane or line in the axes of the element at rest. Where `near` is -1, value
  // holds everywhere; otherwise value (and its derivatives) serve states where near > 0, and `far` all others.
  bool displacement = false;
  NodeId near = -1;
  struct Far {
    NodeId value = -1;
    std::vector<NodeId> gradient, hessian;
  } far;

  // Set by find_structure().
  bool constant_gradient = false;
  bool constant_hessian = false;
  bool zero_hessian = false;
  bool psd_hessian = false;

  // Set by find_principal(); empty when there is no closed form.
  std::vector<NodeId> principal;

  // Set by find_closed_form(): the projected Hessian, packed like the Hessian, and what is positive where projection
  // changed it. Empty and -1 when none is known.
  std::vector<NodeId> projected;
  NodeId changed = -1;

  // Set by find_parts(): the part of each 3-vector of q, -1 for one that is in no entry of the Hessian. Empty: the
  // Hessian is whole; else it holds the entries within parts alone (codegen/parts.h).
  std::vector<int> parts;

  // Every node that something outside the graph refers to: value, conditions, gradient, Hessian, its projection.
  std::vector<NodeId> roots() const;
};

}  // namespace ergon
