#include "scenes/scene_keys.h"

#include <algorithm>
#include <cmath>

#include "runtime/mesh/quadrature.h"
#include "scenes/attachment_keys.h"
#include "scenes/contact_keys.h"
#include "scenes/energy_keys.h"
#include "scenes/shape_keys.h"
#include "scenes/time_keys.h"

namespace ergon {
namespace {

using namespace key_ranges;

Section<StartSettings> start_section() {
  using T = StartSettings;
  Section<T> out{"[start]", "How the first state differs from what the objects say.", {}, {}, {}};
  out.keys = {
      number_key(
          "noise", &T::noise, "m/s", not_negative, Need::optional,
          "largest component of a random velocity that every free vertex gets in addition, and every affine body "
          "as a whole, with a rotation as fast"),
      integer_key("seed", &T::seed, {0, 2147483647, false, false}, Need::optional,
                  "of the noise: the same one gives the same velocities on every machine"),
  };
  return out;
}

Section<SolverSettings> solver_section() {
  using T = SolverSettings;
  Section<T> out{"[solver]", "How each step is solved.", {}, {}, {}};
  out.keys = {
      number_key("tolerance", &T::tolerance, "m/s", positive, Need::optional,
                 "a step is solved when Newton's next change of any velocity is below this; with friction also below a "
                 "twentieth of `epsv`"),
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
      boolean_key("forces", &T::forces,
                  "write the forces of contact and of friction at the end of each step: on every vertex in frames, and "
                  "their sums over each object and obstacle in report.jsonl (N)"),
  };
  return out;
}

// Keys of a box that selects vertices.
template <class T>
std::vector<Key<T>> selector_keys() {
  return {vector_key<T>("min", &T::min, "m", with_infinity, Need::optional, "lower corner"),
          vector_key<T>("max", &T::max, "m", with_infinity, Need::optional, "upper corner")};
}

void check_selector(const BoxSelector& box) {
  for (size_t axis = 0; axis < 3; ++axis)
    if (box.min[axis] > box.max[axis])
      throw SourceError(box.at("max"), fmt::format("'max' is below 'min' along axis {}: {} m < {} m", "xyz"[axis],
                                                   box.max[axis], box.min[axis]));
}

Section<SceneRegion> region_section() {
  using T = SceneRegion;
  Section<T> out{"[[object.region]]",
                 "A box; the object's cells whose centre is in it (after scale, rotate and translate) are a region, in "
                 "which params may have values of their own. Or a physical group of the .msh file.",
                 {},
                 {},
                 {}};
  out.keys = selector_keys<T>();
  out.keys.insert(out.keys.begin(), text_key("name", &T::name, Need::required, "a name of its own in the object"));
  out.keys.push_back(text_key("group", &T::group, Need::optional,
                              "in place of a box, a physical group of the mesh file, by its name, or its number in "
                              "quotes where it has none",
                              "none"));
  out.check = [](const std::string&, const T& region) {
    check_selector(region);
    if (region.wrote("group") && (region.wrote("min") || region.wrote("max")))
      throw SourceError(region.at("group"), "'group' and a box are two ways to say which cells; leave one of them out");
  };
  return out;
}

Section<FixedBox> fixed_section() {
  using T = FixedBox;
  Section<T> out{"[[object.fixed]]",
                 "A box; the object's vertices in it (after scale, rotate and translate) never move.",
                 {},
                 {},
                 {}};
  out.keys = selector_keys<T>();
  out.keys.push_back(choice_key("axes", &T::axes, {"xyz", "x", "y", "z", "xy", "xz", "yz"},
                                "along which they do not move; x alone is a plane of symmetry across x"));
  out.check = [](const std::string&, const T& box) { check_selector(box); };
  return out;
}

Section<ScriptedBox> scripted_section() {
  using T = ScriptedBox;
  Section<T> out{"[[object.scripted]]",
                 "A box; the object's vertices in it (after scale, rotate and translate) follow a script.",
                 {},
                 {},
                 {}};
  out.keys = selector_keys<T>();
  out.keys.push_back(
      vector_key("center", &T::center, "m", any, Need::optional, "what rotations are about; moves along"));
  out.keys.push_back(tables_key("key", &T::motion, motion_section<SceneObject>, Need::required, "the script"));
  out.check = [](const std::string&, const T& box) {
    check_selector(box);
    check_motion(box.motion);
  };
  return out;
}

Section<SceneLoad> load_section() {
  using T = SceneLoad;
  Section<T> out{
      "[[object.load]]",
      "A box; a force that keeps its direction and size acts on the object's vertices in it (after scale, rotate "
      "and translate), spread evenly over the faces of the surface that have all their vertices in it; where "
      "there are none, over such edges; else over the vertices.",
      {},
      {},
      {}};
  out.keys = selector_keys<T>();
  out.keys.push_back(vector_key("force", &T::force, "N", any, Need::optional, "on all of them together"));
  out.keys.push_back(vector_key("traction", &T::traction, "Pa", any, Need::optional,
                                "per area of the faces at rest, instead of `force`"));
  out.check = [](const std::string&, const T& load) {
    check_selector(load);
    if (load.wrote("force") == load.wrote("traction"))
      throw SourceError(load.place, "[[object.load]] needs either 'force' (N) or 'traction' (Pa)");
  };
  return out;
}

std::vector<std::string> element_names() {
  return {"automatic", "tet4", "tet10", "hex8",  "hex20", "hex27", "prism6",
          "tri3",      "tri6", "quad4", "quad9", "edge2", "edge3"};
}

Section<Copies> copies_section() {
  using T = Copies;
  Section<T> out{
      "[object.copies]",
      "The object stands several times in the scene, as NAME_1, NAME_2 and so on, each displaced against the "
      "one before.",
      {},
      {},
      {}};
  out.keys = {
      integer_key("count", &T::count, {1, 10000, false, false}, Need::required, "objects, the first one included"),
      vector_key("translate", &T::translate, "m", any, Need::required, "displacement from one to the next"),
  };
  return out;
}

// Puts copies in place of what is to be copied.
void expand_copies(Scene& scene) {
  std::vector<SceneObject> objects;
  for (const SceneObject& object : scene.objects) {
    if (!object.copies) {
      objects.push_back(object);
      continue;
    }
    for (int i = 0; i < object.copies->count; ++i) {
      SceneObject& copy = objects.emplace_back(object);
      copy.copies.reset();
      copy.name = fmt::format("{}_{}", object.name, i + 1);
      for (size_t axis = 0; axis < 3; ++axis) copy.translate[axis] += i * object.copies->translate[axis];
    }
  }
  scene.objects = std::move(objects);
}

// What a body that does not bend has no use for.
void check_affine(const SceneObject& object) {
  for (const auto& [key, why] :
       {std::pair("energy", "of its shape it knows 'stiffness' alone"),
        std::pair("element", "its shape is the surface alone"), std::pair("max_edge", "its shape is the surface alone"),
        std::pair("quadrature", "its mass is that within the surface, exactly"),
        std::pair("mass", "its mass is that within the surface, exactly"),
        std::pair("thickness", "it is the solid within its surface"),
        std::pair("cross_section", "it is the solid within its surface")})
    if (object.wrote(key))
      throw SourceError(object.at(key), fmt::format("'{}' has no use for an affine body: {}", key, why));
}

void check_object(const std::string&, const SceneObject& object) {
  check_shape(object);
  if (object.copies && (!object.fixed.empty() || !object.scripted.empty() || !object.loads.empty()))
    throw SourceError(
        object.at("copies"),
        "copies have no fixed, scripted or loaded vertices, as boxes do not move along; write the objects out");
  if (object.affine()) return check_affine(object);
  if (object.wrote("stiffness"))
    throw SourceError(object.at("stiffness"),
                      "'stiffness' is that of an affine body; set kinematics = \"affine\" or leave it out");
  if (!object.wrote("energy"))
    throw SourceError(object.place, "[[object]] lacks [[object.energy]]: what the object is made of");
  const bool surface =
      (object.wrote("mesh") && !object.mesh.ends_with(".msh")) || object.sphere || object.tube || object.torus;
  const bool filled = surface && !object.keeps_surface();
  if (object.wrote("max_edge") && !filled)
    throw SourceError(object.at("max_edge"),
                      "'max_edge' has no use here: it is for surface meshes (.obj, .stl, .ply), which are filled with "
                      "tetrahedra");
  if (object.wrote("mass") && object.wrote("points"))
    throw SourceError(object.at("mass"), "'mass' has no use here: loose points have each its own");
  if (!object.wrote("element") || object.element == "automatic") return;
  const auto refuse = [&](const char* why) { throw SourceError(object.at("element"), why); };
  if (filled && object.element != "tet4" && object.element != "tet10")
    refuse("a surface is filled with tetrahedra, or kept as a shell: 'element' must be tet4, tet10, tri3 or tri6");
  if (object.curve && object.element != "edge2" && object.element != "edge3")
    refuse("a curve is made of lines: 'element' must be edge2 or edge3");
  if (object.wrote("points")) refuse("'element' has no use here: loose points have none");
}

Section<SceneObject> object_section() {
  using T = SceneObject;
  Section<T> out{"[[object]]", "A body that moves: deformable, or affine and nearly rigid.", {}, {}, {}};
  out.keys = {
      choice_key(
          "kinematics", &T::kinematics, {"free", "affine"},
          "free: every vertex by itself; affine: a solid of 12 degrees of freedom, moved by four points, of which "
          "its closed surface is carried"),
      number_key("stiffness", &T::stiffness, "Pa", positive, Need::optional,
                 "of an affine body: what keeps its map near a rotation (energy affine_orthogonality)"),
      number_key("max_edge", &T::max_edge, "m", positive, Need::optional,
                 "longest edge wanted of the tetrahedra that fill a surface, after scaling",
                 "continued from the surface"),
      choice_key(
          "element", &T::element, element_names(),
          "element of a box or a surface; membranes (tri, quad) fill a box's rectangle z = 0, lines (edge) its edge "
          "along x; a surface is filled with tetrahedra (tet4, tet10), or kept as a shell (tri3, tri6); a curve is of "
          "edge2 or edge3; automatic: hex27 for a box, tet4 for a surface, edge2 for a curve"),
      integer_key("quadrature", &T::quadrature, {0, kMaxExactness, false, false}, Need::optional,
                  "degree of polynomials that the energies' quadrature integrates exactly on an element",
                  "full integration of the element's stiffness"),
      number_key("density", &T::density, "kg/m^3", positive, Need::required, "mass per rest volume"),
      number_key("thickness", &T::thickness, "m", positive, Need::optional,
                 "of a membrane, for its mass and for laws whose param `h` (m) is left out", "required for membranes"),
      number_key("cross_section", &T::cross_section, "m^2", positive, Need::optional, "of a line, for its mass",
                 "required for lines"),
      vector_key("axis", &T::axis, "1", any, Need::optional,
                 "of a rod that twists: where the first axis of its cross-section points on its first edge; left out "
                 "and with that edge along z: x"),
      number_key("gyration", &T::gyration, "m", positive, Need::optional,
                 "of a rod that twists: radius of gyration of its cross-section, for its inertia against twist",
                 "that of a disc"),
      number_key("volume", &T::volume, "m^3", positive, Need::optional, "of each loose point, for its mass",
                 "required for loose points"),
      vector_key("velocity", &T::velocity, "m/s", any, Need::optional, "velocity at the start"),
      choice_key("mass", &T::mass, {"automatic", "lumped", "consistent"},
                 "lumped: every vertex has mass of its own; consistent: the matrix of the element's shape functions, "
                 "which keeps moments of inertia; automatic: consistent for tri6, tet10 and hex20, whose lumped masses "
                 "do not, else lumped"),
      number_key("mass_damping", &T::mass_damping, "1/s", not_negative, Need::optional,
                 "rate at which a free motion loses its velocity: Rayleigh damping by mass (energy drag)"),
      tables_key("energy", &T::energies, energy_section, Need::optional, "what a free object is made of; at least one"),
      tables_key("region", &T::regions, region_section, Need::optional, "named parts of the object, for params"),
      tables_key("fixed", &T::fixed, fixed_section, Need::optional, "vertices that never move"),
      tables_key("scripted", &T::scripted, scripted_section, Need::optional, "vertices that follow a script"),
      tables_key("load", &T::loads, load_section, Need::optional, "forces on parts of it"),
      table_key("copies", &T::copies, copies_section, "the object stands in the scene several times"),
  };
  const std::vector<Key<T>> shape = shape_keys<T>(
      "mesh file relative to the scene: cells (.msh), or a closed surface (.obj, .stl, .ply) that is filled with "
      "tetrahedra");
  out.keys.insert(out.keys.begin(), shape.begin(), shape.end());
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

Section<SceneProbe> probe_section() {
  using T = SceneProbe;
  Section<T> out{"[[probe]]",
                 "A vertex whose position is written: after every step in report.jsonl, at the end in summary.json.",
                 {},
                 {},
                 {}};
  out.keys = {
      text_key("name", &T::name, Need::required, "a name of its own"),
      text_key("object", &T::object, Need::required, "name of an object"),
      vector_key("near", &T::near, "m", any, Need::required, "the object's vertex nearest to this point at the start"),
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
      table_key("start", &T::start, start_section, Need::optional, "how the first state differs"),
      table_key("solver", &T::solver, solver_section, Need::optional, "how each step is solved"),
      table_key("output", &T::output, output_section, Need::optional, "what is written"),
      tables_key("object", &T::objects, object_section, Need::required, "at least one body that moves"),
      tables_key("obstacle", &T::obstacles, obstacle_section, Need::optional, "surfaces without degrees of freedom"),
      tables_key("ground", &T::grounds, ground_section, Need::optional, "half-spaces"),
      tables_key("probe", &T::probes, probe_section, Need::optional, "vertices whose paths are written"),
      tables_key("attachment", &T::attachments, attachment_section, Need::optional, "joints of objects"),
      table_key("contact", &T::contact, contact_section, "surfaces collide, with one another and themselves"),
  };
  out.check = [](const std::string&, T& scene) {
    expand_copies(scene);
    check_names(scene);
    check_attachments(scene);
  };
  return out;
}

}  // namespace ergon
