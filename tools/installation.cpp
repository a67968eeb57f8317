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

CompileOptions compile_options(const std::string& case_name, int lanes, bool single) {
  CompileOptions options;
  options.case_name = case_name;
  options.lanes = lanes;
  options.single = single;
  std::error_code error;
  options.read_only_caches = {std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "kernels"};
  return options;
}

Kernel load_kernel(const Energy& energy, const std::string& case_name, int lanes, Precision precision) {
  const auto load = [&](bool single) -> Kernel {
    const int count = single && lanes > 1 ? 2 * lanes : lanes;
    const CompiledKernel compiled = compile(energy, compile_options(case_name, count, single));
    return {compiled.library, compiled.table};
  };
  if (precision == Precision::single) return load(true);
  Kernel kernel = load(false);
  if (precision == Precision::mixed && !kernel->constant_hessian) {
    kernel.curvature = std::make_shared<const Kernel>(load(true));
  }
  return kernel;
}

bool serves_in_floats(const Energy& energy) { return energy.with_role(Role::lag).empty() && energy.active.empty(); }

std::vector<Kernel> load_kernels(const std::vector<KernelRequest>& requests, int lanes, Precision precision) {
  std::vector<CompileJob> jobs;
  for (const auto& [energy, case_name] : requests) jobs.push_back({energy, compile_options(case_name, lanes)});
  std::vector<Kernel> kernels;
  for (const CompiledKernel& compiled : kernels_of(compile_all(jobs)))
    kernels.push_back({compiled.library, compiled.table});
  if (precision == Precision::double_) return kernels;

  jobs.clear();
  std::vector<size_t> replaced;
  for (size_t i = 0; i < kernels.size(); ++i) {
    if (kernels[i]->constant_hessian || !serves_in_floats(*requests[i].energy)) continue;
    replaced.push_back(i);
    jobs.push_back({requests[i].energy, compile_options(requests[i].case_name, lanes > 1 ? 2 * lanes : 1, true)});
  }
  const std::vector<CompiledKernel> singles = kernels_of(compile_all(jobs));
  for (size_t i = 0; i < replaced.size(); ++i) {
    Kernel& kernel = kernels[replaced[i]];
    const Kernel single{singles[i].library, singles[i].table};
    if (precision == Precision::single) {
      kernel = single;
    } else {
      kernel.curvature = std::make_shared<const Kernel>(single);
    }
  }
  return kernels;
}

}  // namespace ergon
