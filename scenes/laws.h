#pragma once
// The energies that a scene uses: read once each, and their params checked against what the energy declares.

#include <map>
#include <string>

#include "runtime/potential.h"
#include "scenes/catalogue.h"
#include "scenes/scene.h"
#include "symbolic/energy.h"

namespace ergon {

// Reads energies on first use.
class Laws {
 public:
  Laws(const Catalogue& catalogue, std::string scene_folder)
      : catalogue_(&catalogue), scene_folder_(std::move(scene_folder)) {}

  // Throws SourceError at `place` when there is no such law, and at the energy's own place when the file is wrong.
  const Energy& get(const std::string& law, const Place& place);
  // The same of what an object names, or holds as text: then faults are at their line of the scene.
  const Energy& get(const EnergyUse& use);

 private:
  const Catalogue* catalogue_;
  std::string scene_folder_;
  std::map<std::string, Energy> read_;  // by the name or path that was written, or the place of the text
};

// The values of all params of the energy in SI. A param `h` in m that is left out is the thickness of the object, where
// that has one (not 0), in m. Throws SourceError at the scene's line for a param that is missing, unknown (with the
// nearest), of the wrong size or unit, or outside its declared range.
Parameters checked_params(const Energy& energy, const EnergyUse& use, double thickness);

}  // namespace ergon
