#pragma once
// The graph evaluated in double precision, node by node: an oracle for what is emitted.

#include <vector>

#include "codegen/graph.h"

namespace ergon {

struct GraphInputs {
  std::vector<double> params{}, raw{}, points{}, q{}, stretch{}, negative{};
};

// The values of `wanted`. Throws std::out_of_range for an input that is not supplied.
std::vector<double> interpret(const Graph& graph, const std::vector<NodeId>& wanted, const GraphInputs& inputs);

}  // namespace ergon
