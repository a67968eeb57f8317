#pragma once
// The energies that a scene uses: read once each, and their params checked against what the energy declares.

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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
  // The same of what an object names, or holds as text: then faults are at their line of the scene. With a `weight`
  // among its params where the scene gives one, and augmented where it gives its constraint a tolerance.
  const Energy& get(const EnergyUse& use);
  // An energy that get() gave with some params as data of every element (symbolic/varied.h); the same one for none.
  const Energy& vary(const Energy& energy, const std::vector<std::string>& params);

 private:
  const Energy& read(const EnergyUse& use);
  const Energy& make(const Energy& energy, const std::string& key, Energy (*made_of)(const Energy&));

  const Catalogue* catalogue_;
  std::string scene_folder_;
  std::map<std::string, Energy> read_;  // by the name or path that was written, or the place of the text
  std::map<std::pair<const Energy*, std::vector<std::string>>, Energy>
      made_;  // of these, by the params that vary; "*": with a weight; "0": augmented
};

// The values of all params of the energy in SI but those that vary. A param `h` in m that is left out is the thickness
// of the object, where that has one (not 0), in m. Throws SourceError at the scene's line for a param that is missing,
// unknown (with the nearest), of the wrong size or unit, or outside its declared range.
Parameters checked_params(const Energy& energy, const EnergyUse& use, double thickness);

// What the constraint of an energy that get() gave is kept to, in SI; nothing where the scene does not say. Throws
// SourceError as checked_params does.
std::optional<double> constraint_tolerance(const Energy& energy, const EnergyUse& use);

// The values written for one param, in SI, checked as above.
std::vector<double> checked_values(const Energy& energy, const Symbol& param, const ParamValue& written);
// Throws SourceError at `place` where a value is outside of the param's range; `where` names the value: " in cell 3".
void check_range(const Energy& energy, const Symbol& param, double value, const Place& place, const std::string& where);

}  // namespace ergon
