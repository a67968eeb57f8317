#pragma once
// From a scene to what can be stepped: energies read and checked, meshes loaded, the kernels that the scene uses
// compiled (and no others), potentials, ground contact, the first state.

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/contact/contacts.h"
#include "runtime/contact/ground.h"
#include "runtime/contact/surface_contact.h"
#include "runtime/output/vtu.h"
#include "runtime/potential.h"
#include "runtime/script.h"
#include "runtime/solver/step_control.h"
#include "runtime/solver/time_step.h"
#include "runtime/system.h"
#include "scenes/body.h"
#include "scenes/catalogue.h"
#include "scenes/scene.h"
#include "symbolic/energy.h"

namespace ergon {

struct KernelRequest {
  const Energy* energy = nullptr;
  std::string case_name;  // "" where the energy has no cases
};
// Compiles or loads kernels, in their order.
using KernelSource = std::function<std::vector<Kernel>(const std::vector<KernelRequest>& requests)>;

struct BuildSeconds {
  double energies = 0;  // read and checked
  double meshes = 0;    // read, filled, reordered, laid out
  double kernels = 0;   // compiled or loaded
  double setup = 0;     // potentials, contact
  double total() const { return energies + meshes + kernels + setup; }
};

struct Probe {
  std::string name;
  int vertex;  // of the system
};

struct BuiltScene {
  std::vector<Body> bodies;  // objects, then obstacles
  std::unique_ptr<System> system;
  std::unique_ptr<Contacts> contacts;  // null where nothing may touch
  GroundContact* ground = nullptr;     // part of contacts; null without grounds
  SurfaceContact* surfaces = nullptr;  // part of contacts; null without [contact]
  Script script;
  Eigen::VectorXd mass;      // kg, per vertex; lumped, and a scale only where it is coupled
  CoupledMass coupled_mass;  // of bodies whose mass is consistent
  int points = 0;            // vertices that are points of space; those behind are twists of edges
  State start;
  std::vector<Probe> probes;
  StepOptions step;
  long steps = 0;                    // of step.dt
  std::optional<StepLimits> limits;  // absent: all steps are of step.dt
  std::vector<Load> loads;           // that grow from 0 at the start to what they are at the end; none: none grows
  std::vector<Constraint> constraints;
  std::vector<std::string> skipped;  // what was left out, "part: reason"
  // Faults of energies that the scene names by file, as check_energy tells them; those of the catalogue are checked by
  // its tests.
  std::vector<std::string> warnings;
  BuildSeconds seconds;

  // kg: without what resists twist.
  Eigen::VectorXd mass_of_points() const;
  // kg: the same as shares of momentum and weight, some of them negative where mass is coupled.
  Eigen::VectorXd mass_shares() const;
};

// Given a mesh of what intersects at the start, before the error that says so.
using FaultReport = std::function<void(const Frame& faults)>;

// Notes that a potential is a load, where loads grow. `full`: of the param that it is in proportion to.
void add_load(const Scene& scene, int potential, const std::string& param, std::vector<double> full, BuiltScene& out);

// A stepper of the scene, its loads included.
TimeStepper stepper_of(BuiltScene& built);

// Throws SourceError at the scene's line, or in an energy file, for everything that does not fit together; all of it
// that can be found without compiling is found before a kernel is asked for. `scene` need not outlive the result.
BuiltScene build_scene(const Scene& scene, const Catalogue& catalogue, const KernelSource& kernels,
                       const FaultReport& report = {});

}  // namespace ergon
