#include "scenes/builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

#include "runtime/error.h"
#include "runtime/mesh/mesh_tools.h"
#include "runtime/solver/stopwatch.h"
#include "scenes/build_affine.h"
#include "scenes/build_attachment.h"
#include "scenes/build_contact.h"
#include "scenes/build_mass.h"
#include "scenes/build_normals.h"
#include "scenes/build_twist.h"
#include "scenes/held_check.h"
#include "scenes/laws.h"
#include "scenes/object_laws.h"
#include "scenes/start_check.h"
#include "scenes/start_noise.h"
#include "scenes/surface_check.h"
#include "scenes/used_kernels.h"
#include "symbolic/checks.h"

namespace ergon {
namespace {

Eigen::Vector3d vector(const Vector3& v) { return {v[0], v[1], v[2]}; }

// The laws of the scene itself: null where a scene does not need one.
struct WorldLaws {
  const Energy* inertia = nullptr;
  const Energy* gravity = nullptr;
  const Energy* orthogonality = nullptr;
  const Energy* load = nullptr;
  const Energy* drag = nullptr;
  ContactLaws contact;
};

WorldLaws world_laws(const Scene& scene, Laws& laws, std::vector<std::string>& skipped) {
  const Place whole{scene.file, 0, 0};
  WorldLaws out;
  if (scene.time.quasi_static())
    skipped.push_back("inertia: a quasi-static scene has none");
  else
    out.inertia = &laws.get("inertia", whole);
  if (vector(scene.gravity).isZero(0))
    skipped.push_back("gravity: it is zero in this scene, no kernel loaded");
  else
    out.gravity = &laws.get("gravity", whole);
  if (std::any_of(scene.objects.begin(), scene.objects.end(), [](const SceneObject& o) { return o.affine(); }))
    out.orthogonality = &laws.get("affine_orthogonality", whole);
  if (std::any_of(scene.objects.begin(), scene.objects.end(), [](const SceneObject& o) { return !o.loads.empty(); }))
    out.load = &laws.get("dead_load", whole);
  if (std::any_of(scene.objects.begin(), scene.objects.end(),
                  [](const SceneObject& o) { return o.mass_damping > 0; })) {
    if (scene.time.quasi_static())
      skipped.push_back("mass damping: a quasi-static scene has none");
    else
      out.drag = &laws.get("drag", whole);
  }
  out.contact = contact_laws(scene, laws, skipped);
  return out;
}

// What is unsound in the scene's own energies, each checked once.
std::vector<std::string> law_warnings(const Scene& scene, const std::vector<std::vector<UsedLaw>>& used,
                                      const std::vector<UsedAttachment>& attachments) {
  std::vector<std::string> out;
  std::set<const Energy*> checked;
  const auto check = [&](const Energy& energy, const EnergyUse& use) {
    if (!use.wrote("text") && !use.law.ends_with(".energy")) return;
    if (!checked.insert(&energy).second) return;
    for (const Finding& finding : check_energy(energy))
      if (finding.severity >= Severity::warning) out.push_back(to_string(finding));
  };
  for (size_t i = 0; i < used.size(); ++i)
    for (size_t j = 0; j < used[i].size(); ++j) check(*used[i][j].declared, scene.objects[i].energies[j]);
  for (size_t i = 0; i < attachments.size(); ++i) check(*attachments[i].law.declared, scene.attachments[i]);
  return out;
}

void add_loads(const Scene& scene, const Kernel& kernel, BuiltScene& out) {
  for (size_t i = 0; i < scene.objects.size(); ++i)
    for (size_t k = 0; k < scene.objects[i].loads.size(); ++k) {
      const SceneLoad& load = scene.objects[i].loads[k];
      const LoadShares& on = out.bodies[i].loads[k];
      const Eigen::Vector3d force = vector(load.force) + on.measure * vector(load.traction);
      std::vector<int> points;
      std::vector<double> shares;
      for (int v = 0; v < on.shares.size(); ++v) {
        if (on.shares[v] == 0) continue;
        points.push_back(out.bodies[i].first_vertex + v);
        shares.push_back(on.shares[v]);
      }
      const int index = out.system->add(Potential::on_stencils(
          "load", kernel, points, out.start.x, {{"force", {force[0], force[1], force[2]}}}, {{"share", shares}}));
      add_load(scene, index, "force", {force[0], force[1], force[2]}, out);
    }
}

void add_world(const Scene& scene, const WorldLaws& world, const UsedKernels& kernels, BuiltScene& out) {
  if (world.orthogonality != nullptr) add_affine_potentials(scene, kernels.get(*world.orthogonality), out);
  if (world.inertia != nullptr) add_inertia(kernels.get(*world.inertia), out);
  if (world.gravity != nullptr) add_gravity(scene, kernels.get(*world.gravity), out);
  if (world.load != nullptr) add_loads(scene, kernels.get(*world.load), out);
  if (world.drag != nullptr) add_mass_damping(scene, kernels.get(*world.drag), out);
  add_contact(scene, world.contact, kernels, out);
}

// A Newton step of this part of the speed below which friction is static tells sliding from sticking where the force
// exceeds that of friction by (part)^2 of it, a quarter of a percent: near the limit of static friction, at w*epsv, the
// step is (excess + (1 - w)^2)/(2*(1 - w))*epsv, at least sqrt(excess)*epsv.
constexpr double friction_tolerance = 0.05;

constexpr double newton_part = 0.01;  // of the tolerance of a step

double tolerance(const Scene& scene) {
  double out = scene.solver.tolerance;
  for (const SceneGround& ground : scene.grounds)
    if (ground.mu > 0) out = std::min(out, friction_tolerance * ground.epsv);
  if (scene.contact && has_friction(*scene.contact)) out = std::min(out, friction_tolerance * scene.contact->epsv);
  // Newton's method is to add little to the error that is tolerated.
  if (scene.time.tolerance) out = std::min(out, newton_part * *scene.time.tolerance / scene.time.dt);
  return out;
}

constexpr double least_part = 1e-3;  // of dt: the shortest step of load, unless the scene says which

StepOptions step_options(const Scene& scene) {
  StepOptions out;
  out.dt = scene.time.dt;
  out.integrator = scene.integrator();
  out.creates_no_energy = scene.time.integrator == "automatic";
  out.tolerance = tolerance(scene);
  out.max_iterations = scene.solver.max_iterations;
  out.friction_lag_iterations = scene.solver.friction_iterations;
  out.friction_tolerance = scene.solver.friction_tolerance;
  out.record_forces = scene.output.forces;
  out.projection = scene.solver.projection == "none"       ? Projection::none
                   : scene.solver.projection == "absolute" ? Projection::absolute
                                                           : Projection::clamp;
  out.project_on_demand = scene.solver.projection == "progressive";
  out.accept_unconverged = scene.solver.accept_unconverged;
  return out;
}

std::optional<StepLimits> step_limits(const Scene& scene, long steps) {
  const TimeSettings& time = scene.time;
  if (!time.quasi_static() && !time.min_dt && !time.tolerance) return std::nullopt;
  StepLimits out{.largest = time.dt, .smallest = time.min_dt.value_or(least_part * time.dt), .interval = time.dt};
  if (scene.output.frame_interval > 0) out.interval = scene.output.frame_interval;
  if (time.tolerance) out.tolerance = *time.tolerance;
  out.end = static_cast<double>(steps) * time.dt;
  return out;
}

// `shapes`: of the vertices.
void add_script(const BodyScript& script, std::vector<int> vertices, const std::vector<ScriptShape>& shapes,
                BuiltScene& out) {
  std::vector<ScriptKey> keys;
  for (const MotionKey& key : script.keys) keys.push_back({key.time, vector(key.translate), vector(key.rotate)});
  out.script.add(std::move(vertices), out.start.x, script.center, std::move(keys), shapes);
}

// Places that move with a body: carried, or held and scripted as it is.
void start_places(const Eigen::Vector3d& velocity, const Body& body, BuiltScene& out, std::vector<char>& fixed) {
  std::vector<int> vertices(body.places.size());
  std::iota(vertices.begin(), vertices.end(), body.first_place);
  for (size_t i = 0; i < vertices.size(); ++i) {
    out.start.x.col(vertices[i]) = body.places[i];
    if (body.affine()) out.start.v.col(vertices[i]) = velocity;
    fixed[static_cast<size_t>(vertices[i])] = body.affine() ? 0 : 1;
  }
  if (!body.affine() && !vertices.empty() && !body.scripts.empty()) add_script(body.scripts[0], vertices, {}, out);
}

// All bodies one after the other: positions, masses, velocities, fixed vertices.
void lay_out(const Scene& scene, BuiltScene& out) {
  int vertices = 0;
  for (Body& body : out.bodies) {
    body.first_vertex = vertices;
    vertices += body.ordered.vertices();
  }
  for (Body& body : out.bodies) {
    if (!body.affine()) continue;
    body.first_control = vertices;
    vertices += 4;
  }
  for (Body& body : out.bodies) {
    body.first_place = vertices;
    vertices += static_cast<int>(body.places.size());
  }
  out.points = vertices;
  for (Body& body : out.bodies) {
    body.first_twist = vertices;
    vertices += body.twists() ? body.ordered.cell_count() : body.tips;
  }
  out.start.x.resize(3, vertices);
  out.start.v.setZero(3, vertices);
  out.mass.setZero(vertices);
  std::vector<char> fixed(static_cast<size_t>(vertices), 0);
  std::vector<Guide> guides;
  for (size_t i = 0; i < out.bodies.size(); ++i) {
    const Body& body = out.bodies[i];
    const int first = body.first_vertex, count = body.ordered.vertices();
    out.start.x.middleCols(first, count) = body.ordered.X;
    if (i < scene.objects.size()) {
      out.start.v.middleCols(first, count).colwise() = vector(scene.objects[i].velocity);
      if (!scene.objects[i].affine())
        out.mass.segment(first, count) = lumped_masses(body.ordered, scene.objects[i].density * body.section);
      if (body.affine()) start_affine(scene.objects[i], body, out);
      start_twist(scene.objects[i], body, out, fixed, guides);
      start_normals(scene.objects[i], body, out, fixed);
    }
    const auto hold = [&](const std::vector<int>& vertices) {
      for (int vertex : vertices) {
        fixed[static_cast<size_t>(first + vertex)] = 1;
        out.start.v.col(first + vertex).setZero();
      }
    };
    hold(body.fixed);
    for (const Guide& guide : body.guides) guides.push_back({first + guide.vertex, guide.along});
    for (const BodyScript& script : body.scripts) {
      hold(script.vertices);
      std::vector<int> scripted = script.vertices;
      for (int& vertex : scripted) vertex += first;
      add_script(script, std::move(scripted), script.shapes, out);
      if (const std::vector<int> tips = tips_of(script, body); !tips.empty()) {
        add_script(script, tips, {}, out);
        for (const int tip : tips) fixed[static_cast<size_t>(tip)] = 1;
        for (const int tip : tips) out.start.v.col(tip).setZero();
      }
      follow_twist(script, body, out, fixed);
    }
    start_places(i < scene.objects.size() ? vector(scene.objects[i].velocity) : Eigen::Vector3d::Zero(), body, out,
                 fixed);
  }
  if (std::find(fixed.begin(), fixed.end(), 0) == fixed.end())
    throw SourceError(scene.objects.front().at(scene.objects.front().wrote("fixed") ? "fixed" : "scripted"),
                      "every vertex of the scene is fixed: nothing can move");
  out.system = std::make_unique<System>(vertices);
  out.system->set_fixed(fixed);
  out.system->set_carriers(carriers_of(out.bodies));
  out.system->set_guides(std::move(guides));
  add_start_noise(scene.start, out.bodies, scene.objects.size(), *out.system, out.start.x, out.start.v);
  out.system->guide(out.start.v);
  out.coupled_mass = coupled_mass_of(scene, out.bodies, vertices);
  if (!scene.time.quasi_static()) out.system->set_coupled_mass(out.coupled_mass);
}

std::vector<Probe> probes_of(const Scene& scene, const BuiltScene& built) {
  std::vector<Probe> out;
  for (const SceneProbe& probe : scene.probes) {
    const auto is_it = [&](const Body& body) { return body.name == probe.object; };
    const Body& body = *std::find_if(built.bodies.begin(), built.bodies.end(), is_it);
    Eigen::Index nearest = 0;
    (body.ordered.X.colwise() - vector(probe.near)).colwise().squaredNorm().minCoeff(&nearest);
    out.push_back({probe.name, body.first_vertex + static_cast<int>(nearest)});
  }
  return out;
}

}  // namespace

Eigen::VectorXd BuiltScene::mass_of_points() const {
  Eigen::VectorXd out = mass;
  out.tail(mass.size() - points).setZero();
  return out;
}

Eigen::VectorXd BuiltScene::mass_shares() const {
  Eigen::VectorXd out = mass_of_points();
  for (int v = 0; !coupled_mass.empty() && v < points; ++v)
    if (coupled_mass.couples(v)) out[v] = coupled_mass.mass.row(v).sum();
  return out;
}

void add_load(const Scene& scene, int potential, const std::string& param, std::vector<double> full, BuiltScene& out) {
  if (scene.time.quasi_static()) out.loads.push_back({potential, param, std::move(full)});
}

TimeStepper stepper_of(BuiltScene& built) {
  TimeStepper stepper(*built.system, built.mass, built.contacts.get(), built.step, built.script);
  if (!built.loads.empty()) stepper.grow_loads(built.loads, static_cast<double>(built.steps) * built.step.dt);
  if (!built.constraints.empty()) stepper.keep_constraints(built.constraints);
  return stepper;
}

BuiltScene build_scene(const Scene& scene, const Catalogue& catalogue, const KernelSource& kernel_source,
                       const FaultReport& report) {
  BuiltScene out;
  const std::string folder = std::filesystem::path(scene.file).parent_path().string();
  Laws laws(catalogue, folder);
  UsedKernels kernels;
  std::vector<std::vector<UsedLaw>> used;
  std::vector<UsedAttachment> attachments;
  WorldLaws world;
  {
    Stopwatch watch(out.seconds.energies);
    for (const SceneObject& object : scene.objects) used.push_back(object_laws(object, laws));
    attachments = attachment_laws(scene, laws);
    world = world_laws(scene, laws, out.skipped);
    out.warnings = law_warnings(scene, used, attachments);
  }
  {
    Stopwatch watch(out.seconds.meshes);
    for (const SceneObject& object : scene.objects) out.bodies.push_back(load_body(object, folder));
    for (const SceneObstacle& obstacle : scene.obstacles) out.bodies.push_back(load_obstacle(obstacle, folder));
    for (size_t i = 0; i < used.size(); ++i) {
      check_geometry(scene.objects[i], used[i], out.bodies[i]);
      set_twist(scene.objects[i], used[i], out.bodies[i]);
      set_normals(used[i], out.bodies[i]);
      place_fields(scene.objects[i], out.bodies[i], folder, used[i]);
    }
    add_places(scene, out.bodies, attachments);
    lay_out(scene, out);
    join(scene, out, folder, attachments);
    out.probes = probes_of(scene, out);
    check_start(scene, out.bodies);
  }
  {
    Stopwatch watch(out.seconds.kernels);
    for (const auto& object : used)
      for (const UsedLaw& law : object) kernels.want(law.energy);
    for (const UsedAttachment& attachment : attachments) kernels.want(attachment.law.energy);
    kernels.want(world.inertia);
    kernels.want(world.gravity);
    kernels.want(world.orthogonality);
    kernels.want(world.load);
    kernels.want(world.drag);
    want_kernels(world.contact, kernels);
    kernels.load(kernel_source);
  }
  {
    Stopwatch watch(out.seconds.setup);
    for (size_t i = 0; i < used.size(); ++i) add_object(scene, scene.objects[i], used[i], kernels, i, out);
    add_attachments(scene, attachments, kernels, out);
    add_world(scene, world, kernels, out);
    if (out.surfaces != nullptr) check_surface_start(scene, out, report);
  }
  out.step = step_options(scene);
  out.step.points = out.points;
  // An end that is a multiple of dt up to rounding takes no step more.
  out.steps = scene.time.steps ? *scene.time.steps
                               : std::max(1L, static_cast<long>(std::ceil(*scene.time.end / scene.time.dt - 1e-6)));
  out.limits = step_limits(scene, out.steps);
  if (scene.time.quasi_static()) check_held(scene, out);
  return out;
}

}  // namespace ergon
