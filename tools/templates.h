#pragma once
// A first file of every kind of energy that the language knows: small, explained, and sound as it stands.

#include <string>
#include <vector>

namespace ergon {

struct EnergyTemplate {
  std::string kind;  // the geometry of a density, the stencil of an energy, "barrier" or "distance"
  std::string what;  // for people
  std::string text;  // the file, with NAME where its name stands
};

// One of every geometry and every stencil, in the order of the language, then a barrier and a distance.
const std::vector<EnergyTemplate>& energy_templates();

}  // namespace ergon
