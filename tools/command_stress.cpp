// ergon stress: scenes that try the solver, each with Tet4 and Tet10.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <ostream>
#include <stdexcept>

#include "runtime/error.h"
#include "runtime/lanes/lanes.h"
#include "tools/command.h"
#include "tools/installation.h"
#include "tools/rows.h"
#include "tools/stress.h"

namespace ergon {
namespace {

struct StressOptions {
  std::string only;
  bool brief = false;
  bool json = false;
};

constexpr long brief_steps = 20;

std::vector<Kernel> kernels_for(const std::vector<KernelRequest>& requests) {
  return load_kernels(requests, lanes::best_lanes());
}

Row row_of(const StressOutcome& outcome) {
  Row row = {{"case", outcome.name},
             {"element", outcome.element},
             {"steps", outcome.steps},
             {"newton", outcome.newton_iterations},
             {"unconverged", outcome.unconverged},
             {"smallest_gap", nullptr},
             {"energy_created", outcome.energy_created},
             {"energy", outcome.energy},
             {"budget_residual", outcome.residual},
             {"seconds", outcome.seconds},
             {"outcome", outcome.fault.empty() ? "holds" : outcome.fault}};
  if (std::isfinite(outcome.smallest_gap)) row["smallest_gap"] = outcome.smallest_gap;
  return row;
}

int stress(const StressOptions& options, std::ostream& out) {
  Rows rows(out, options.json);
  const long steps = options.brief ? brief_steps : 0;
  long cases = 0, faults = 0;
  const auto add = [&](const StressOutcome& outcome) {
    ++cases;
    faults += !outcome.fault.empty();
    rows.add(row_of(outcome));
    out << std::flush;
  };
  const auto wanted = [&](const std::string& name) { return name.find(options.only) != std::string::npos; };
  for (const char* element : {"tet4", "tet10", "hex27"}) {
    for (const StressCase& what : stress_cases(element))
      if (wanted(what.name)) add(run_stress_case(what, element, kernels_for, steps));
    if (wanted("the same in mm")) add(run_stress_units(element, kernels_for, steps));
  }
  if (cases == 0) throw InputError(fmt::format("no case has '{}' in its name", options.only));
  if (faults > 0) throw std::runtime_error(fmt::format("{} of {} cases do not hold", faults, cases));
  return exit_done;
}

}  // namespace

void add_stress_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("stress", "Runs scenes that try the solver, and judges them");
  auto options = std::make_shared<StressOptions>();
  command->add_option("--only", options->only, "only cases with this in their name");
  command->add_flag("--brief", options->brief, fmt::format("{} steps of each", brief_steps));
  command->add_flag("--json", options->json, "one JSON object per line instead of a table");
  command->callback([options, &run] { run = [options](std::ostream& out) { return stress(*options, out); }; });
}

}  // namespace ergon
