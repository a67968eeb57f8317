// ergon show ENERGY: an energy told back, and what it costs.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <ostream>

#include "runtime/error.h"
#include "runtime/lanes/lanes.h"
#include "scenes/catalogue.h"
#include "symbolic/analyse.h"
#include "symbolic/print.h"
#include "tools/catalogue_page.h"
#include "tools/command.h"
#include "tools/files.h"
#include "tools/installation.h"

namespace ergon {
namespace {

struct Options {
  std::string energy, case_name;
  std::string html;
  bool latex = false, source = false, kernel = false, all = false;
};

// What the structure pass found.
std::string structure_of(const Module& module) {
  if (module.zero_hessian) return "Hessian is zero";
  std::string text = module.constant_hessian ? "Hessian is constant" : "Hessian depends on the state";
  if (module.psd_hessian) text += ", positive semi-definite by construction";
  if (module.changed >= 0) text += ", projected in closed form";
  return text;
}

// The functions of an emitted file, without its header, interface and tables.
std::string functions_of(const std::string& source) {
  const size_t first = source.find("static void prepare_uniforms");
  return source.substr(first, source.find("static const ErgonInput inputs") - first);
}

void show_kernel(const Energy& energy, const std::string& case_name, std::ostream& out) {
  const Generated kernel = generate(energy, compile_options(case_name, lanes::best_lanes()));
  const OperationCounts& n = kernel.counts;
  out << fmt::format(
      "cost{}, operations per {}: value {}, with gradient {}, with Hessian {} ({} divisions, {} square roots, {} other "
      "functions)\n"
      "  {} values once per material, {} per element; {} of {} components is differentiated; {}\n",
      case_name.empty() ? "" : " of case " + case_name,
      energy.kind == Energy::Kind::density ? "point of quadrature" : "stencil", n.value, n.gradient, n.hessian,
      n.divisions, n.roots, n.calls, n.uniforms, n.elements,
      kernel.module.stretches                ? "a vector of stretches"
      : energy.kind == Energy::Kind::density ? "F"
                                             : "a vector of differences",
      kernel.module.q_size(), structure_of(kernel.module));
  const std::string kernel_functions = functions_of(kernel.source);
  out << fmt::format("\nemitted for {} lanes, {} of {} lines (the whole file: ergon show {}{} --source)\n\n{}",
                     lanes::best_lanes(), std::count(kernel_functions.begin(), kernel_functions.end(), '\n'),
                     std::count(kernel.source.begin(), kernel.source.end(), '\n'), energy.file,
                     case_name.empty() ? "" : " --case " + case_name, kernel_functions);
}

std::string title_of(const Energy& energy) {
  if (energy.kind == Energy::Kind::barrier) return energy.name + ": barrier over a gap, in J";
  if (energy.kind == Energy::Kind::distance) return energy.name + ": distance of a " + energy.geometry;
  return fmt::format("{}: {} of a {}, in {}", energy.name, energy.kind == Energy::Kind::density ? "density" : "energy",
                     energy.geometry, to_string(value_unit(energy)));
}

// The energy that was asked for, all energies below a folder, or the whole catalogue.
std::vector<Energy> energies_of(const Options& options) {
  namespace fs = std::filesystem;
  std::vector<std::string> names, folders;
  if (options.all)
    folders = Catalogue::default_folders();
  else if (fs::is_directory(options.energy))
    folders = {options.energy};
  else
    names = {options.energy};
  for (const std::string& folder : folders)
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.path().extension() == ".energy") names.push_back(entry.path().string());
  if (names.empty()) throw InputError(fmt::format("{}: holds no .energy file", options.energy));
  std::sort(names.begin(), names.end());
  std::vector<Energy> energies;
  for (const std::string& name : names) energies.push_back(find_energy_or_part(name));
  return energies;
}

int show_page(const Options& options, std::ostream& out) {
  const std::vector<Energy> energies = energies_of(options);
  write_text_file(options.html, catalogue_page(energies));
  out << fmt::format("{}: {} {}\n", options.html, energies.size(), energies.size() == 1 ? "energy" : "energies");
  return exit_done;
}

int show(const Options& options, std::ostream& out) {
  if (options.all != options.energy.empty())
    throw InputError("'ergon show' needs an energy, or --all for the whole catalogue");
  if (!options.html.empty()) return show_page(options, out);
  if (options.all) {
    for (const Energy& energy : energies_of(options)) out << title_of(energy) << '\n';
    return exit_done;
  }
  const Energy energy =
      options.source || options.kernel ? find_energy(options.energy) : find_energy_or_part(options.energy);
  const std::vector<std::string> cases = cases_of(energy, options.case_name);
  if (options.source) {
    for (const std::string& name : cases) out << generate(energy, compile_options(name, lanes::best_lanes())).source;
    return exit_done;
  }
  if (options.latex) {
    out << formula_latex(energy);
    return exit_done;
  }
  if (options.kernel) {
    for (const std::string& name : cases)
      out << functions_of(generate(energy, compile_options(name, lanes::best_lanes())).source);
    return exit_done;
  }
  out << title_of(energy) << '\n';
  if (!energy.summary.empty()) out << energy.summary << '\n';
  if (!energy.cite.empty()) out << energy.cite << '\n';
  out << '\n' << symbol_table(energy) << '\n' << formula_text(energy) << '\n';
  if (energy.complete())
    for (const std::string& name : cases) show_kernel(energy, name, out);
  return exit_done;
}

}  // namespace

void add_show_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("show", "Prints an energy's formula, symbols, units, cost and emitted kernel");
  auto options = std::make_shared<Options>();
  command->add_option("energy", options->energy,
                      "an .energy file, or a name in the catalogue; for --html also a folder");
  command->add_flag("--all", options->all, "every file of the catalogue: a line each, or as --html says");
  command->add_option("--html", options->html,
                      "write a page instead: formula, curve, params, source, cost and checks of each energy");
  command->add_option("--case", options->case_name, "this case only");
  command->add_flag("--latex", options->latex, "the formula in LaTeX");
  command->add_flag("--kernel", options->kernel, "only the functions that are emitted for it");
  command->add_flag("--source", options->source, "only the C++ that is emitted for it, as a whole file");
  command->callback([options, &run] { run = [options](std::ostream& out) { return show(*options, out); }; });
}

}  // namespace ergon
