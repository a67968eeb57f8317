#pragma once
// Products that share parts: which pairs of factors to multiply once.

#include <utility>
#include <vector>

namespace ergon {

// Each list is a product of atoms (numbers from 0 to atoms-1, with repetitions). Takes out the pair that the most lists
// contain, again and again, until no pair is in two lists. A pair that was taken out is a new atom; atom number atoms +
// k is the product of pairs[k]. Deterministic: ties go to the smallest pair.
std::vector<std::pair<int, int>> share_pairs(std::vector<std::vector<int>>& lists, int atoms);

}  // namespace ergon
