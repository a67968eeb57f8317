#pragma once
// The laws of an object on its mesh. It establishes what a scene supplies to any law: stencils of the kinds that the
// mesh has, their rest data and lags; which law asks for them makes no difference.

#include <vector>

#include "scenes/builder.h"
#include "scenes/fields.h"
#include "scenes/laws.h"
#include "scenes/used_kernels.h"

namespace ergon {

// One law of one object, checked.
struct UsedLaw {
  const Energy* declared;        // as the file has it, or with a weight
  const Energy* energy;          // the same with what varies over the mesh as data of its elements
  Parameters params;             // that do not vary over the mesh
  std::vector<LawField> fields;  // what varies, over the mesh or in time
  // Set by place_fields: values of those over the mesh, and of those in time.
  StencilData rest;
  std::map<std::string, TimedValues> timed;
  std::optional<double> constraint_tolerance{};
};

// Checks the params of a law that may be carried by the object's vertices, and makes what varies its data. Throws
// SourceError at the scene's line.
UsedLaw used_law(const Energy& energy, const EnergyUse& use, const SceneObject& object, Laws& laws);

// Evaluates what varies, at the sites of `place`. Throws SourceError as field_values does.
void place_fields(const FieldPlace& place, UsedLaw& law);

// Adds a potential of the law with all that the scene says of it: its index. Throws SourceError at the scene's line.
int add_law(const Scene& scene, const EnergyUse& use, const UsedLaw& law, Potential potential, BuiltScene& out);

// Reads the laws and their params. Throws SourceError at the scene's line unless objects can carry them: densities, and
// stencils of the kinds that meshes have, which always act, with rest data (rest positions, sizes of stencils as in
// runtime/mesh/mesh_stencils.h, the `mass` of a point) and lags (`dt`, `xhat`, `xlag`) that a scene supplies.
std::vector<UsedLaw> object_laws(const SceneObject& object, Laws& laws);

// Throws SourceError at the scene's line unless the cells of the body have what the laws live on.
void check_geometry(const SceneObject& object, const std::vector<UsedLaw>& laws, const Body& body);

// Evaluates what varies on the object's mesh. `folder` is what paths are relative to. Throws SourceError at the scene's
// line, or in a file of data, for values out of range and for data that do not fit the mesh.
void place_fields(const SceneObject& object, const Body& body, const std::string& folder, std::vector<UsedLaw>& laws);

// Adds the potentials of object `body` to a scene whose bodies, system, masses and start are known.
void add_object(const Scene& scene, const SceneObject& object, const std::vector<UsedLaw>& laws,
                const UsedKernels& kernels, size_t body, BuiltScene& out);

}  // namespace ergon
