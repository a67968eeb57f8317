// ergon eval ENERGY: value and derivatives of any energy on any mesh and state, to hold other programs against.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <ostream>

#include "runtime/error.h"
#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_import.h"
#include "runtime/mesh/mesh_stencils.h"
#include "symbolic/reference.h"
#include "tools/assignments.h"
#include "tools/choices.h"
#include "tools/command.h"
#include "tools/installation.h"
#include "tools/matrix_market.h"
#include "tools/positions.h"
#include "tools/problem.h"
#include "tools/rows.h"

namespace ergon {
namespace {

struct Options {
  std::string energy, case_name, mesh, positions, projection = "clamp", precision = "double", gradient_file,
                                                  hessian_file;
  std::vector<std::string> set;
  int threads = 1;
  bool json = false;
};

std::string only_case(const Energy& energy, const std::string& asked) {
  const std::vector<std::string> cases = cases_of(energy, asked);
  if (cases.size() == 1) return cases.front();
  throw InputError(fmt::format("{} has the cases {}; choose one with --case", energy.name, fmt::join(cases, ", ")));
}

Mesh read_any_mesh(const std::string& path) { return path.ends_with(".msh") ? read_mesh(path) : read_surface(path); }

// Of the whole symmetric matrix.
double frobenius(const BlockMatrix& matrix) {
  double sum = 0;
  for (int column = 0; column < matrix.rows(); ++column) {
    const auto first = static_cast<size_t>(matrix.column_start()[static_cast<size_t>(column)]);
    const auto last = static_cast<size_t>(matrix.column_start()[static_cast<size_t>(column) + 1]);
    for (size_t k = first; k < last; ++k) {
      const int row = matrix.row_index()[k];
      if (row >= column) sum += (row == column ? 1 : 2) * matrix.values()[k] * matrix.values()[k];
    }
  }
  return std::sqrt(sum);
}

// One stencil, or one point of quadrature, whose state is given by --set: as the text means it, in 50 digits.
int eval_state(const Options& options, std::ostream& out) {
  const Energy energy = find_energy(options.energy);
  const std::string case_name = only_case(energy, options.case_name);
  const Values values = read_assignments(energy, options.set, true);
  for (const Symbol& symbol : energy.symbols) {
    if (values.contains(symbol.name)) continue;
    throw InputError(fmt::format("without --mesh every input is given by --set; '{}' is missing", symbol.name));
  }
  const ReferenceValue found = evaluate_reference(energy, case_name, values);
  auto norm = [](const std::vector<double>& x) {
    return Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())).norm();
  };
  auto smallest = [](const std::vector<double>& x) {
    return x.empty() ? std::numeric_limits<double>::infinity() : *std::min_element(x.begin(), x.end());
  };
  Rows(out, options.json)
      .add({{"value", found.value},
            {"gradient_norm", norm(found.gradient)},
            {"hessian_frobenius", norm(found.hessian)},
            {"require", smallest(found.require)},
            {"active", smallest(found.active)}});
  return exit_done;
}

int eval(const Options& options, std::ostream& out) {
  if (options.mesh.empty()) return eval_state(options, out);
  const Projection projection = projection_named(options.projection);
  const Energy energy = find_energy(options.energy);
  const std::string case_name = only_case(energy, options.case_name);
  const Values values = read_assignments(energy, options.set);
  const Mesh mesh = read_any_mesh(options.mesh);
  const Eigen::Matrix3Xd x = options.positions.empty() ? mesh.X : read_positions(options.positions, mesh.vertices());
  set_threads(options.threads);

  const Precision precision = precision_named(options.precision);
  const Kernel exact = load_kernel(energy, case_name, lanes::best_lanes());
  const Kernel kernel = load_kernel(energy, case_name, lanes::best_lanes(), precision);
  const bool density = energy.kind == Energy::Kind::density;
  const std::vector<int> stencils =
      density ? std::vector<int>()
              : active_stencils(energy, exact, mesh, stencils_on_mesh(energy.geometry, mesh), values, x);
  System system = make_system(energy, kernel, mesh, stencils, values);
  const Evaluation state = system.value(x);
  if (!(state.require > 0) || !std::isfinite(state.value)) {
    throw InputError(fmt::format(
        "{}: {} is not defined at these positions: a `require` condition does not hold, or its value is not finite",
        options.positions.empty() ? options.mesh : options.positions, energy.name));
  }
  Eigen::Matrix3Xd gradient;
  BlockMatrix hessian;
  const Evaluation evaluation = system.hessian(x, projection, gradient, hessian);
  if (!options.gradient_file.empty()) write_matrix_market(options.gradient_file, gradient);
  if (!options.hessian_file.empty()) write_matrix_market(options.hessian_file, hessian);
  Rows(out, options.json)
      .add({{"value", evaluation.value},
            {"gradient_norm", gradient.norm()},
            {"hessian_frobenius", frobenius(hessian)},
            {"elements", system.potential(0).stencil_count()},
            {"indefinite", evaluation.indefinite}});
  return exit_done;
}

}  // namespace

void add_eval_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("eval", "Evaluates an energy with its derivatives on a mesh");
  auto options = std::make_shared<Options>();
  command->add_option("energy", options->energy, "a name in the catalogue, or an .energy file")->required();
  command->add_option("--mesh", options->mesh,
                      "rest state: .msh, or a surface .obj, .stl, .ply; without: one state given by --set");
  command->add_option("--positions", options->positions, "text file, 'x y z' (m) per vertex; default: the rest state");
  command
      ->add_option("--set", options->set,
                   "NAME=VALUE of a param, rest or lag, without a mesh of a dof too; may be repeated")
      ->take_all();
  command->add_option("--case", options->case_name, "case of the energy, when it has several");
  command->add_option("--project", options->projection, "negative eigenvalues: clamp, abs or none");
  command->add_option("--precision", options->precision, "double, float, or mixed: floats for the Hessian alone");
  command->add_option("--gradient", options->gradient_file, "Matrix Market file to write");
  command->add_option("--hessian", options->hessian_file, "Matrix Market file to write");
  command->add_option("--threads", options->threads, "threads to use");
  command->add_flag("--json", options->json, "one JSON object instead of a table");
  command->callback([options, &run] { run = [options](std::ostream& out) { return eval(*options, out); }; });
}

}  // namespace ergon
