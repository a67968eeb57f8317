#include "scenes/attachment_keys.h"

#include <algorithm>

#include "scenes/energy_keys.h"
#include "scenes/shape_keys.h"

namespace ergon {
namespace {

using namespace key_ranges;
using T = SceneAttachment;

// A key of the law is one of the attachment.
Key<T> key_of_law(const Key<EnergyUse>& key) {
  Key<T> out;
  out.text = key.text;
  out.read = [read = key.read](const toml::node& node, const std::string& file, T& attachment) {
    read(node, file, attachment);
  };
  return out;
}

void check_box(const T& attachment, const char* lower, const char* upper, const Vector3& min, const Vector3& max) {
  for (size_t axis = 0; axis < 3; ++axis)
    if (min[axis] > max[axis])
      throw SourceError(attachment.at(upper), fmt::format("'{}' is below '{}' along axis {}: {} m < {} m", upper, lower,
                                                          "xyz"[axis], max[axis], min[axis]));
}

void check_attachment(T& attachment) {
  if (attachment.wrote("law") && attachment.wrote("text"))
    throw SourceError(attachment.at("text"),
                      "'law' and 'text' are two ways to say which energy; leave one of them out");
  if (attachment.to_space())
    for (const char* key : {"at", "within", "to_min", "to_max"})
      if (attachment.wrote(key))
        throw SourceError(attachment.at(key),
                          fmt::format("'{}' has no use without 'to': the vertices are held where they start", key));
  if (attachment.to_place())
    for (const char* key : {"within", "to_min", "to_max"})
      if (attachment.wrote(key))
        throw SourceError(
            attachment.at(key),
            fmt::format("'{}' has no use here: at = \"place\" joins each to its own place, which then moves "
                        "with '{}'",
                        key, attachment.to));
  if (attachment.to_place() && attachment.to == attachment.object)
    throw SourceError(attachment.at("to"),
                      fmt::format("places of '{}' would be attached to themselves; name another body", attachment.to));
  if (attachment.wrote("places") && (attachment.wrote("min") || attachment.wrote("max")))
    throw SourceError(attachment.at("places"),
                      "'places' and a box are two ways to say what is joined; leave one of them out");
  if (!attachment.to_space() && !attachment.to_place() && !attachment.wrote("within"))
    throw SourceError(attachment.place,
                      fmt::format("[[attachment]] lacks the key 'within': how far from '{}' the vertices may be at the "
                                  "start, in m",
                                  attachment.to));
  check_box(attachment, "min", "max", attachment.min, attachment.max);
  check_box(attachment, "to_min", "to_max", attachment.to_min, attachment.to_max);
  if (!attachment.wrote("law") && !attachment.wrote("text"))
    attachment.law = attachment.to_space()     ? "attachment"
                     : attachment.to_surface() ? "pinned_to_triangle"
                                               : "joined_points";
}

}  // namespace

Section<SceneAttachment> attachment_section() {
  Section<T> out{
      "[[attachment]]",
      "Joins the vertices of an object that are in a box at the start (after scale, rotate and translate): each to the "
      "place where it starts; or, with 'to', to what is nearest at the start of another object, of an obstacle, or of "
      "the same object. What is joined stays joined, and does not slide. Every other key is a param of the law. "
      "Contact does not know of it: where [contact] acts, what touches where it is joined needs a [[contact.pair]] "
      "with "
      "`ignore`, or to be joined across a gap wider than `dhat` by a law that keeps it, as held_above_triangle does.",
      {},
      {},
      {}};
  out.keys = {
      text_key("object", &T::object, Need::required, "name of the object whose vertices are joined"),
      vector_key("min", &T::min, "m", with_infinity, Need::optional, "lower corner of the box"),
      vector_key("max", &T::max, "m", with_infinity, Need::optional, "upper corner"),
      points_key(
          "places", &T::places, "m", Need::optional,
          "in place of a box of vertices, points at the start that move with the object, which is affine: one is "
          "a ball joint, two a hinge about the line through them",
          "none"),
      text_key("to", &T::to, Need::optional, "name of the object or obstacle that they are joined to",
               "the places in space where they start"),
      choice_key("at", &T::joined_at, {"point", "surface", "place"},
                 "of what `to` names: its nearest vertex; or the nearest place on its surface, between the corners of "
                 "a triangle; "
                 "or, of an affine body or an obstacle, the very place where the vertex is, which then moves with "
                 "that, across "
                 "whatever gap"),
      number_key("within", &T::within, "m", positive, Need::optional,
                 "largest distance at the start; a vertex in the box that has nothing so near is an error",
                 "required with `to`, unless at a place"),
      vector_key(
          "to_min", &T::to_min, "m", with_infinity, Need::optional,
          "lower corner of a box: only vertices of `to` in it, or triangles that are wholly in it, are joined to"),
      vector_key("to_max", &T::to_max, "m", with_infinity, Need::optional, "upper corner"),
  };
  for (const Key<EnergyUse>& key : energy_section().keys) out.keys.push_back(key_of_law(key));
  for (Key<T>& key : out.keys) {
    if (key.text.name != "law") continue;
    key.text.fallback = "attachment, joined_points or pinned_to_triangle, as `to` and `at` ask";
    key.text.help =
        "law of each joint: an energy of a point that has the lag target[3] (m), where the vertex starts; with `to` of "
        "a point_point or edge, the vertex first; at a surface of a point_triangle, which may have the rest data w1 "
        "and w2 (weights of the second and third corner in the place) and h (m, how far the vertex is above it along "
        "the triangle's normal), as that of an edge L (m), the distance. Name in the catalogue, or path of an .energy "
        "file relative to the scene";
  }
  out.other = [](const toml::key& key, const toml::node& node, const std::string& file, T& attachment) {
    attachment.params[std::string(key.str())] = read_param(key, node, file);
  };
  out.check = [](const std::string&, T& attachment) { check_attachment(attachment); };
  return out;
}

void check_attachments(const Scene& scene) {
  std::vector<std::string> objects, all;
  for (const SceneObject& object : scene.objects) objects.push_back(object.name);
  all = objects;
  for (const SceneObstacle& obstacle : scene.obstacles) all.push_back(obstacle.name);
  const auto has = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const SceneAttachment& attachment : scene.attachments) {
    if (!has(objects, attachment.object) && has(all, attachment.object))
      throw SourceError(
          attachment.at("object"),
          fmt::format("'{}' is an obstacle, which nothing moves; an object is attached to it: to = \"{}\"",
                      attachment.object, attachment.object));
    if (!has(objects, attachment.object))
      throw SourceError(attachment.at("object"), fmt::format("there is no object '{}'{}", attachment.object,
                                                             did_you_mean(attachment.object, objects)));
    if (!attachment.to_space() && !has(all, attachment.to))
      throw SourceError(attachment.at("to"), fmt::format("there is no object or obstacle '{}'{}", attachment.to,
                                                         did_you_mean(attachment.to, all)));
  }
}

}  // namespace ergon
