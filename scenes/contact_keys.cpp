#include "scenes/contact_keys.h"

#include <algorithm>

#include "scenes/shape_keys.h"

namespace ergon {
namespace {

using namespace key_ranges;

Section<ContactPair> pair_section() {
  using T = ContactPair;
  Section<T> out{"[[contact.pair]]",
                 "What holds between two objects or obstacles, or within one, instead of what [contact] says.",
                 {},
                 {},
                 {}};
  out.keys = {
      text_key("first", &T::first, Need::required, "name of an object or obstacle"),
      text_key("second", &T::second, Need::required, "name of another, or the same"),
      boolean_key("ignore", &T::ignore, "they pass through each other"),
      number_key("mu", &T::mu, "1", not_negative, Need::optional, "coefficient of friction", "that of [contact]"),
      number_key("mu_kinetic", &T::mu_kinetic, "1", not_negative, Need::optional, "coefficient while sliding",
                 "`mu` of this pair, else that of [contact]"),
  };
  return out;
}

Section<ShapeKey> shape_section() {
  using T = ShapeKey;
  Section<T> out{
      "[[obstacle.shape]]",
      "A shape that the obstacle has taken at a time. Vertices go straight from the obstacle's own mesh at "
      "time 0 to the first shape, and on from one to the next; after the last one the shape stays. Keys move "
      "the whole of it.",
      {},
      {},
      {}};
  out.keys = {
      number_key("time", &T::time, "s", positive, Need::required, "after the start"),
      text_key("mesh", &T::mesh, Need::required,
               "mesh file relative to the scene, with the cells of the obstacle's own mesh in the same order; it is "
               "scaled, rotated and translated as that is"),
  };
  out.check = [](const std::string&, const T& shape) { check_mesh_ending(shape); };
  return out;
}

}  // namespace

Section<SceneObstacle> obstacle_section() {
  using T = SceneObstacle;
  Section<T> out{
      "[[obstacle]]",
      "A surface that others collide with, or are attached to, and that nothing moves but its script. Needs [contact] "
      "or an [[attachment]] to it.",
      {},
      {},
      {}};
  out.keys =
      shape_keys<T>("mesh file relative to the scene: a surface (.obj, .stl, .ply), open or closed, or cells (.msh)");
  out.keys.push_back(choice_key("element", &T::element, {"hex8", "tri3", "edge2"},
                                "of a box: the block, or without thickness its rectangle z = 0 or its edge along x"));
  out.keys.push_back(vector_key("center", &T::center, "m", any, Need::optional,
                                "what rotations of the script are about; moves along"));
  out.keys.push_back(tables_key("key", &T::motion, motion_section<T>, Need::optional, "script of its motion"));
  out.keys.push_back(tables_key("shape", &T::shapes, shape_section, Need::optional, "shapes that it takes in turn"));
  out.check = [](const std::string&, const T& obstacle) {
    check_shape(obstacle);
    if (!obstacle.shapes.empty() && !obstacle.wrote("mesh"))
      throw SourceError(obstacle.at("shape"), "'shape' needs a 'mesh': the shape at the start, from a file too");
    if (obstacle.wrote("element") && !obstacle.box)
      throw SourceError(obstacle.at("element"), "'element' has no use here: it is for an obstacle that is a box");
    check_motion(obstacle.motion);
    check_motion(obstacle.shapes);
  };
  return out;
}

Section<ContactSettings> contact_section() {
  using T = ContactSettings;
  Section<T> out{"[contact]",
                 "Surfaces of objects and obstacles collide, with one another and themselves. Without this table only "
                 "grounds act.",
                 {},
                 {},
                 {}};
  out.keys = {
      text_key("barrier", &T::barrier, Need::optional,
               "law of the barrier: name in the catalogue, or path of an .energy file relative to the scene"),
      number_key("dhat", &T::dhat, "m", positive, Need::optional, "gap at which barriers begin to act"),
      number_key("mu", &T::mu, "1", not_negative, Need::optional, "coefficient of friction; 0 leaves friction out"),
      number_key("mu_kinetic", &T::mu_kinetic, "1", not_negative, Need::optional, "coefficient while sliding", "`mu`"),
      number_key("epsv", &T::epsv, "m/s", positive, Need::optional, "sliding speed below which friction is static"),
      number_key("fall", &T::fall, "m/s", positive, Need::optional,
                 "by how much faster than `epsv` friction is down to `mu_kinetic`"),
      number_key("stiffness", &T::stiffness, "1", positive, Need::optional,
                 "kappa of the barriers, in the unit of their law", "chosen and adapted by the solver"),
      boolean_key("area_weights", &T::area_weights,
                  "stencils count by the area that they stand for, so that a finer mesh is not stiffer in contact; "
                  "`stiffness` is then per m^2"),
      tables_key("pair", &T::pairs, pair_section, Need::optional, "exceptions"),
  };
  return out;
}

void check_names(const Scene& scene) {
  std::map<std::string, std::pair<const char*, const Located*>> seen;
  std::vector<std::string> names;
  const auto add = [&](const char* kind, const SceneShape& shape) {
    auto [first, is_new] = seen.emplace(shape.name, std::pair(kind, &shape));
    names.push_back(shape.name);
    if (is_new) return;
    const auto& [other, place] = first->second;
    throw SourceError(shape.at("name"), fmt::format("the name '{}' is taken by the {} in line {}", shape.name, other,
                                                    place->at("name").line));
  };
  for (const SceneObject& object : scene.objects) add("object", object);
  for (const SceneObstacle& obstacle : scene.obstacles) add("obstacle", obstacle);
  std::map<std::string, const SceneProbe*> probes;
  for (const SceneProbe& probe : scene.probes) {
    const auto [first, is_new] = probes.emplace(probe.name, &probe);
    if (!is_new)
      throw SourceError(probe.at("name"), fmt::format("the name '{}' is taken by the probe in line {}", probe.name,
                                                      first->second->at("name").line));
    if (seen.count(probe.object) == 0 || seen[probe.object].first != std::string("object"))
      throw SourceError(probe.at("object"),
                        fmt::format("there is no object '{}'{}", probe.object, did_you_mean(probe.object, names)));
  }
  for (const SceneObstacle& obstacle : scene.obstacles) {
    const auto is_held_by_it = [&](const SceneAttachment& attachment) { return attachment.to == obstacle.name; };
    if (!scene.contact && std::none_of(scene.attachments.begin(), scene.attachments.end(), is_held_by_it))
      throw SourceError(
          obstacle.place,
          "an obstacle has no effect without contact; add the table [contact], or attach an object to it");
  }
  if (!scene.contact) return;
  for (const ContactPair& pair : scene.contact->pairs) {
    for (const auto& [key, name] : {std::pair("first", &pair.first), std::pair("second", &pair.second)})
      if (seen.count(*name) == 0)
        throw SourceError(pair.at(key),
                          fmt::format("there is no object or obstacle '{}'{}", *name, did_you_mean(*name, names)));
  }
}

}  // namespace ergon
