#pragma once
// The known name that a typing error most likely meant.

#include <string>
#include <string_view>
#include <vector>

namespace ergon {

// The candidate with the smallest edit distance to `name`, ignoring capitals; empty when none is within a third of its
// length (at least one edit).
std::string nearest_of(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace ergon
