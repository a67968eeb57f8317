#pragma once
// States at which every energy is tested: inputs drawn within the declared ranges, points and F from near rest to
// inverted.

#include <random>
#include <string>
#include <vector>

#include "symbolic/energy.h"
#include "symbolic/reference.h"

namespace ergon::testing {

struct State {
  std::string
      kind;  // "near rest", "random", "strongly deformed", "inverted", "in line" (three points and more, nearly)
  Inputs inputs;
};

// Several states of each kind in which all `require` and `active` conditions hold; a kind that the conditions exclude
// is left out. Throws when no state at all is found.
std::vector<State> draw_states(const Energy& energy, const std::string& case_name, unsigned seed);

// A rotation matrix, column by column.
std::vector<double> random_rotation(std::mt19937& random);

// R v for each column of a 3 x n array.
std::vector<double> rotated(const std::vector<double>& rotation, const std::vector<double>& columns);

}  // namespace ergon::testing
