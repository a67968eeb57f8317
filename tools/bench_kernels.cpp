#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "runtime/error.h"
#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_stencils.h"
#include "runtime/mesh/quadrature.h"
#include "tools/assignments.h"
#include "tools/bench.h"
#include "tools/choices.h"
#include "tools/installation.h"
#include "tools/median.h"
#include "tools/problem.h"
#include "tools/sample.h"
#include "tools/stencils.h"

namespace ergon {
namespace {

// Where an energy is measured: its mesh, and the stencils of a stencil energy.
StencilSample sample_of(const Energy& energy, const std::string& element, int cells) {
  if (energy.kind == Energy::Kind::stencil && element.empty()) return sample_stencils(energy.geometry, cells);
  if (energy.kind == Energy::Kind::stencil) {
    Mesh mesh = sample_mesh(element_named(element), cells);
    std::vector<int> stencils = stencils_on_mesh(energy.geometry, mesh);
    return {std::move(mesh), std::move(stencils)};
  }
  const Element chosen = element.empty() ? default_element(energy) : element_named(element);
  check_element(energy, chosen);
  return {sample_mesh(chosen, cells), {}};
}

// The first sample values at which the energy and its gradient are finite, all `require` conditions hold and the
// `active` ones of some stencil do, with the given ones in their place. Looked for on a small mesh of the same shape.
Values usable_values(const Energy& energy, const Kernel& kernel, const std::string& element, const Values& given) {
  const auto [mesh, stencils] = sample_of(energy, element, 3);
  const Eigen::Matrix3Xd x = displaced(mesh.X, 1.0 / 3, 0.15 / 3);
  constexpr int attempts = 1000;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    Values values = given;
    for (const Symbol* symbol : needed_inputs(energy)) {
      if (!values.contains(symbol->name)) {
        values[symbol->name] = sample_values(energy, symbol->role, attempt).at(symbol->name);
      }
    }
    System system = make_system(energy, kernel, mesh, stencils, values);
    const Evaluation at = system.value(x);
    if (!(at.require > 0) || !std::isfinite(at.value)) continue;
    Eigen::Matrix3Xd gradient;
    system.gradient(x, gradient);
    if (!gradient.allFinite()) continue;
    if (kernel->actives == 0 || !active_stencils(energy, kernel, mesh, stencils, values, x).empty()) return values;
  }
  throw InputError(fmt::format("no inputs of {} were found at which it is defined; give some with --set", energy.name));
}

// Where kernels are measured, on a cube whose cells have this size.
Eigen::Matrix3Xd state_of(const Eigen::Matrix3Xd& X, const std::string& state, double cell) {
  const double sizes[] = {1, 1, 1.1, 0.8}, noise[] = {0, 0.15, 0.02, 0.02};
  const size_t which = chosen("--state", state, {"rest", "noise", "definite", "indefinite"});
  if (which == 0) return X;
  return displaced(X, cell, noise[which] * cell) + (sizes[which] - 1) * X;
}

std::optional<int> exactness_of(const Energy& energy, int asked) {
  if (asked < 0) return std::nullopt;
  if (energy.kind == Energy::Kind::stencil) {
    throw InputError(fmt::format("--quadrature: {} is a stencil energy, which is not integrated", energy.name));
  }
  if (asked > kMaxExactness) throw InputError(fmt::format("--quadrature: 0 to {}, not {}", kMaxExactness, asked));
  return asked;
}

void check_lanes(int given) {
  if (given == 0) return;
  std::string usable;
  for (const int width : lanes::kWidths) {
    if (width > lanes::best_lanes()) break;
    if (width == given) return;
    usable += fmt::format("{}{}", usable.empty() ? "" : ", ", width);
  }
  throw InputError(fmt::format("--lanes: this machine has {}, not {}", usable, given));
}

void bench_case(const Energy& energy, const std::string& case_name, const BenchKernels& options, Rows& rows) {
  const std::vector<std::string> entries = {"value", "gradient", "hessian"};
  if (!options.entry.empty()) chosen("--entry", options.entry, entries);
  const Projection projection = projection_named(options.projection);
  const bool density = energy.kind == Energy::Kind::density;
  const int lanes = options.lanes == 0 ? lanes::best_lanes() : options.lanes;
  const Precision precision = precision_named(options.precision);
  const Kernel exact = load_kernel(energy, case_name, lanes), kernel = load_kernel(energy, case_name, lanes, precision);
  const Values values = usable_values(energy, exact, options.element, read_assignments(energy, options.set));
  auto [mesh, stencils] = sample_of(energy, options.element, options.cells);
  const double cell = 1.0 / options.cells;
  const Eigen::Matrix3Xd x = state_of(mesh.X, options.state, cell);
  if (kernel->actives > 0) stencils = active_stencils(energy, exact, mesh, stencils, values, x);
  System system = make_system(energy, kernel, mesh, stencils, values, exactness_of(energy, options.quadrature));
  Eigen::Matrix3Xd gradient;
  BlockMatrix hessian;

  for (const std::string& entry : entries) {
    if (!options.entry.empty() && entry != options.entry) continue;
    double seconds = 0;
    int operations = 0;
    long changed = 0;
    if (entry == "value") {
      seconds = median_seconds([&] { system.value(x); });
      operations = kernel->operations_value;
    } else if (entry == "gradient") {
      seconds = median_seconds([&] { system.gradient(x, gradient); });
      operations = kernel->operations_gradient;
    } else {
      seconds = median_seconds([&] { changed = system.hessian(x, projection, gradient, hessian).indefinite; });
      // A principal form is evaluated beside the gradient, in place of the Hessian.
      const bool principal = projection != Projection::none && exact->principal != nullptr;
      operations = principal ? kernel->operations_gradient + kernel->operations_principal : kernel->operations_hessian;
    }
    const Potential& potential = system.potential(0);
    const int elements = potential.stencil_count(), points = elements * potential.quadrature_points();
    rows.add({{"energy", case_name.empty() ? energy.name : energy.name + "/" + case_name},
              {"element", density ? name_of(mesh.element) : energy.geometry},
              {"entry", entry},
              {"projection", entry == "hessian" ? options.projection : "none"},
              {"lanes", entry == "hessian" && kernel.curvature ? kernel.curvature->table->lanes : kernel->lanes},
              {"precision", options.precision},
              {"threads", options.threads},
              {"elements", elements},
              {"ns_per_element", seconds * 1e9 / elements},
              {"ns_per_point", seconds * 1e9 / points},
              {"state", options.state},
              {"indefinite", static_cast<double>(changed) / points},
              {"assembled", entry != "value"},
              {"operations", operations}});
  }
}

}  // namespace

void bench_kernels(const BenchKernels& options, Rows& rows) {
  set_threads(options.threads);
  check_lanes(options.lanes);
  for (const std::string& name : options.energies.empty() ? catalogue_names() : options.energies) {
    const Energy energy = find_energy(name);
    for (const std::string& case_name : cases_of(energy)) bench_case(energy, case_name, options, rows);
  }
}

}  // namespace ergon
