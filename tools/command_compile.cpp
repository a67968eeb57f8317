// ergon compile: energies become kernel libraries in a cache.

#include <fmt/format.h>

#include <memory>
#include <ostream>

#include "codegen/compile_all.h"
#include "runtime/error.h"
#include "runtime/lanes/lanes.h"
#include "tools/choices.h"
#include "tools/command.h"
#include "tools/installation.h"

namespace ergon {
namespace {

struct Options {
  std::string energy, catalogue, dump, precision = "double";
};

const std::vector<std::string> passes = {"lower",     "rest",  "frontier", "differentiate", "structure",
                                         "principal", "parts", "schedule", "emit"};

int compile_one(const Options& asked, std::ostream& out) {
  if (!asked.dump.empty()) chosen("--dump", asked.dump, passes);
  const Energy energy = find_energy(asked.energy);
  for (const std::string& case_name : cases_of(energy)) {
    const bool single = chosen("--precision", asked.precision, {"double", "float"}) == 1;
    const int lanes = single ? lanes::best_single_lanes() : lanes::best_lanes();
    CompileOptions options = compile_options(case_name, lanes, single);
    if (!asked.dump.empty()) {
      options.dump = [&](const std::string& pass, const std::string& text) {
        if (pass == asked.dump) out << text;
      };
      generate(energy, options);
      continue;
    }
    const CompiledKernel kernel = compile(energy, options);
    out << fmt::format(
        "{}{}{}: {} lanes{}; operations: value {}, gradient {}, hessian {} ({} divisions); {} in {:.2f} s\n",
        energy.name, case_name.empty() ? "" : "/", case_name, options.lanes, single ? " of floats" : "",
        kernel.counts.value, kernel.counts.gradient, kernel.counts.hessian, kernel.counts.divisions,
        kernel.cached ? "cached, checked" : "compiled", kernel.times.total());
  }
  return exit_done;
}

int compile_catalogue(const std::string& folder, std::ostream& out) {
  std::vector<Energy> energies;
  for (const std::string& name : catalogue_names()) energies.push_back(find_energy(name));
  std::vector<CompileJob> jobs;
  for (const Energy& energy : energies) {
    for (const std::string& case_name : cases_of(energy)) {
      for (int lanes : lanes::kWidths) {
        CompileOptions options;
        options.case_name = case_name;
        options.lanes = lanes;
        options.cache = folder;
        jobs.push_back({&energy, options});
      }
    }
  }
  int built = 0, found = 0;
  for (const CompiledKernel& kernel : kernels_of(compile_all(jobs))) ++(kernel.cached ? found : built);
  out << fmt::format("{}: {} kernels compiled, {} already there\n", folder, built, found);
  return exit_done;
}

}  // namespace

void add_compile_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("compile", "Compiles an energy, or the whole catalogue, to kernels");
  auto options = std::make_shared<Options>();
  auto* energy = command->add_option("energy", options->energy, "a name in the catalogue, or an .energy file");
  auto* catalogue =
      command->add_option("--catalogue", options->catalogue, "folder: compile every energy, all widths, to it");
  command
      ->add_option("--dump", options->dump,
                   "print the graph after a pass: " + fmt::format("{}", fmt::join(passes, ", ")))
      ->excludes(catalogue);
  command
      ->add_option("--precision", options->precision, "of the kernel: double or float; the catalogue is made in double")
      ->excludes(catalogue);
  energy->excludes(catalogue);
  command->callback([options, &run] {
    run = [options](std::ostream& out) {
      if (options->energy.empty() == options->catalogue.empty()) {
        throw InputError("'ergon compile' needs an energy, or --catalogue FOLDER");
      }
      return options->catalogue.empty() ? compile_one(*options, out) : compile_catalogue(options->catalogue, out);
    };
  });
}

}  // namespace ergon
