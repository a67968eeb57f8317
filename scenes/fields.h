#pragma once
// Params of an object's laws that vary over its mesh or in time: their values where the law needs them, each checked
// against the param's unit and range.

#include <string>
#include <vector>

#include "runtime/mesh/sites.h"
#include "runtime/potential.h"
#include "scenes/body.h"
#include "scenes/scene.h"
#include "symbolic/energy.h"

namespace ergon {

struct LawField {
  const Symbol* param = nullptr;  // of the energy as it is declared
  std::shared_ptr<const FieldValue> value;
  Place place;
  bool over_mesh() const { return !value->formula || value->formula->of_position(); }
  bool in_time() const { return value->formula && value->formula->of_time(); }
};

// The params of the energy that the scene gives by tables. Throws SourceError for a formula of another shape or unit
// than the param's, for values of regions as checked_values does, and for a region that the object does not declare.
std::vector<LawField> law_fields(const Energy& energy, const EnergyUse& use, const SceneObject& object);

// A law's place on a body: the mesh that it lives on, and where on it.
struct FieldPlace {
  const SceneObject* object = nullptr;
  const Body* body = nullptr;
  const Sites* sites = nullptr;
  std::string folder;  // that paths are relative to
};

// The values at the start of the run, one set for each site or, unless the field is over the mesh, one. Throws
// SourceError for values out of range, naming cell or vertex, and for a file that does not fit the mesh.
std::vector<double> field_values(const Energy& energy, const LawField& field, const FieldPlace& place);

// The same of a formula, as a function of time that holds all it needs.
TimedValues timed_values(const Energy& energy, const LawField& field, const FieldPlace& place);

}  // namespace ergon
