#include "scenes/build_contact.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/contact/area_weights.h"
#include "runtime/contact/make_surface.h"
#include "runtime/error.h"

namespace ergon {
namespace {

Eigen::Vector3d vector(const Vector3& v) { return {v[0], v[1], v[2]}; }

// The distance and case of a barrier, by ContactKind.
struct BarrierPart {
  const char* distance;
  const char* case_name;
};
constexpr std::array<BarrierPart, kContactKinds> barrier_parts = {{{"point_point", ""},
                                                                   {"point_edge", ""},
                                                                   {"point_triangle", ""},
                                                                   {"edge_edge", "line"},
                                                                   {"edge_edge", "point_edge"},
                                                                   {"edge_edge", "point_point"}}};

// Contact gives a barrier its activation distance and stiffness, and knows no other params.
void check_barrier(const Energy& energy, const Place& place) {
  for (const Symbol* param : energy.with_role(Role::param))
    if (param->name != "dhat")
      throw SourceError(place, fmt::format("{} has the param '{}'; a barrier of [contact] has 'dhat' alone",
                                           energy.name, param->name));
  for (const char* name : {"dhat", "kappa"})
    if (energy.find(name) == nullptr)
      throw SourceError(place,
                        fmt::format("{} lacks {}; a barrier of [contact] has the param 'dhat' and the lag 'kappa'",
                                    energy.name, name));
}

bool has_offset(const Scene& scene) {
  const auto thick = [](const SceneShape& shape) { return shape.offset > 0; };
  return std::any_of(scene.objects.begin(), scene.objects.end(), thick) ||
         std::any_of(scene.obstacles.begin(), scene.obstacles.end(), thick);
}

void add_grounds(const Scene& scene, const ContactLaws& laws, const UsedKernels& kernels, BuiltScene& out) {
  GroundLaws loaded;
  loaded.barrier = kernels.get(*laws.ground);
  if (laws.friction != nullptr) {
    loaded.friction = kernels.get(*laws.friction);
    loaded.friction_secant = kernels.get(*laws.friction_secant);
  }
  std::vector<Ground> grounds;
  for (const SceneGround& g : scene.grounds)
    grounds.push_back({vector(g.normal), g.height, g.dhat, g.mu, g.epsv, g.stiffness.value_or(0)});
  std::vector<int> surface;
  for (const Body& body : out.bodies)
    for (int vertex : body.surface) surface.push_back(body.first_vertex + vertex);
  auto ground = std::make_unique<GroundContact>(*out.system, grounds, loaded, surface, out.start.x,
                                                out.mass_of_points(), vector(scene.gravity));
  out.ground = ground.get();
  out.contacts->add(std::move(ground));
}

// Objects, then obstacles, as bodies are.
const SceneShape& shape_of(const Scene& scene, size_t body) {
  if (body < scene.objects.size()) return scene.objects[body];
  return scene.obstacles[body - scene.objects.size()];
}

CollisionSurface collision_surface(const Scene& scene, const BuiltScene& built) {
  std::vector<CollisionObject> objects;
  for (size_t b = 0; b < built.bodies.size(); ++b) {
    const SceneShape& shape = shape_of(scene, b);
    objects.push_back({shape.name, &built.bodies[b].ordered, built.bodies[b].first_vertex, shape.offset});
  }
  std::vector<char> moving(static_cast<size_t>(built.system->vertices()), 1);
  for (int v = 0; v < built.system->vertices(); ++v) moving[static_cast<size_t>(v)] = built.system->moves(v);
  for (const int v : built.script.vertices()) moving[static_cast<size_t>(v)] = 1;
  CollisionSurface surface = make_surface(objects, std::move(moving));
  for (size_t b = 0; b < built.bodies.size(); ++b)
    surface.meet[b][b] = shape_of(scene, b).touches_itself && !built.bodies[b].affine();
  return surface;
}

void add_surfaces(const Scene& scene, const ContactLaws& laws, const UsedKernels& kernels, BuiltScene& out) {
  const ContactSettings& contact = *scene.contact;
  CollisionSurface surface = collision_surface(scene, out);
  SurfaceContactOptions options;
  options.dhat = contact.dhat;
  options.epsv = contact.epsv;
  options.stiffness = contact.stiffness.value_or(0);
  if (contact.area_weights) weight_by_area(surface, out.start.x, contact.dhat);
  const size_t objects = surface.names.size();
  options.fall = contact.fall;
  if (laws.friction != nullptr && has_friction(contact))
    options.friction.assign(
        objects, std::vector<FrictionCoefficients>(objects, {contact.mu, contact.mu_kinetic.value_or(contact.mu)}));
  const auto index = [&](const std::string& name) {
    return static_cast<size_t>(std::find(surface.names.begin(), surface.names.end(), name) - surface.names.begin());
  };
  for (const ContactPair& pair : contact.pairs) {
    const size_t a = index(pair.first), b = index(pair.second);
    if (pair.ignore) surface.meet[a][b] = surface.meet[b][a] = 0;
    if (options.friction.empty()) continue;
    FrictionCoefficients& both = options.friction[a][b];
    if (pair.mu) both = {*pair.mu, *pair.mu};
    if (pair.mu_kinetic) both.sliding = *pair.mu_kinetic;
    options.friction[b][a] = both;
  }
  lower_offsets(surface, out.start.x, contact.dhat);
  SurfaceLaws loaded;
  for (size_t kind = 0; kind < kContactKinds; ++kind)
    loaded.barrier[kind] = kernels.get(*laws.surface[kind], barrier_parts[kind].case_name);
  if (laws.friction != nullptr) {
    loaded.friction = kernels.get(*laws.friction);
    loaded.friction_secant = kernels.get(*laws.friction_secant);
  }
  std::unique_ptr<SurfaceContact> surfaces;
  try {
    surfaces = std::make_unique<SurfaceContact>(*out.system, std::move(surface), loaded, options, out.start.x,
                                                out.mass_of_points(), vector(scene.gravity));
  } catch (const InputError& bad) {
    throw SourceError(contact.at("barrier"), bad.what());
  }
  out.surfaces = surfaces.get();
  out.contacts->add(std::move(surfaces));
}

}  // namespace

bool has_friction(const ContactSettings& contact) {
  return contact.mu > 0 || std::any_of(contact.pairs.begin(), contact.pairs.end(),
                                       [](const ContactPair& pair) { return pair.mu.value_or(0) > 0; });
}

ContactLaws contact_laws(const Scene& scene, Laws& laws, std::vector<std::string>& skipped) {
  const Place whole{scene.file, 0, 0};
  ContactLaws out;
  if (scene.grounds.empty())
    skipped.push_back("ground contact: there is no ground, no kernel loaded");
  else
    out.ground = &laws.get("log_barrier:half_space", whole);
  if (!scene.contact) {
    skipped.push_back("surface contact: the scene has no [contact], no kernels loaded");
  } else {
    const Place& place = scene.contact->at("barrier");
    for (size_t kind = 0; kind < kContactKinds; ++kind) {
      const std::string name =
          scene.contact->barrier + ":" + barrier_parts[kind].distance + (has_offset(scene) ? ":offset" : "");
      out.surface[kind] = &laws.get(name, place);
      check_barrier(*out.surface[kind], place);
    }
  }
  const bool friction =
      (scene.contact && has_friction(*scene.contact)) ||
      std::any_of(scene.grounds.begin(), scene.grounds.end(), [](const SceneGround& g) { return g.mu > 0; });
  if (friction) {
    out.friction = &laws.get("friction", whole);
    out.friction_secant = &laws.get("friction_secant", whole);
  } else {
    skipped.push_back("friction: nothing has a coefficient of friction 'mu', no kernel loaded");
  }
  return out;
}

void want_kernels(const ContactLaws& laws, UsedKernels& kernels) {
  kernels.want(laws.ground);
  kernels.want(laws.friction);
  kernels.want(laws.friction_secant);
  for (size_t kind = 0; kind < kContactKinds; ++kind) kernels.want(laws.surface[kind], barrier_parts[kind].case_name);
}

void add_contact(const Scene& scene, const ContactLaws& laws, const UsedKernels& kernels, BuiltScene& out) {
  if (scene.grounds.empty() && !scene.contact) return;
  out.contacts = std::make_unique<Contacts>();
  if (!scene.grounds.empty()) add_grounds(scene, laws, kernels, out);
  if (scene.contact) add_surfaces(scene, laws, kernels, out);
}

}  // namespace ergon
