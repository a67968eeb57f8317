#include "scenes/object_laws.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/error.h"
#include "runtime/mesh/mesh_stencils.h"
#include "runtime/mesh/rod_frames.h"
#include "scenes/law_checks.h"
#include "symbolic/augmented.h"

namespace ergon {
namespace {

bool is_mass(const Energy& energy, const Symbol& rest) {
  return energy.geometry == "point" && rest.name == "mass" && rest.shape.scalar() && to_string(rest.unit) == "kg";
}

// What a rod that twists has beside lengths.
bool is_of_rod(const Energy& energy, const Symbol& rest) {
  if (energy.geometry != "rod_corner") return false;
  if (rest.name == "d0" || rest.name == "T0" || rest.name == "T1")
    return rest.shape == Shape{3, 1} && rest.unit.dimensionless();
  return rest.shape.scalar() &&
         ((rest.name == "r" && to_string(rest.unit) == "m") || (rest.name == "twist0" && rest.unit.dimensionless()));
}

std::string unit_of(const RestSize& size) {
  if (size.dimension() == 0) return "1";
  return size.dimension() == 1 ? "m" : fmt::format("m^{}", size.dimension());
}

bool is_size(const RestSize& size, const Symbol& rest) {
  return rest.name == size.name && rest.shape.scalar() && to_string(rest.unit) == unit_of(size);
}

// What a scene knows of a stencil of this kind, for messages.
std::string known_rest_data(const std::string& kind) {
  std::vector<std::string> known = {"rest positions (X0[3] for a dof x0)"};
  if (kind == "point") known.emplace_back("mass (kg)");
  if (kind == "rod_corner") known.insert(known.end(), {"T0[3], T1[3] and d0[3] (1)", "twist0 (1)", "r (m)"});
  for (const RestSize& size : rest_sizes(kind)) known.push_back(fmt::format("{} ({})", size.name, unit_of(size)));
  return listed(known);
}

void check_rest_data(const Energy& energy, const Place& place) {
  const std::vector<RestSize> sizes = rest_sizes(energy.geometry);
  for (const Symbol* rest : energy.with_role(Role::rest)) {
    const auto is_it = [&](const RestSize& size) { return is_size(size, *rest); };
    if (is_mass(energy, *rest) || is_rest_position(energy, *rest) || is_of_rod(energy, *rest) ||
        std::any_of(sizes.begin(), sizes.end(), is_it))
      continue;
    throw SourceError(
        place, fmt::format("a scene cannot supply the rest data '{}' ({}{}) of {}; of a {} it knows {}", rest->name,
                           rest->shape.scalar() ? "" : to_string(rest->shape) + " in ", to_string(rest->unit),
                           energy.name, energy.geometry, known_rest_data(energy.geometry)));
  }
}

void check_supported(const Energy& energy, const Place& place) {
  if (energy.kind == Energy::Kind::density) return check_lags(energy, place);
  const std::vector<std::string> kinds = stencil_kinds();
  if (std::find(kinds.begin(), kinds.end(), energy.geometry) == kinds.end())
    throw SourceError(place, fmt::format("{} is an energy of a {}; an object carries densities, and energies of a {}",
                                         energy.name, energy.geometry, listed(kinds)));
  check_always_acts(energy, place, "an object");
  check_rest_data(energy, place);
  check_lags(energy, place);
}

StencilData rod_data(const Energy& energy, const std::vector<int>& stencils, const Body& body) {
  StencilData out;
  const auto wants = [&](const char* name) { return energy.find(name) && energy.find(name)->role == Role::rest; };
  const size_t count = stencils.size() / 5;
  if (wants("r")) out["r"].assign(count, body.gyration);
  if (wants("twist0")) out["twist0"] = frame_turns(body.ordered, stencils, body.axes);
  const auto append = [](std::vector<double>& to, const Eigen::Vector3d& v) {
    to.insert(to.end(), v.begin(), v.end());
  };
  for (size_t i = 0; i < count; ++i) {
    const int* points = &stencils[5 * i];
    const auto direction = [&](int from, int to) {
      return Eigen::Vector3d((body.ordered.X.col(points[to]) - body.ordered.X.col(points[from])).normalized());
    };
    if (wants("d0")) append(out["d0"], body.axes[static_cast<size_t>(points[3] - body.ordered.vertices())]);
    if (wants("T0")) append(out["T0"], direction(0, 1));
    if (wants("T1")) append(out["T1"], direction(1, 2));
  }
  return out;
}

// How many of the points of a stencil are vertices of the mesh: without twists of edges and tips of normals.
int place_count(const Energy& energy) {
  if (energy.geometry == "shell_triangle") return 3;
  return points_of_stencil(energy.geometry) - twists_of_stencil(energy.geometry);
}

std::vector<int> places_of(const Energy& energy, const std::vector<int>& stencils) {
  const int points = points_of_stencil(energy.geometry), places = place_count(energy);
  std::vector<int> out;
  for (size_t i = 0; i < stencils.size(); ++i)
    if (static_cast<int>(i) % points < places) out.push_back(stencils[i]);
  return out;
}

// The stencils are numbered as in the body's mesh. `mass`: kg, of the vertices of the scene.
StencilData rest_data(const Energy& energy, const std::vector<int>& stencils, const Body& body,
                      const Eigen::VectorXd& mass) {
  StencilData out;
  const std::vector<RestSize> sizes = rest_sizes(energy.geometry);
  if (energy.geometry == "rod_corner") out = rod_data(energy, stencils, body);
  for (const Symbol* rest : energy.with_role(Role::rest)) {
    if (is_mass(energy, *rest))
      for (const int vertex : stencils) out["mass"].push_back(mass[body.first_vertex + vertex]);
    for (const RestSize& size : sizes)
      if (is_size(size, *rest)) out[size.name] = rest_size_of(size, energy.geometry, stencils, body.ordered);
  }
  return out;
}

Potential object_potential(const UsedLaw& law, const Kernel& kernel, const Body& body, const BuiltScene& built) {
  const Energy& energy = *law.declared;
  if (energy.kind == Energy::Kind::density)
    return Potential::on_mesh(energy.name, kernel, body.ordered, body.first_vertex, law.params, body.quadrature,
                              law.rest);
  std::vector<int> stencils = stencils_on_mesh(energy.geometry, body.ordered);
  // Weights are in proportion to shares of mass, also to negative ones; what is curved needs masses above 0.
  StencilData rest = rest_data(energy, stencils, body, kernel->zero_hessian ? built.mass_shares() : built.mass);
  for (int& vertex : stencils) vertex = body.in_scene(vertex);
  rest.insert(law.rest.begin(), law.rest.end());
  return Potential::on_stencils(energy.name, kernel, stencils, built.start.x, law.params, rest);
}

}  // namespace

UsedLaw used_law(const Energy& energy, const EnergyUse& use, const SceneObject& object, Laws& laws) {
  check_damping(energy, use);
  UsedLaw law{&energy,
              &energy,
              checked_params(energy, use, object.thickness),
              law_fields(energy, use, object),
              {},
              {},
              constraint_tolerance(energy, use)};
  std::vector<std::string> over_mesh;
  for (const LawField& field : law.fields)
    if (field.over_mesh()) over_mesh.push_back(field.param->name);
  law.energy = &laws.vary(energy, over_mesh);
  return law;
}

std::vector<UsedLaw> object_laws(const SceneObject& object, Laws& laws) {
  std::vector<UsedLaw> out;
  for (const EnergyUse& use : object.energies) {
    const Energy& energy = laws.get(use);
    check_supported(energy, use.at("law"));
    out.push_back(used_law(energy, use, object, laws));
  }
  return out;
}

void check_geometry(const SceneObject& object, const std::vector<UsedLaw>& laws, const Body& body) {
  constexpr const char* geometries[] = {"point", "line", "membrane", "solid"};
  const Element element = body.ordered.element;
  const std::string geometry = geometries[dimension_of(element)];
  const std::vector<std::string> kinds = stencil_kinds(element);
  for (size_t k = 0; k < laws.size(); ++k) {
    const Energy& energy = *laws[k].energy;
    const Place& place = object.energies[k].at("law");
    if (energy.kind == Energy::Kind::density) {
      if (energy.geometry == geometry) continue;
      throw SourceError(place, fmt::format("{} is a density of a {}; object '{}' is a {} of {} cells", energy.name,
                                           energy.geometry, body.name, geometry, name_of(element)));
    }
    if (std::find(kinds.begin(), kinds.end(), energy.geometry) != kinds.end()) continue;
    throw SourceError(place, fmt::format("{} is an energy of a {}, which {} cells have; object '{}' is made of {} "
                                         "cells, which have those of a {}",
                                         energy.name, energy.geometry, elements_with(energy.geometry), body.name,
                                         name_of(element), listed(kinds)));
  }
}

void place_fields(const FieldPlace& place, UsedLaw& law) {
  const Energy& energy = *law.declared;
  for (const LawField& field : law.fields) {
    (field.over_mesh() ? law.rest : law.params)[field.param->name] = field_values(energy, field, place);
    if (field.in_time()) law.timed[field.param->name] = timed_values(energy, field, place);
  }
}

void place_fields(const SceneObject& object, const Body& body, const std::string& folder, std::vector<UsedLaw>& laws) {
  for (UsedLaw& law : laws) {
    if (law.fields.empty()) continue;
    const Energy& energy = *law.declared;
    const Sites sites =
        energy.kind == Energy::Kind::density
            ? sites_of_cells(body.ordered, body.quadrature)
            : sites_of_stencils(body.ordered, places_of(energy, stencils_on_mesh(energy.geometry, body.ordered)),
                                place_count(energy));
    place_fields({&object, &body, &sites, folder}, law);
  }
}

int add_law(const Scene& scene, const EnergyUse& use, const UsedLaw& law, Potential potential, BuiltScene& out) {
  for (const auto& [name, values] : law.timed) potential.follow(name, values);
  const int index = out.system->add(std::move(potential));
  if (use.stiffness_damping > 0) out.system->damp(index, use.stiffness_damping);
  if (law.constraint_tolerance)
    out.constraints.push_back(
        {index, *law.constraint_tolerance, to_string(constraint_of(*law.energy)->expression->unit)});
  const std::string& param = law.declared->load;
  if (param.empty()) return index;
  const auto is_it = [&](const LawField& field) { return field.param->name == param; };
  const auto field = std::find_if(law.fields.begin(), law.fields.end(), is_it);
  if (scene.time.quasi_static() && field != law.fields.end())
    throw SourceError(field->place,
                      fmt::format("'{}' of {} grows with the load of a quasi-static scene: give it as one "
                                  "number, and let 'weight' vary",
                                  param, law.energy->name));
  if (field == law.fields.end()) add_load(scene, index, param, law.params.at(param), out);
  return index;
}

void add_object(const Scene& scene, const SceneObject& object, const std::vector<UsedLaw>& laws,
                const UsedKernels& kernels, size_t body, BuiltScene& out) {
  for (size_t i = 0; i < laws.size(); ++i) try {
      const Kernel& kernel = kernels.get(*laws[i].energy);
      add_law(scene, object.energies[i], laws[i], object_potential(laws[i], kernel, out.bodies[body], out), out);
    } catch (const InputError& bad) {
      throw SourceError(object.energies[i].place, fmt::format("object '{}': {}", object.name, bad.what()));
    }
}

}  // namespace ergon
