// ergon cost ENERGY: what its kernel computes and moves, per entry point and per element.

#include <fmt/format.h>

#include <memory>
#include <ostream>

#include "runtime/lanes/lanes.h"
#include "runtime/mesh/quadrature.h"
#include "tools/command.h"
#include "tools/installation.h"
#include "tools/rows.h"

namespace ergon {
namespace {

struct Options {
  std::string energy, case_name;
  bool json = false;
};

// One element, or one stencil: `points` vertices and `calls` evaluations of the kernel, each with `weights` numbers for
// every vector of q.
Row element_row(const Generated& kernel, const std::string& name, int points, int calls, int weights) {
  constexpr int number = 8, index = 4, block = 9 * number;
  const Module& m = kernel.module;
  const bool density = m.points == 0;
  const int weights_bytes = density ? calls * (m.q_vectors * weights + 1) * number : 0;  // and the volume
  return {{"element", name},
          {"kernel_calls", calls},
          {"operations", calls * operations_when_projected(kernel.costs)},
          {"weights_bytes", weights_bytes},
          {"data_bytes", kernel.counts.elements * number},
          {"positions_bytes", points * (index + 3 * number)},
          {"gradient_bytes", points * 3 * number},
          {"matrix_bytes", m.zero_hessian ? 0 : points * (points + 1) / 2 * block}};
}

std::vector<Row> element_rows(const Generated& kernel) {
  const Energy& energy = *kernel.module.energy;
  if (energy.kind == Energy::Kind::stencil) return {element_row(kernel, energy.geometry, kernel.module.points, 1, 0)};
  std::vector<Row> rows;
  const int dimension = energy.symbols[0].shape.cols;
  for (Element element : all_elements()) {
    if (dimension_of(element) != dimension) continue;
    // The gradients of all shape functions but one, or where they vary the inverse of the map to the rest shape.
    const int weights = has_constant_gradients(element) ? nodes_of(element) - 1 : dimension;
    rows.push_back(element_row(kernel, name_of(element), nodes_of(element),
                               static_cast<int>(default_quadrature(element).points.size()), weights));
  }
  return rows;
}

Row with_names(const Energy& energy, const std::string& case_name, const Row& fields) {
  Row row = {{"energy", energy.name}, {"case", case_name}};
  row.update(fields);
  return row;
}

Row entry_row(const EntryCost& c) {
  return {
      {"entry", c.entry}, {"operations", c.operations}, {"divisions", c.divisions},         {"roots", c.roots},
      {"calls", c.calls}, {"bytes_in", c.bytes_in},     {"bytes_uniform", c.bytes_uniform}, {"bytes_out", c.bytes_out}};
}

int cost(const Options& options, std::ostream& out) {
  const Energy energy = find_energy(options.energy);
  for (const std::string& name : cases_of(energy, options.case_name)) {
    const Generated kernel = generate(energy, compile_options(name, lanes::best_lanes()));
    if (options.json) {
      Rows entries(out, true);
      for (const EntryCost& c : kernel.costs) entries.add(with_names(energy, name, entry_row(c)));
      for (const Row& row : element_rows(kernel)) entries.add(with_names(energy, name, row));
      continue;
    }
    const bool density = energy.kind == Energy::Kind::density;
    out << fmt::format("{}{}: per {}\n", energy.name, name.empty() ? "" : ", case " + name,
                       density ? "point of quadrature" : "stencil")
        << cost_table(kernel.costs, "  ")
        << fmt::format("per {}, value, gradient and projected Hessian\n", density ? "element" : "stencil");
    Rows elements(out, false);
    for (const Row& row : element_rows(kernel)) elements.add(row);
  }
  return exit_done;
}

}  // namespace

void add_cost_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("cost", "Counts what an energy's kernel computes and moves");
  auto options = std::make_shared<Options>();
  command->add_option("energy", options->energy, "an .energy file, or a name in the catalogue")->required();
  command->add_option("--case", options->case_name, "this case only");
  command->add_flag("--json", options->json, "one JSON object per entry point and element instead of tables");
  command->callback([options, &run] { run = [options](std::ostream& out) { return cost(*options, out); }; });
}

}  // namespace ergon
