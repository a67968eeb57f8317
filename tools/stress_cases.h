#pragma once
// Scenes that try the solver: each is the same block of few cells, made difficult in one way.

#include <functional>
#include <string>
#include <vector>

#include "scenes/builder.h"

namespace ergon {

struct StressCase {
  std::string name;
  std::string scene;  // its text
  // Changes the first state, of which the rest shape knows nothing; may be empty.
  std::function<void(BuiltScene& built)> disturb = {};
  // What else must hold of the end, as a message that says what does not; "" where all is well. May be empty.
  std::function<std::string(const BuiltScene& built, const State& end)> judge = {};
  bool slow = false;  // takes more than a few seconds
};

// element: tet4, tet10 or hex27; of cases of membranes tri3, tri6 or quad9, which go with these.
std::vector<StressCase> stress_cases(const std::string& element);

// Scenes of the same motion, in metres and in millimetres: coordinates of the latter are 1000 times those of the
// former.
struct UnitPair {
  std::string metres, millimetres;
};
UnitPair stress_units(const std::string& element);

}  // namespace ergon
