#pragma once
// Keys that objects and obstacles share: where a shape comes from, where it starts, how it collides and how a script
// moves it.

#include "scenes/keys.h"
#include "scenes/scene.h"

namespace ergon {

namespace key_ranges {
constexpr double inf = std::numeric_limits<double>::infinity();
inline const Range any{};  // finite
inline const Range with_infinity{-inf, inf, false, false};
inline const Range positive{0, inf, true, true};
inline const Range not_negative{0, inf, false, true};
inline const Range from_1{1, inf, false, true};
}  // namespace key_ranges

// "object" or "obstacle", as tables are named.
template <class T>
const char* table_name();
template <>
inline const char* table_name<SceneObject>() {
  return "object";
}
template <>
inline const char* table_name<SceneObstacle>() {
  return "obstacle";
}

template <class Owner>
Section<BoxSource> box_section() {
  using T = BoxSource;
  Section<T> out{fmt::format("[{}.box]", table_name<Owner>()),
                 "A block made of equal cells, one corner at the origin.",
                 {},
                 {},
                 {}};
  out.keys = {
      vector_key("size", &T::size, "m", key_ranges::positive, Need::required, "edge lengths"),
      integers_key("cells", &T::cells, key_ranges::from_1, Need::required, "cells along each edge"),
  };
  return out;
}

template <class Owner>
Section<SphereSource> sphere_section() {
  using T = SphereSource;
  Section<T> out{fmt::format("[{}.sphere]", table_name<Owner>()),
                 "A sphere around the origin: an icosahedron whose faces are cut into triangles.",
                 {},
                 {},
                 {}};
  out.keys = {
      number_key("radius", &T::radius, "m", key_ranges::positive, Need::required, "of the vertices"),
      integer_key("cuts", &T::cuts, {1, 200, false, false}, Need::optional, "triangles along each edge of a face"),
  };
  return out;
}

template <class Owner>
Section<TubeSource> tube_section() {
  using T = TubeSource;
  Section<T> out{fmt::format("[{}.tube]", table_name<Owner>()),
                 "A straight pipe with a wall, along x from the origin, closed at its ends by rings.",
                 {},
                 {},
                 {}};
  out.keys = {
      number_key("inner", &T::inner, "m", key_ranges::positive, Need::required, "radius"),
      number_key("outer", &T::outer, "m", key_ranges::positive, Need::required, "radius"),
      number_key("length", &T::length, "m", key_ranges::positive, Need::required, "along x"),
      integer_key("around", &T::around, {3, 10000, false, false}, Need::optional, "cells"),
      integer_key("along", &T::along, {1, 10000, false, false}, Need::optional, "cells"),
  };
  out.check = [](const std::string&, const T& tube) {
    if (tube.outer <= tube.inner)
      throw SourceError(tube.at("outer"),
                        fmt::format("'outer' must exceed 'inner', found {} m and {} m", tube.outer, tube.inner));
  };
  return out;
}

template <class Owner>
Section<TorusSource> torus_section() {
  using T = TorusSource;
  Section<T> out{fmt::format("[{}.torus]", table_name<Owner>()), "A ring around the z axis.", {}, {}, {}};
  out.keys = {
      number_key("radius", &T::radius, "m", key_ranges::positive, Need::required, "of the circle amid the ring"),
      number_key("section", &T::section, "m", key_ranges::positive, Need::required, "radius of the cross-section"),
      integer_key("around", &T::around, {3, 10000, false, false}, Need::optional, "cells"),
      integer_key("across", &T::across, {3, 10000, false, false}, Need::optional, "cells"),
  };
  out.check = [](const std::string&, const T& torus) {
    if (torus.radius <= torus.section)
      throw SourceError(torus.at("radius"), fmt::format("'radius' must exceed 'section', found {} m and {} m",
                                                        torus.radius, torus.section));
  };
  return out;
}

template <class Owner>
Section<CurveSource> curve_section() {
  using T = CurveSource;
  Section<T> out{
      fmt::format("[{}.curve]", table_name<Owner>()), "A line through points, as rods and wires have it.", {}, {}, {}};
  out.keys = {
      points_key("points", &T::points, "m", Need::required, "that the line goes through", ""),
      boolean_key("closed", &T::closed, "it goes on from the last point to the first"),
      integer_key("cells", &T::cells, {1, 1e7, false, false}, Need::optional,
                  "edges of equal length along a smooth curve through the points", "straight from point to point"),
  };
  return out;
}

template <class Owner>
Section<MotionKey> motion_section() {
  using T = MotionKey;
  Section<T> out{std::is_same_v<Owner, SceneObject> ? "[[object.scripted.key]]" : "[[obstacle.key]]",
                 "Where a script has moved to at a time; linear in between, at rest before the first and after the "
                 "last. At time 0 it is at its start.",
                 {},
                 {},
                 {}};
  out.keys = {
      number_key("time", &T::time, "s", key_ranges::positive, Need::required, "after the start"),
      vector_key("translate", &T::translate, "m", key_ranges::any, Need::optional, "displacement from the start"),
      vector_key("rotate", &T::rotate, "rad", key_ranges::any, Need::optional,
                 "rotation vector: along the axis, as long as the angle, which may be many turns"),
  };
  return out;
}

// Times ascend.
template <class T>
void check_motion(const std::vector<T>& keys) {
  for (size_t i = 1; i < keys.size(); ++i)
    if (keys[i].time <= keys[i - 1].time)
      throw SourceError(keys[i].at("time"),
                        fmt::format("'time' must ascend: {} s follows {} s", keys[i].time, keys[i - 1].time));
}

// What a mesh file may be is said by `mesh_help`.
template <class T>
std::vector<Key<T>> shape_keys(const std::string& mesh_help) {
  return {
      text_key<T>("name", &T::name, Need::required, "a name of its own, used in messages and results"),
      text_key<T>("mesh", &T::mesh, Need::optional, mesh_help,
                  "give `mesh`, `box`, `sphere`, `tube`, `torus`, `curve` or `points`"),
      table_key<T, BoxSource>("box", &T::box, box_section<T>, "instead of a mesh file"),
      table_key<T, SphereSource>("sphere", &T::sphere, sphere_section<T>, "instead of a mesh file"),
      table_key<T, TubeSource>("tube", &T::tube, tube_section<T>, "instead of a mesh file"),
      table_key<T, TorusSource>("torus", &T::torus, torus_section<T>, "instead of a mesh file"),
      table_key<T, CurveSource>("curve", &T::curve, curve_section<T>, "instead of a mesh file"),
      points_key<T>("points", &T::points, "m", Need::optional, "loose points, instead of a mesh file", "none"),
      number_key<T, double>("scale", &T::scale, "1", key_ranges::positive, Need::optional,
                            "factor on the mesh's coordinates"),
      vector_key<T>("rotate", &T::rotate, "rad", key_ranges::any, Need::optional,
                    "angles about the x, then y, then z axis, after scaling"),
      vector_key<T>("translate", &T::translate, "m", key_ranges::any, Need::optional, "displacement, after rotating"),
      number_key<T, double>("offset", &T::offset, "m", key_ranges::not_negative, Need::optional,
                            "distance that other surfaces keep from this one, beside their own: half its thickness"),
      boolean_key<T>("touches_itself", &T::touches_itself, "its parts collide with one another"),
  };
}

template <class T>
void check_mesh_ending(const T& shape) {
  for (const char* ending : {".msh", ".obj", ".stl", ".ply"})
    if (shape.mesh.ends_with(ending)) return;
  throw SourceError(shape.at("mesh"),
                    fmt::format("'mesh' must end in .msh, .obj, .stl or .ply, found \"{}\"", shape.mesh));
}

// Exactly one source, and a mesh file of a known kind.
template <class T>
void check_shape(const T& shape) {
  const std::vector<std::pair<const char*, bool>> sources = {
      {"mesh", shape.wrote("mesh")},    {"box", shape.box.has_value()},     {"sphere", shape.sphere.has_value()},
      {"tube", shape.tube.has_value()}, {"torus", shape.torus.has_value()}, {"curve", shape.curve.has_value()},
      {"points", shape.wrote("points")}};
  std::vector<const char*> given;
  for (const auto& [key, is_given] : sources)
    if (is_given) given.push_back(key);
  if (given.empty())
    throw SourceError(shape.place,
                      fmt::format("{} '{}' lacks 'mesh' (a file), 'box' (size and cells), 'sphere' (radius), 'tube' "
                                  "(inner, outer, length), 'torus' (radius, section), 'curve' (points) or 'points' "
                                  "(loose ones)",
                                  table_name<T>(), shape.name));
  if (given.size() > 1)
    throw SourceError(shape.at(given[1]), fmt::format("{} '{}' has both '{}' and '{}'; keep one of them",
                                                      table_name<T>(), shape.name, given[0], given[1]));
  if (shape.wrote("mesh")) check_mesh_ending(shape);
}

}  // namespace ergon
