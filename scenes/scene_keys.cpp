#include "scenes/scene_keys.h"

#include <algorithm>
#include <cmath>

#include "runtime/mesh/quadrature.h"

namespace ergon {
namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
const Range any{};  // finite
const Range with_infinity{-inf, inf, false, false};
const Range positive{0, inf, true, true};
const Range not_negative{0, inf, false, true};
const Range from_1{1, inf, false, true};

Section<TimeSettings> time_section() {
  using T = TimeSettings;
  Section<T> out{"[time]", "How long to simulate.", {}, {}, {}};
  out.keys = {
      number_key("dt", &T::dt, "s", positive, Need::required, "length of a time step"),
      number_key("end", &T::end, "s", positive, Need::optional, "simulated time", "give `end` or `steps`"),
      integer_key("steps", &T::steps, from_1, Need::optional, "number of time steps", "give `end` or `steps`"),
  };
  out.check = [](const std::string&, const T& time) {
    if (time.end && time.steps)
      throw SourceError(time.at("steps"), "[time] has both 'end' and 'steps'; keep one of them");
    if (!time.end && !time.steps)
      throw SourceError(time.place, "[time] lacks 'end' (simulated time, in s) or 'steps' (number of time steps)");
    constexpr double most = 1e9;
    if (time.end && *time.end / time.dt > most)
      throw SourceError(time.at("end"),
                        fmt::format("{} s in steps of {} s are {:.3g} steps; at most {:.3g} are counted", *time.end,
                                    time.dt, *time.end / time.dt, most));
  };
  return out;
}

Section<SolverSettings> solver_section() {
  using T = SolverSettings;
  Section<T> out{"[solver]", "How each step is solved.", {}, {}, {}};
  out.keys = {
      number_key("tolerance", &T::tolerance, "m/s", positive, Need::optional,
                 "a step is solved when Newton's next change of any velocity is below this"),
      integer_key("max_iterations", &T::max_iterations, from_1, Need::optional,
                  "Newton iterations after which a step counts as not converged"),
      choice_key("projection", &T::projection, {"clamp", "absolute", "progressive", "none"},
                 "what is done to negative eigenvalues of the Hessian of an element; progressive: nothing until, in a "
                 "time step, the sum has no factor or the direction does not descend, then clamp"),
      choice_key(
          "precision", &T::precision, {"double", "float", "mixed"},
          "of the energies of objects (inertia, constant Hessians and contact are always double); mixed: Hessians "
          "in float, which takes Newton no more iterations; float: values and gradients too, which do not resolve the "
          "default tolerance: steps that need more fail, as the energy does not fall any more"),
      integer_key("friction_iterations", &T::friction_iterations, from_1, Need::optional,
                  "most solves per step, each with the normal forces of the one before"),
      number_key("friction_tolerance", &T::friction_tolerance, "1", not_negative, Need::optional,
                 "no further solve when normal forces changed by less than this fraction of their sum"),
      boolean_key("accept_unconverged", &T::accept_unconverged,
                  "go on from the best state of a step that did not converge, instead of stopping there"),
  };
  return out;
}

Section<OutputSettings> output_section() {
  using T = OutputSettings;
  Section<T> out{"[output]", "What is written, and where.", {}, {}, {}};
  out.keys = {
      text_key("folder", &T::folder, Need::optional, "where frames and report go, relative to the working directory",
               "out/NAME of the scene file"),
      number_key("frame_interval", &T::frame_interval, "s", not_negative, Need::optional,
                 "simulated time between frames; 0 writes every step"),
      boolean_key("frames", &T::frames, "write frames (.vtu files and a .pvd series)"),
  };
  return out;
}

Section<BoxSource> box_section() {
  using T = BoxSource;
  Section<T> out{"[object.box]", "A block made of equal cells, one corner at the origin.", {}, {}, {}};
  out.keys = {
      vector_key("size", &T::size, "m", positive, Need::required, "edge lengths"),
      integers_key("cells", &T::cells, from_1, Need::required, "cells along each edge"),
  };
  return out;
}

Section<EnergyUse> energy_section() {
  using T = EnergyUse;
  Section<T> out{"[[object.energy]]",
                 "One law that the object obeys. Every other key is a param of that energy (`ergon show LAW` lists "
                 "them with unit and range): a number, a string with a unit, or an array for a vector or a matrix.",
                 {},
                 {},
                 {}};
  out.keys = {
      text_key("law", &T::law, Need::required,
               "name of an energy in the catalogue, or path of an .energy file relative to the scene"),
  };
  out.other = [](const toml::key& key, const toml::node& node, const std::string& file, T& use) {
    use.params[std::string(key.str())] = read_param(key, node, file);
  };
  return out;
}

Section<BoxSelector> fixed_section() {
  using T = BoxSelector;
  Section<T> out{"[[object.fixed]]",
                 "A box; the object's vertices in it (after scale, rotate and translate) never move.",
                 {},
                 {},
                 {}};
  out.keys = {
      vector_key("min", &T::min, "m", with_infinity, Need::optional, "lower corner"),
      vector_key("max", &T::max, "m", with_infinity, Need::optional, "upper corner"),
  };
  out.check = [](const std::string&, const T& box) {
    for (size_t axis = 0; axis < 3; ++axis)
      if (box.min[axis] > box.max[axis])
        throw SourceError(box.at("max"), fmt::format("'max' is below 'min' along axis {}: {} m < {} m", "xyz"[axis],
                                                     box.max[axis], box.min[axis]));
  };
  return out;
}

std::vector<std::string> element_names() {
  return {"tet4", "tet10", "hex8", "hex20", "hex27", "prism6", "tri3", "tri6", "quad4", "quad9", "edge2", "edge3"};
}

void check_object(const std::string&, const SceneObject& object) {
  const bool surface = object.wrote("mesh") && !object.mesh.ends_with(".msh");
  if (object.box.has_value() == object.wrote("mesh"))
    throw SourceError(object.box ? object.at("box") : object.place,
                      fmt::format("object '{}' {}", object.name,
                                  object.box ? "has both 'mesh' and 'box'; keep one of them"
                                             : "lacks 'mesh' (a file) or 'box' (size and cells)"));
  const char* endings[] = {".msh", ".obj", ".stl", ".ply"};
  if (object.wrote("mesh") && std::none_of(std::begin(endings), std::end(endings),
                                           [&](const char* ending) { return object.mesh.ends_with(ending); }))
    throw SourceError(object.at("mesh"),
                      fmt::format("'mesh' must end in .msh, .obj, .stl or .ply, found \"{}\"", object.mesh));
  if (object.wrote("max_edge") && !surface)
    throw SourceError(object.at("max_edge"),
                      "'max_edge' has no use here: it is for surface meshes (.obj, .stl, .ply), which are filled with "
                      "tetrahedra");
  if (object.wrote("element") && surface && object.element != "tet4" && object.element != "tet10")
    throw SourceError(object.at("element"), "a surface is filled with tetrahedra: 'element' must be tet4 or tet10");
}

Section<SceneObject> object_section() {
  using T = SceneObject;
  Section<T> out{"[[object]]", "A deformable body.", {}, {}, {}};
  out.keys = {
      text_key("name", &T::name, Need::required, "a name of its own, used in messages and results"),
      text_key("mesh", &T::mesh, Need::optional,
               "mesh file relative to the scene: cells (.msh), or a closed surface (.obj, .stl, .ply) that is filled "
               "with tetrahedra",
               "give `mesh` or `box`"),
      table_key("box", &T::box, box_section, "instead of a mesh file"),
      number_key("max_edge", &T::max_edge, "m", positive, Need::optional,
                 "longest edge wanted of the tetrahedra that fill a surface, after scaling",
                 "continued from the surface"),
      choice_key(
          "element", &T::element, element_names(),
          "element of a box, or of a filled surface; membranes (tri, quad) fill the box's rectangle z = 0, lines "
          "(edge) its edge along x"),
      integer_key("quadrature", &T::quadrature, {0, kMaxExactness, false, false}, Need::optional,
                  "degree of polynomials that the energies' quadrature integrates exactly on an element",
                  "full integration of the element's stiffness"),
      number_key("scale", &T::scale, "1", positive, Need::optional, "factor on the mesh's coordinates"),
      vector_key("rotate", &T::rotate, "rad", any, Need::optional,
                 "angles about the x, then y, then z axis, after scaling"),
      vector_key("translate", &T::translate, "m", any, Need::optional, "displacement, after rotating"),
      number_key("density", &T::density, "kg/m^3", positive, Need::required, "mass per rest volume"),
      number_key("thickness", &T::thickness, "m", positive, Need::optional, "of a membrane, for its mass",
                 "required for membranes"),
      number_key("cross_section", &T::cross_section, "m^2", positive, Need::optional, "of a line, for its mass",
                 "required for lines"),
      vector_key("velocity", &T::velocity, "m/s", any, Need::optional, "velocity at the start"),
      tables_key("energy", &T::energies, energy_section, Need::required, "what the object is made of"),
      tables_key("fixed", &T::fixed, fixed_section, Need::optional, "vertices that never move"),
  };
  out.check = check_object;
  return out;
}

Section<SceneGround> ground_section() {
  using T = SceneGround;
  Section<T> out{"[[ground]]", "A half-space that nothing enters: dot(normal, x) < height.", {}, {}, {}};
  out.keys = {
      vector_key("normal", &T::normal, "1", any, Need::optional, "out of the ground; any length but zero"),
      number_key("height", &T::height, "m", any, Need::optional, "position along the normal"),
      number_key("mu", &T::mu, "1", not_negative, Need::optional, "coefficient of friction; 0 leaves friction out"),
      number_key("epsv", &T::epsv, "m/s", positive, Need::optional, "sliding speed below which friction is static"),
      number_key("dhat", &T::dhat, "m", positive, Need::optional, "distance at which the barrier begins to act"),
      number_key("stiffness", &T::stiffness, "N/m", positive, Need::optional, "stiffness of the barrier",
                 "chosen and adapted by the solver"),
  };
  out.check = [](const std::string&, const T& ground) {
    if (std::hypot(ground.normal[0], ground.normal[1], ground.normal[2]) == 0)
      throw SourceError(ground.at("normal"), "'normal' must not be zero, found [0, 0, 0]");
    if (ground.wrote("epsv") && ground.mu == 0)
      throw SourceError(ground.at("epsv"), "'epsv' has no use without friction; set 'mu' or leave 'epsv' out");
  };
  return out;
}

}  // namespace

Section<Scene> scene_section() {
  using T = Scene;
  Section<T> out{"the scene", "Top level of the file.", {}, {}, {}};
  out.keys = {
      text_key("description", &T::description, Need::optional, "a line for whoever reads the file"),
      vector_key("gravity", &T::gravity, "m/s^2", any, Need::optional, "acceleration of free fall"),
      table_key("time", &T::time, time_section, Need::required, "how long to simulate"),
      table_key("solver", &T::solver, solver_section, Need::optional, "how each step is solved"),
      table_key("output", &T::output, output_section, Need::optional, "what is written"),
      tables_key("object", &T::objects, object_section, Need::required, "at least one deformable body"),
      tables_key("ground", &T::grounds, ground_section, Need::optional, "half-spaces"),
  };
  out.check = [](const std::string&, const T& scene) {
    std::map<std::string, const SceneObject*> seen;
    for (const SceneObject& object : scene.objects) {
      auto [first, is_new] = seen.emplace(object.name, &object);
      if (!is_new)
        throw SourceError(object.at("name"), fmt::format("the name '{}' is taken by the object in line {}", object.name,
                                                         first->second->at("name").line));
    }
  };
  return out;
}

}  // namespace ergon
