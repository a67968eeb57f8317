// ergon check ENERGY: is this energy sound as mechanics?

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>

#include "scenes/catalogue.h"
#include "symbolic/checks.h"
#include "tools/command.h"
#include "tools/installation.h"
#include "tools/kernel_findings.h"
#include "tools/rows.h"

namespace ergon {
namespace {

std::string title_of(const Energy& energy) {
  constexpr std::array kinds = {"density", "energy", "barrier", "distance"};
  return fmt::format("{} {}{}{}", kinds[static_cast<size_t>(energy.kind)], energy.name,
                     energy.geometry.empty() ? "" : ", ", energy.geometry);
}

// Of a part, what is found in the energies that it is composed to, under their names.
std::vector<Finding> findings_of(const Energy& energy) {
  std::vector<Finding> all;
  for (const Energy& whole : complete(energy)) {
    std::vector<Finding> findings = check_energy(whole);
    for (Finding& finding : kernel_findings(whole)) findings.push_back(std::move(finding));
    for (Finding& finding : findings) {
      if (!energy.complete()) finding.message = whole.name + ": " + finding.message;
      all.push_back(std::move(finding));
    }
  }
  return all;
}

// A file is found by its own name, an energy of the catalogue by its: what else the header says leads astray.
std::optional<Finding> name_finding(const Energy& energy) {
  namespace fs = std::filesystem;
  const fs::path file = energy.file;
  if (file.stem() != energy.name)
    return Finding{
        Severity::warning,
        "name",
        fmt::format("the file {} holds an energy named '{}'; name both alike", file.filename().string(), energy.name),
        {energy.file, 0, 0},
        ""};
  std::error_code error;
  try {
    const std::string shipped = Catalogue(Catalogue::default_folders()).file_of(energy.name, "", {});
    if (fs::equivalent(shipped, file, error)) return std::nullopt;
    return Finding{
        Severity::warning,
        "name",
        fmt::format("the catalogue has '{}' too ({}), and finds that one where a scene names no file; choose "
                    "another name",
                    energy.name, shipped),
        {energy.file, 0, 0},
        ""};
  } catch (const SourceError&) {
    return std::nullopt;
  }
}

std::string plural(int count, const char* what) { return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s"); }

int check(const std::string& name, bool json, std::ostream& out) {
  const Energy energy = find_energy_or_part(name);
  std::vector<Finding> findings = findings_of(energy);
  if (auto clash = name_finding(energy)) findings.insert(findings.begin(), std::move(*clash));
  std::array<int, 4> counts{};
  size_t width = 0;
  for (const Finding& finding : findings) {
    width = std::max(width, finding.check.size());
    ++counts[static_cast<size_t>(finding.severity)];
  }
  const int code = counts[3] == 0 ? exit_done : exit_failed;
  if (json) {
    Rows rows(out, true);
    for (const Finding& f : findings)
      rows.add({{"energy", energy.name},
                {"severity", to_string(f.severity)},
                {"check", f.check},
                {"message", f.message},
                {"place", f.place.line > 0 ? to_string(f.place) : ""},
                {"state", f.state}});
    return code;
  }
  out << fmt::format("{}: {}\n", energy.file, title_of(energy));
  for (const Finding& f : findings) {
    const std::string place = f.place.line > 0 ? to_string(f.place) + ": " : "";
    out << fmt::format("  {:<7}  {:<{}}  {}{}\n", to_string(f.severity), f.check, width, place, f.message);
    if (!f.state.empty()) out << fmt::format("  {:<{}}  at {}\n", "", width + 9, f.state);
  }
  out << fmt::format("{}: {} ok, {}, {}, {}\n", counts[3] == 0 ? "sound" : "not sound", counts[0],
                     plural(counts[1], "note"), plural(counts[2], "warning"), plural(counts[3], "error"));
  return code;
}

}  // namespace

void add_check_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("check", "Tells whether an energy is sound");
  auto name = std::make_shared<std::string>();
  command->add_option("energy", *name, "an .energy file, or a name in the catalogue")->required();
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "one JSON object per finding instead of text");
  command->callback([name, json, &run] { run = [name, json](std::ostream& out) { return check(*name, *json, out); }; });
}

}  // namespace ergon
