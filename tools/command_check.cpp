// ergon check ENERGY: is this energy sound as mechanics?

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <ostream>

#include "symbolic/checks.h"
#include "tools/command.h"
#include "tools/installation.h"

namespace ergon {
namespace {

int check(const std::string& name, std::ostream& out) {
  const Energy energy = find_energy(name);
  const std::vector<Finding> findings = check_energy(energy);
  constexpr std::array words = {"ok", "warning", "error"};
  std::array<int, 3> counts{};
  size_t width = 0;
  for (const Finding& finding : findings) width = std::max(width, finding.check.size());
  out << fmt::format("{}: {} {}, {}\n", energy.file, energy.kind == Energy::Kind::density ? "density" : "energy",
                     energy.name, energy.geometry);
  for (const Finding& finding : findings) {
    const auto severity = static_cast<size_t>(finding.severity);
    ++counts[severity];
    out << fmt::format("  {:<7}  {:<{}}  {}\n", words[severity], finding.check, width, finding.message);
  }
  out << fmt::format("{}: {} ok, {} warning{}, {} error{}\n", counts[2] == 0 ? "sound" : "not sound", counts[0],
                     counts[1], counts[1] == 1 ? "" : "s", counts[2], counts[2] == 1 ? "" : "s");
  return counts[2] == 0 ? exit_done : exit_failed;
}

}  // namespace

void add_check_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("check", "Tells whether an energy is sound");
  auto name = std::make_shared<std::string>();
  command->add_option("energy", *name, "an .energy file, or a name in the catalogue")->required();
  command->callback([name, &run] { run = [name](std::ostream& out) { return check(*name, out); }; });
}

}  // namespace ergon
