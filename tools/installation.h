#pragma once
// What the program finds beside itself: the catalogue of energies and the kernels compiled with it.

#include <filesystem>
#include <string>
#include <vector>

#include "codegen/compile.h"
#include "runtime/potential.h"
#include "scenes/builder.h"
#include "symbolic/energy.h"

namespace ergon {

// An energy by its name in the catalogue or by the path of its file; a barrier with its distance, as
// "log_barrier:point_edge". Throws SourceError, with the nearest name.
Energy find_energy(const std::string& name_or_path);
// The same, or a barrier or distance alone.
Energy find_energy_or_part(const std::string& name_or_path);

// The energies that tell of an energy or part: itself; a barrier over all distances; the log barrier over a distance.
std::vector<Energy> complete(const Energy& energy);

// The names of the catalogue's complete energies, sorted.
std::vector<std::string> catalogue_names();

// The energy's cases, or "" alone when it has none; only the one `asked` for, unless that is "". Throws InputError when
// there is no such case.
std::vector<std::string> cases_of(const Energy& energy, const std::string& asked = "");

// Of value, gradient and Hessian: doubles, floats, or floats for the Hessian alone.
enum class Precision { double_, single, mixed };

// Options that look for kernels beside the program first.
CompileOptions compile_options(const std::string& case_name, int lanes, bool single = false);

// Compiled, or from a cache; floats fill vectors as long as those of `lanes` doubles.
Kernel load_kernel(const Energy& energy, const std::string& case_name, int lanes,
                   Precision precision = Precision::double_);

// Whether an energy has neither lag data nor active conditions, as inertia and contact do: what a step is accurate to
// depends on those.
bool serves_in_floats(const Energy& energy);

// In their order; those that no cache holds are compiled side by side. Energies that do not
// serve in floats, and those whose Hessian is constant, so that floats would save nothing, stay in doubles.
std::vector<Kernel> load_kernels(const std::vector<KernelRequest>& requests, int lanes,
                                 Precision precision = Precision::double_);

}  // namespace ergon
