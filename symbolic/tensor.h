#pragma once
// A scalar, vector or matrix over any kind of number.

#include <vector>

#include "symbolic/expression.h"

namespace ergon {

template <class S>
struct Tensor {
  Shape shape;
  std::vector<S> at;  // column by column
  const S& operator()(int row, int col = 0) const { return at[static_cast<size_t>(col * shape.rows + row)]; }
};

}  // namespace ergon
