#pragma once
// Sums of products with their common factors taken out.

#include "codegen/graph.h"

namespace ergon {

// constant + sum of terms, equal to graph.sum() but with the factor that most terms share taken out, again and again:
// a*b*c - a*d*e + f becomes a*(b*c - d*e) + f. Ties go to the younger node (the more complex expression).
NodeId factored_sum(Graph& graph, double constant, std::vector<Term> terms);

}  // namespace ergon
