// ergon verify: values beside their references, each with its error, mesh and element.

#include <fmt/format.h>

#include <memory>
#include <ostream>

#include "runtime/error.h"
#include "tools/command.h"
#include "tools/rows.h"
#include "tools/verify/verify.h"

namespace ergon {
namespace {

struct VerifyOptions {
  std::vector<std::string> names;
  bool list = false, quick = false, json = false;
};

const char* result_of(const VerifyRow& row) { return !row.judged() ? "shown" : row.passed() ? "passed" : "MISSED"; }

void print_json(const VerifyCase& made_by, const VerifyRow& row, std::ostream& out) {
  out << Row{{"case", made_by.name},     {"quantity", row.quantity},
             {"element", row.element},   {"mesh", row.mesh},
             {"value", row.value},       {"reference", row.reference},
             {"error", row.error()},     {"bound", row.bound ? Row(*row.bound) : Row(nullptr)},
             {"result", result_of(row)}, {"note", row.note},
             {"source", made_by.source}}
             .dump()
      << std::endl;
}

void print_line(const VerifyRow& row, std::ostream& out) {
  const std::string bound = row.bound ? fmt::format("{:.1g}", *row.bound) : "-";
  std::string line = fmt::format("  {:<44} {:<22} {:<14} {:>12.6g} {:>12.6g} {:>9.2g} {:>7}  {}", row.quantity,
                                 row.element, row.mesh, row.value, row.reference, row.error(), bound, result_of(row));
  if (!row.note.empty()) line += "  " + row.note;
  out << line << std::endl;
}

int verify(const VerifyOptions& options, std::ostream& out) {
  std::vector<const VerifyCase*> chosen;
  for (const std::string& name : options.names) chosen.push_back(&verify_case(name));
  if (chosen.empty())
    for (const VerifyCase& each : verify_cases()) chosen.push_back(&each);
  if (options.list) {
    for (const VerifyCase* each : chosen) out << fmt::format("{:<28} {}\n", each->name, each->summary);
    return exit_done;
  }
  long judged = 0, missed = 0;
  if (!options.json)
    out << fmt::format("  {:<44} {:<22} {:<14} {:>12} {:>12} {:>9} {:>7}  {}\n", "quantity", "element", "mesh", "value",
                       "reference", "error", "bound", "result");
  for (const VerifyCase* each : chosen) {
    if (!options.json) out << fmt::format("{}: {}\n  source: {}\n", each->name, each->summary, each->source);
    each->run(VerifyRows(options.quick, [&](const VerifyRow& row) {
      judged += row.judged();
      missed += !row.passed();
      options.json ? print_json(*each, row, out) : print_line(row, out);
    }));
  }
  if (!options.json) out << fmt::format("{} of {} judged rows are within their bound\n", judged - missed, judged);
  return missed > 0 ? exit_failed : exit_done;
}

}  // namespace

void add_verify_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("verify", "Compares results with closed forms and published tables");
  auto options = std::make_shared<VerifyOptions>();
  command->add_option("names", options->names, "cases (see --list); all, if none is named");
  command->add_flag("--list", options->list, "list the cases and run none");
  command->add_flag("--quick", options->quick, "only what takes seconds in all: coarser meshes, fewer loads");
  command->add_flag("--json", options->json, "one JSON object per line instead of a table");
  command->callback([options, &run] { run = [options](std::ostream& out) { return verify(*options, out); }; });
}

}  // namespace ergon
