#include "scenes/builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "runtime/error.h"
#include "runtime/mesh/element_faces.h"
#include "runtime/mesh/mesh_tools.h"
#include "runtime/solver/stopwatch.h"
#include "scenes/laws.h"
#include "scenes/start_check.h"
#include "symbolic/checks.h"

namespace ergon {
namespace {

Eigen::Vector3d vector(const Vector3& v) { return {v[0], v[1], v[2]}; }

// One law of one object, checked.
struct UsedLaw {
  const Energy* energy;
  Parameters params;
};

// The laws of the scene itself: null where a scene does not need one.
struct WorldLaws {
  const Energy* inertia = nullptr;
  const Energy* gravity = nullptr;
  const Energy* barrier = nullptr;
  const Energy* friction = nullptr;
};

WorldLaws world_laws(const Scene& scene, Laws& laws, std::vector<std::string>& skipped) {
  const Place whole{scene.file, 0, 0};
  WorldLaws out;
  out.inertia = &laws.get("inertia", whole);
  if (vector(scene.gravity).isZero(0))
    skipped.push_back("gravity: it is zero in this scene, no kernel loaded");
  else
    out.gravity = &laws.get("gravity", whole);
  if (scene.grounds.empty()) {
    skipped.push_back("log_barrier, friction: there is no ground, no kernels loaded");
    return out;
  }
  out.barrier = &laws.get("log_barrier:half_space", whole);
  if (std::any_of(scene.grounds.begin(), scene.grounds.end(), [](const SceneGround& g) { return g.mu > 0; }))
    out.friction = &laws.get("friction", whole);
  else
    skipped.push_back("friction: no ground has a coefficient of friction 'mu', no kernel loaded");
  return out;
}

std::vector<UsedLaw> object_laws(const SceneObject& object, Laws& laws) {
  std::vector<UsedLaw> out;
  for (const EnergyUse& use : object.energies) {
    const Energy& energy = laws.get(use.law, use.at("law"));
    check_supported(energy, use);
    out.push_back({&energy, checked_params(energy, use)});
  }
  return out;
}

// What is unsound in the scene's own energies, each checked once.
std::vector<std::string> law_warnings(const Scene& scene, const std::vector<std::vector<UsedLaw>>& used) {
  std::vector<std::string> out;
  std::set<const Energy*> checked;
  for (size_t i = 0; i < used.size(); ++i) {
    for (size_t j = 0; j < used[i].size(); ++j) {
      const Energy& energy = *used[i][j].energy;
      if (!scene.objects[i].energies[j].law.ends_with(".energy") || !checked.insert(&energy).second) continue;
      for (const Finding& finding : check_energy(energy))
        if (finding.severity >= Severity::warning) out.push_back(to_string(finding));
    }
  }
  return out;
}

// Each kernel once, in the order of first use.
class Kernels {
 public:
  void want(const Energy* energy) {
    if (energy != nullptr && std::find(wanted_.begin(), wanted_.end(), energy) == wanted_.end())
      wanted_.push_back(energy);
  }
  void load(const KernelSource& source) { loaded_ = source(wanted_); }
  const Kernel& get(const Energy& energy) const {
    const auto found = std::find(wanted_.begin(), wanted_.end(), &energy);
    return loaded_.at(static_cast<size_t>(found - wanted_.begin()));
  }

 private:
  std::vector<const Energy*> wanted_;
  std::vector<Kernel> loaded_;
};

std::vector<int> edges_of(const Body& body) {
  const int per_cell = nodes_of(body.ordered.element);
  const std::vector<std::array<int, 2>> corners = corner_edges(body.ordered.element);
  std::set<std::pair<int, int>> edges;
  for (size_t first = 0; first < body.ordered.cells.size(); first += static_cast<size_t>(per_cell))
    for (auto [a, b] : corners)
      edges.insert(std::minmax(body.ordered.cells[first + static_cast<size_t>(a)],
                               body.ordered.cells[first + static_cast<size_t>(b)]));
  std::vector<int> out;
  for (auto [a, b] : edges) out.insert(out.end(), {body.first_vertex + a, body.first_vertex + b});
  return out;
}

std::vector<int> points_of(int first, int count) {
  std::vector<int> out(static_cast<size_t>(count));
  for (int i = 0; i < count; ++i) out[static_cast<size_t>(i)] = first + i;
  return out;
}

// Rest data that a point energy declares by this name.
std::map<std::string, std::vector<double>> point_masses(const Energy& energy, const Eigen::VectorXd& mass, int first,
                                                        int count) {
  if (energy.find("mass") == nullptr || energy.find("mass")->role != Role::rest) return {};
  return {{"mass", std::vector<double>(mass.data() + first, mass.data() + first + count)}};
}

Potential object_potential(const UsedLaw& law, const Kernel& kernel, const Body& body, const Eigen::Matrix3Xd& X,
                           const Eigen::VectorXd& mass) {
  const int first = body.first_vertex, count = body.ordered.vertices();
  if (law.energy->kind == Energy::Kind::density)
    return Potential::on_mesh(law.energy->name, kernel, body.ordered, first, law.params, body.quadrature);
  if (law.energy->geometry == "edge")
    return Potential::on_stencils(law.energy->name, kernel, edges_of(body), X, law.params, {});
  return Potential::on_stencils(law.energy->name, kernel, points_of(first, count), X, law.params,
                                point_masses(*law.energy, mass, first, count));
}

// Densities of solids live on solids, and so on.
void check_geometries(const Scene& scene, const std::vector<std::vector<UsedLaw>>& used,
                      const std::vector<Body>& bodies) {
  const char* geometries[] = {"point", "line", "membrane", "solid"};
  for (size_t i = 0; i < used.size(); ++i) {
    const Element element = bodies[i].ordered.element;
    const std::string geometry = geometries[dimension_of(element)];
    for (size_t k = 0; k < used[i].size(); ++k) {
      const Energy& energy = *used[i][k].energy;
      if (energy.kind != Energy::Kind::density || energy.geometry == geometry) continue;
      throw SourceError(scene.objects[i].energies[k].at("law"),
                        fmt::format("{} is a density of a {}; object '{}' is a {} of {} cells", energy.name,
                                    energy.geometry, bodies[i].name, geometry, name_of(element)));
    }
  }
}

void add_object(const SceneObject& object, const std::vector<UsedLaw>& laws, const Body& body, const Kernels& kernels,
                BuiltScene& out) {
  for (size_t i = 0; i < laws.size(); ++i) try {
      out.system->add(object_potential(laws[i], kernels.get(*laws[i].energy), body, out.start.x, out.mass));
    } catch (const InputError& bad) {
      throw SourceError(object.energies[i].place, fmt::format("object '{}': {}", object.name, bad.what()));
    }
}

void add_world(const Scene& scene, const WorldLaws& world, const Kernels& kernels, BuiltScene& out) {
  const Eigen::Matrix3Xd& X = out.start.x;
  const int n = out.system->vertices();
  out.system->add(Potential::on_stencils("inertia", kernels.get(*world.inertia), points_of(0, n), X, {},
                                         point_masses(*world.inertia, out.mass, 0, n)));
  if (world.gravity != nullptr)
    out.system->add(Potential::on_stencils("gravity", kernels.get(*world.gravity), points_of(0, n), X,
                                           {{"g", {scene.gravity.begin(), scene.gravity.end()}}},
                                           point_masses(*world.gravity, out.mass, 0, n)));
  if (world.barrier == nullptr) return;
  GroundLaws laws;
  laws.barrier = kernels.get(*world.barrier);
  if (world.friction != nullptr) laws.friction = kernels.get(*world.friction);
  std::vector<Ground> grounds;
  for (const SceneGround& g : scene.grounds)
    grounds.push_back({vector(g.normal), g.height, g.dhat, g.mu, g.epsv, g.stiffness.value_or(0)});
  std::vector<int> surface;
  for (const Body& body : out.bodies)
    for (int vertex : body.surface) surface.push_back(body.first_vertex + vertex);
  out.ground = std::make_unique<GroundContact>(*out.system, grounds, laws, surface, X, out.mass, vector(scene.gravity));
}

StepOptions step_options(const Scene& scene) {
  StepOptions out;
  out.dt = scene.time.dt;
  out.tolerance = scene.solver.tolerance;
  out.max_iterations = scene.solver.max_iterations;
  out.friction_lag_iterations = scene.solver.friction_iterations;
  out.friction_tolerance = scene.solver.friction_tolerance;
  out.projection = scene.solver.projection == "none"       ? Projection::none
                   : scene.solver.projection == "absolute" ? Projection::absolute
                                                           : Projection::clamp;
  out.project_on_demand = scene.solver.projection == "progressive";
  out.accept_unconverged = scene.solver.accept_unconverged;
  return out;
}

// All bodies one after the other: positions, masses, velocities, fixed vertices.
void lay_out(const Scene& scene, BuiltScene& out) {
  int vertices = 0;
  for (Body& body : out.bodies) {
    body.first_vertex = vertices;
    vertices += body.ordered.vertices();
  }
  out.start.x.resize(3, vertices);
  out.start.v.resize(3, vertices);
  out.mass.resize(vertices);
  std::vector<char> fixed(static_cast<size_t>(vertices), 0);
  for (size_t i = 0; i < out.bodies.size(); ++i) {
    const Body& body = out.bodies[i];
    const int first = body.first_vertex, count = body.ordered.vertices();
    out.start.x.middleCols(first, count) = body.ordered.X;
    out.start.v.middleCols(first, count).colwise() = vector(scene.objects[i].velocity);
    out.mass.segment(first, count) = lumped_masses(body.ordered, scene.objects[i].density * body.section);
    for (int vertex : body.fixed) {
      fixed[static_cast<size_t>(first + vertex)] = 1;
      out.start.v.col(first + vertex).setZero();
    }
  }
  if (std::find(fixed.begin(), fixed.end(), 0) == fixed.end())
    throw SourceError(scene.objects.front().at("fixed"), "every vertex of the scene is fixed: nothing can move");
  out.system = std::make_unique<System>(vertices);
  out.system->set_fixed(fixed);
}

}  // namespace

BuiltScene build_scene(const Scene& scene, const Catalogue& catalogue, const KernelSource& kernel_source) {
  BuiltScene out;
  const std::string folder = std::filesystem::path(scene.file).parent_path().string();
  Laws laws(catalogue, folder);
  Kernels kernels;
  std::vector<std::vector<UsedLaw>> used;
  WorldLaws world;
  {
    Stopwatch watch(out.seconds.energies);
    for (const SceneObject& object : scene.objects) used.push_back(object_laws(object, laws));
    world = world_laws(scene, laws, out.skipped);
    out.warnings = law_warnings(scene, used);
  }
  {
    Stopwatch watch(out.seconds.meshes);
    for (const SceneObject& object : scene.objects) out.bodies.push_back(load_body(object, folder));
    check_geometries(scene, used, out.bodies);
    lay_out(scene, out);
    check_start(scene, out.bodies);
  }
  {
    Stopwatch watch(out.seconds.kernels);
    for (const auto& object : used)
      for (const UsedLaw& law : object) kernels.want(law.energy);
    for (const Energy* law : {world.inertia, world.gravity, world.barrier, world.friction}) kernels.want(law);
    kernels.load(kernel_source);
  }
  {
    Stopwatch watch(out.seconds.setup);
    for (size_t i = 0; i < used.size(); ++i) add_object(scene.objects[i], used[i], out.bodies[i], kernels, out);
    add_world(scene, world, kernels, out);
  }
  out.step = step_options(scene);
  // An end that is a multiple of dt up to rounding takes no step more.
  out.steps = scene.time.steps ? *scene.time.steps
                               : std::max(1L, static_cast<long>(std::ceil(*scene.time.end / scene.time.dt - 1e-6)));
  return out;
}

}  // namespace ergon
