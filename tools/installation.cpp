#include "tools/installation.h"

#include <fmt/format.h>

#include "codegen/compile_all.h"
#include "runtime/error.h"
#include "scenes/catalogue.h"
#include "symbolic/compose.h"
#include "tools/choices.h"

namespace ergon {

Energy find_energy_or_part(const std::string& name_or_path) {
  std::error_code error;
  if (name_or_path.ends_with(".energy") || std::filesystem::is_regular_file(name_or_path, error))
    return read_energy(name_or_path);
  return Catalogue(Catalogue::default_folders()).read(name_or_path, "", Place{name_or_path});
}

Energy find_energy(const std::string& name_or_path) {
  Energy energy = find_energy_or_part(name_or_path);
  if (energy.complete()) return energy;
  return Catalogue(Catalogue::default_folders()).read_complete(name_or_path, "", Place{name_or_path});
}

std::vector<Energy> complete(const Energy& energy) {
  if (energy.complete()) return {energy};
  const Catalogue catalogue(Catalogue::default_folders());
  std::vector<Energy> out;
  if (energy.kind == Energy::Kind::barrier)
    for (const std::string& distance : catalogue.distances())
      out.push_back(compose(energy, catalogue.read(distance, "", {}), Offset::none));
  else
    out.push_back(compose(catalogue.read("log_barrier", "", {}), energy, Offset::none));
  return out;
}

std::vector<std::string> catalogue_names() { return Catalogue(Catalogue::default_folders()).names(); }

std::vector<std::string> cases_of(const Energy& energy, const std::string& asked) {
  if (asked.empty()) return energy.cases.empty() ? std::vector<std::string>{""} : energy.cases;
  if (energy.cases.empty()) throw InputError(fmt::format("--case: {} has no cases", energy.name));
  return {energy.cases[chosen("--case", asked, energy.cases)]};
}

CompileOptions compile_options(const std::string& case_name, int lanes) {
  CompileOptions options;
  options.case_name = case_name;
  options.lanes = lanes;
  std::error_code error;
  options.read_only_caches = {std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "kernels"};
  return options;
}

Kernel load_kernel(const Energy& energy, const std::string& case_name, int lanes) {
  const CompiledKernel compiled = compile(energy, compile_options(case_name, lanes));
  return {compiled.library, compiled.table};
}

std::vector<Kernel> load_kernels(const std::vector<const Energy*>& energies, int lanes) {
  std::vector<CompileJob> jobs;
  for (const Energy* energy : energies) jobs.push_back({energy, compile_options("", lanes)});
  std::vector<Kernel> kernels;
  for (const CompiledKernel& compiled : kernels_of(compile_all(jobs)))
    kernels.push_back({compiled.library, compiled.table});
  return kernels;
}

}  // namespace ergon
