#include "scenes/build_attachment.h"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/error.h"
#include "runtime/mesh/mesh_tools.h"
#include "runtime/mesh/nearest_place.h"
#include "scenes/attachment_keys.h"
#include "scenes/law_checks.h"

namespace ergon {
namespace {

Eigen::Vector3d vector(const Vector3& v) { return {v[0], v[1], v[2]}; }

std::string brackets(const Eigen::Vector3d& v) { return fmt::format("[{:.4g}, {:.4g}, {:.4g}] m", v[0], v[1], v[2]); }

// What the law of a joint may live on, and the rest data that it may have beside rest positions.
struct JointKind {
  const char* what;
  std::vector<std::string> stencils;
};

JointKind kind_of(const SceneAttachment& attachment) {
  if (attachment.to_space()) return {"an attachment to places in space", {"point"}};
  if (attachment.to_surface()) return {"an attachment to a surface", {"point_triangle"}};
  if (attachment.to_place()) return {"an attachment to places of a body", {"point_point"}};
  return {"an attachment to vertices", {"point_point", "edge"}};
}

// Names and units of the numbers that a scene knows of a joint.
std::vector<std::pair<std::string, std::string>> sizes_of(const std::string& stencil) {
  if (stencil == "point_triangle") return {{"w1", "1"}, {"w2", "1"}, {"h", "m"}};
  if (stencil == "edge") return {{"L", "m"}};
  return {};
}

bool is_target(const Symbol& lag) {
  return lag.name == "target" && lag.shape == Shape{3, 1} && to_string(lag.unit) == "m";
}

bool has_target(const Energy& energy) {
  const std::vector<const Symbol*> lags = energy.with_role(Role::lag);
  return energy.geometry == "point" &&
         std::any_of(lags.begin(), lags.end(), [](const Symbol* lag) { return is_target(*lag); });
}

void check_rest(const Energy& energy, const Place& place) {
  const auto sizes = sizes_of(energy.geometry);
  for (const Symbol* rest : energy.with_role(Role::rest)) {
    const std::pair<std::string, std::string> own{rest->name, to_string(rest->unit)};
    const bool known = rest->shape.scalar() && std::find(sizes.begin(), sizes.end(), own) != sizes.end();
    if (known || is_rest_position(energy, *rest)) continue;
    std::vector<std::string> names = {"rest positions (X0[3] for a dof x0)"};
    for (const auto& [name, unit] : sizes) names.push_back(fmt::format("{} ({})", name, unit));
    throw SourceError(
        place, fmt::format("a scene cannot supply the rest data '{}' ({}{}) of {}; of a {} that joins it knows {}",
                           rest->name, rest->shape.scalar() ? "" : to_string(rest->shape) + " in ",
                           to_string(rest->unit), energy.name, energy.geometry, listed(names)));
  }
}

void check_law(const Energy& energy, const SceneAttachment& attachment) {
  const Place& place = attachment.at("law");
  const auto [what, stencils] = kind_of(attachment);
  if (energy.kind == Energy::Kind::density ||
      std::find(stencils.begin(), stencils.end(), energy.geometry) == stencils.end())
    throw SourceError(place, fmt::format("{} is {} of a {}; {} takes an energy of a {}", energy.name,
                                         energy.kind == Energy::Kind::density ? "a density" : "an energy",
                                         energy.geometry, what, fmt::join(stencils, " or ")));
  check_always_acts(energy, place, "an attachment");
  check_rest(energy, place);
  check_lags(energy, place, has_target(energy) ? std::vector<std::string>{"target"} : std::vector<std::string>{});
}

// A key that is neither one of the table nor a param of the law, and near one of the table.
void check_keys(const Energy& energy, const SceneAttachment& attachment) {
  std::vector<std::string> keys;
  for (const KeyText& key : text_of(attachment_section()).keys) keys.push_back(key.name);
  for (const auto& [name, written] : attachment.params) {
    const Symbol* param = energy.find(name);
    const std::string meant = did_you_mean(name, keys);
    if (meant.empty() || (param != nullptr && param->role == Role::param)) continue;
    throw SourceError(written.key_place, fmt::format("unknown key '{}' in [[attachment]]{}", name, meant));
  }
}

size_t object_index(const Scene& scene, const std::string& name) {
  const auto is_it = [&](const SceneObject& object) { return object.name == name; };
  return static_cast<size_t>(std::find_if(scene.objects.begin(), scene.objects.end(), is_it) - scene.objects.begin());
}

// Names are those of bodies.
template <class Bodies>
auto& body_named(Bodies& bodies, const std::string& name) {
  return *std::find_if(bodies.begin(), bodies.end(), [&](const Body& body) { return body.name == name; });
}

std::string reach_of(const Body& body) {
  const auto bounds = bounding_box(body.ordered);
  return fmt::format("'{}', which reaches from {} to {}", body.name, brackets(bounds.col(0)), brackets(bounds.col(1)));
}

// What is joined to something.
struct JointEnd {
  int own;     // vertex of the body's mesh; -1: a place
  int vertex;  // of the scene
  Eigen::Vector3d x;

  std::string text(const Body& body) const {
    return own < 0 ? fmt::format("the place of '{}' at {}", body.name, brackets(x))
                   : fmt::format("vertex {} of '{}' at {}", body.vertex_from[static_cast<size_t>(own)], body.name,
                                 brackets(x));
  }
};

std::vector<int> selected(const SceneAttachment& attachment, const Body& body) {
  std::vector<int> out = vertices_in_box(body.ordered, vector(attachment.min), vector(attachment.max));
  if (out.empty()) throw SourceError(attachment.place, "this box holds no vertex of object " + reach_of(body));
  return out;
}

std::vector<JointEnd> ends_of(const SceneAttachment& attachment, const UsedAttachment& used, const Body& body) {
  std::vector<JointEnd> out;
  if (attachment.wrote("places"))
    for (const Vector3& place : attachment.places)
      out.push_back({-1, body.first_place + used.own_place + static_cast<int>(out.size()), vector(place)});
  else
    for (const int v : selected(attachment, body)) out.push_back({v, body.in_scene(v), body.ordered.X.col(v)});
  return out;
}

// Where all of it moves alike.
bool carries_places(const Body& body) {
  if (body.affine()) return true;
  const auto all = static_cast<size_t>(body.ordered.vertices());
  if (body.scripts.empty()) return body.fixed.size() == all;
  return body.scripts.size() == 1 && body.scripts[0].vertices.size() == all && body.scripts[0].shapes.empty();
}

// What may be joined to, within its box.
std::vector<std::array<int, 3>> places_on(const SceneAttachment& attachment, const Body& body) {
  if (attachment.to_surface() && dimension_of(body.ordered.element) < 2)
    throw SourceError(attachment.at("at"),
                      fmt::format("'{}' has no surface, it is made of {} cells; join its vertices, at = \"point\"",
                                  body.name, name_of(body.ordered.element)));
  const std::vector<int> inside = vertices_in_box(body.ordered, vector(attachment.to_min), vector(attachment.to_max));
  std::vector<std::array<int, 3>> out;
  if (!attachment.to_surface()) {
    for (const int v : inside) out.push_back({v, v, v});
  } else {
    const auto holds = [&](int v) { return std::binary_search(inside.begin(), inside.end(), v); };
    for (const auto& triangle : surface_triangles(body.ordered))
      if (std::all_of(triangle.begin(), triangle.end(), holds)) out.push_back(triangle);
  }
  if (out.empty())
    throw SourceError(attachment.at(attachment.wrote("to_min") ? "to_min" : "to_max"),
                      fmt::format("the box from 'to_min' to 'to_max' holds no {} of {}",
                                  attachment.to_surface() ? "whole triangle" : "vertex", reach_of(body)));
  return out;
}

// Where a vertex of `from` is joined to `to`.
NearPlace place_for(const SceneAttachment& attachment, const Body& from, const JointEnd& end, const Body& to,
                    const PlaceSearch& search) {
  const NearPlace place = search.nearest(end.x);
  const std::array<int, 3>& corners = search.part(place.part);
  if (&from == &to && std::find(corners.begin(), corners.end(), end.own) != corners.end())
    throw SourceError(
        attachment.at("to"),
        fmt::format("{} would be attached to {}; let 'to_min' and 'to_max' hold another part of the "
                    "object",
                    end.text(from), attachment.to_surface() ? "a triangle of which it is a corner" : "itself"));
  if (place.distance > attachment.within)
    throw SourceError(
        attachment.at("within"),
        fmt::format("{} has no {} of '{}' within {} m: the nearest is {:.4g} m away, at {}; let 'min' and "
                    "'max' hold fewer vertices, or give a larger 'within'",
                    end.text(from), attachment.to_surface() ? "place on the surface" : "vertex", to.name,
                    attachment.within, place.distance, brackets(search.position(place))));
  return place;
}

// m, along the normal of the triangle.
double height(const Eigen::Vector3d& x, const std::array<int, 3>& t, const Eigen::Matrix3Xd& X) {
  const Eigen::Vector3d normal = (X.col(t[1]) - X.col(t[0])).cross(X.col(t[2]) - X.col(t[0])).normalized();
  return normal.dot(x - X.col(t[0]));
}

void join_to(const SceneAttachment& attachment, const Body& from, const std::vector<JointEnd>& ends, const Body& to,
             UsedAttachment& out) {
  const PlaceSearch search(to.ordered.X, places_on(attachment, to));
  StencilData sizes;
  for (const JointEnd& end : ends) {
    const NearPlace place = place_for(attachment, from, end, to, search);
    const std::array<int, 3>& corners = search.part(place.part);
    out.stencils.push_back(end.vertex);
    for (size_t i = 0; i < (attachment.to_surface() ? 3 : 1); ++i) out.stencils.push_back(to.in_scene(corners[i]));
    sizes["L"].push_back(place.distance);
    if (!attachment.to_surface()) continue;
    sizes["w1"].push_back(place.weights[1]);
    sizes["w2"].push_back(place.weights[2]);
    sizes["h"].push_back(height(end.x, corners, to.ordered.X));
  }
  for (const auto& size : sizes_of(out.law.declared->geometry)) {
    const Symbol* rest = out.law.declared->find(size.first);
    if (rest != nullptr && rest->role == Role::rest) out.law.rest[size.first] = sizes[size.first];
  }
}

}  // namespace

std::vector<UsedAttachment> attachment_laws(const Scene& scene, Laws& laws) {
  std::vector<UsedAttachment> out;
  for (const SceneAttachment& attachment : scene.attachments) {
    const Energy& energy = laws.get(attachment);
    check_law(energy, attachment);
    check_keys(energy, attachment);
    out.push_back({.law = used_law(energy, attachment, scene.objects[object_index(scene, attachment.object)], laws)});
  }
  return out;
}

void add_places(const Scene& scene, std::vector<Body>& bodies, std::vector<UsedAttachment>& attachments) {
  for (size_t i = 0; i < attachments.size(); ++i) {
    const SceneAttachment& attachment = scene.attachments[i];
    Body& from = bodies[object_index(scene, attachment.object)];
    const auto check = [&](const Body& body, const char* key) {
      if (carries_places(body)) return;
      throw SourceError(attachment.at(key),
                        fmt::format("'{}' carries no places: they move with an affine body, or with what is held or "
                                    "scripted as a whole and keeps its shape; join its {}",
                                    body.name, key == std::string("at") ? "nearest point or surface" : "vertices"));
    };
    if (attachment.wrote("places")) {
      check(from, "places");
      attachments[i].own_place = static_cast<int>(from.places.size());
      for (const Vector3& place : attachment.places) from.places.push_back(vector(place));
    }
    if (!attachment.to_place()) continue;
    Body& to = body_named(bodies, attachment.to);
    check(to, "at");
    attachments[i].to_place = static_cast<int>(to.places.size());
    for (const JointEnd& end : ends_of(attachment, attachments[i], from)) to.places.push_back(end.x);
  }
}

void join(const Scene& scene, const BuiltScene& built, const std::string& folder,
          std::vector<UsedAttachment>& attachments) {
  for (size_t i = 0; i < attachments.size(); ++i) {
    const SceneAttachment& attachment = scene.attachments[i];
    UsedAttachment& out = attachments[i];
    const size_t object = object_index(scene, attachment.object);
    const Body& from = built.bodies[object];
    const std::vector<JointEnd> ends = ends_of(attachment, out, from);
    if (!attachment.to_space() && !attachment.to_place())
      join_to(attachment, from, ends, body_named(built.bodies, attachment.to), out);
    else
      for (size_t k = 0; k < ends.size(); ++k) {
        out.stencils.push_back(ends[k].vertex);
        if (attachment.to_place())
          out.stencils.push_back(body_named(built.bodies, attachment.to).first_place + out.to_place +
                                 static_cast<int>(k));
      }
    if (std::none_of(out.stencils.begin(), out.stencils.end(), [&](int v) { return built.system->moves(v); }))
      throw SourceError(attachment.place,
                        "all that this attachment joins is fixed or scripted: it moves nothing; move "
                        "the box, or leave the attachment out");
    if (out.law.fields.empty()) continue;
    for (const LawField& field : out.law.fields)
      if (field.over_mesh() && attachment.wrote("places"))
        throw SourceError(
            field.place,
            fmt::format("'{}' varies over the mesh of '{}', of which 'places' are no part; give one value, "
                        "or a formula in t alone",
                        field.param->name, from.name));
    std::vector<int> own;
    for (const JointEnd& end : ends) own.push_back(std::max(end.own, 0));
    const Sites sites = sites_of_stencils(from.ordered, own, 1);
    place_fields({&scene.objects[object], &from, &sites, folder}, out.law);
  }
}

void add_attachments(const Scene& scene, const std::vector<UsedAttachment>& attachments, const UsedKernels& kernels,
                     BuiltScene& out) {
  for (size_t i = 0; i < attachments.size(); ++i) try {
      const UsedLaw& law = attachments[i].law;
      const std::vector<int>& stencils = attachments[i].stencils;
      const Energy& energy = *law.energy;
      const int index = add_law(
          scene, scene.attachments[i], law,
          Potential::on_stencils(law.declared->name, kernels.get(energy), stencils, out.start.x, law.params, law.rest),
          out);
      if (!has_target(energy)) continue;
      std::vector<double> targets;
      for (const int v : stencils) targets.insert(targets.end(), out.start.x.col(v).begin(), out.start.x.col(v).end());
      out.system->potential(index).set_lag("target", targets);
    } catch (const InputError& bad) {
      throw SourceError(scene.attachments[i].place,
                        fmt::format("attachment of '{}': {}", scene.attachments[i].object, bad.what()));
    }
}

}  // namespace ergon
