// ergon accuracy ENERGY: error of the emitted kernel against 50 digits, from tiny strains to huge ones.

#include <memory>
#include <ostream>

#include "runtime/lanes/lanes.h"
#include "tools/accuracy.h"
#include "tools/choices.h"
#include "tools/command.h"
#include "tools/installation.h"
#include "tools/rows.h"

namespace ergon {
namespace {

int accuracy(const std::string& name, bool single, bool json, std::ostream& out) {
  const Energy energy = find_energy(name);
  Rows rows(out, json);
  constexpr const char* entries[] = {"value", "gradient", "hessian"};
  for (const std::string& case_name : cases_of(energy)) {
    AccuracyOptions options;
    options.lanes = single ? lanes::best_single_lanes() : lanes::best_lanes();
    options.single = single;
    for (const Accuracy& at : measure_accuracy(energy, case_name, options))
      for (int i = 0; i < 3; ++i)
        rows.add({{"energy", case_name.empty() ? energy.name : energy.name + "/" + case_name},
                  {"strain", at.strain},
                  {"entry", entries[i]},
                  {"states", at.states},
                  {"naive_median_ulp", at.naive[i].median},
                  {"naive_max_ulp", at.naive[i].largest},
                  {"emitted_median_ulp", at.emitted[i].median},
                  {"emitted_max_ulp", at.emitted[i].largest},
                  {"condition", at.condition[i]},
                  {"error_over_condition", at.excess[i]}});
  }
  return exit_done;
}

}  // namespace

void add_accuracy_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("accuracy", "Errors against 50 digits, over strains from 1e-12 to 1e3");
  auto name = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);
  command->add_option("energy", *name, "an .energy file, or a name in the catalogue")->required();
  command->add_flag("--json", *json, "one JSON object per line instead of a table");
  auto precision = std::make_shared<std::string>("double");
  command->add_option("--precision", *precision, "of the kernel: double or float");
  command->callback([name, json, precision, &run] {
    run = [name, json, precision](std::ostream& out) {
      return accuracy(*name, chosen("--precision", *precision, {"double", "float"}) == 1, *json, out);
    };
  });
}

}  // namespace ergon
