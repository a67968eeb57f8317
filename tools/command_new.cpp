// ergon new KIND NAME: the first file of an energy, explained and sound as it stands.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>

#include "runtime/error.h"
#include "scenes/catalogue.h"
#include "symbolic/functions.h"
#include "symbolic/tokens.h"
#include "tools/choices.h"
#include "tools/command.h"
#include "tools/files.h"
#include "tools/templates.h"

namespace ergon {
namespace {

struct Options {
  std::string kind, name, folder = ".";
};

std::vector<std::string> kinds() {
  std::vector<std::string> names;
  for (const EnergyTemplate& one : energy_templates()) names.push_back(one.kind);
  return names;
}

// The file of the catalogue that has this name, if one does.
std::optional<std::string> in_catalogue(const std::string& name) {
  try {
    return Catalogue(Catalogue::default_folders()).file_of(name, "", {});
  } catch (const SourceError&) {
    return std::nullopt;
  }
}

void check_name(const std::string& name) {
  if (name.empty() || end_of_name(name, 0) != name.size())
    throw InputError(fmt::format("NAME: expected a letter and then letters, digits and '_', found '{}'{}", name,
                                 name.ends_with(".energy") ? "; the ending .energy is added" : ""));
  const auto& functions = function_names();
  if (std::find(functions.begin(), functions.end(), name) != functions.end() || name == "pi")
    throw InputError(fmt::format("NAME: '{}' is the name of a function of the language; choose another", name));
  if (const auto file = in_catalogue(name))
    throw InputError(
        fmt::format("NAME: the catalogue has '{}' already ({}); choose another name, or see it by `ergon show {}`",
                    name, *file, name));
}

std::string with_name(std::string text, const std::string& name) {
  constexpr std::string_view hole = "NAME";
  for (size_t at = text.find(hole); at != std::string::npos; at = text.find(hole, at + name.size()))
    text.replace(at, hole.size(), name);
  return text;
}

int make(const Options& options, std::ostream& out) {
  const EnergyTemplate& chosen_one = energy_templates()[chosen("KIND", options.kind, kinds())];
  check_name(options.name);
  const std::filesystem::path folder = options.folder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::string file = (folder / (options.name + ".energy")).lexically_normal().string();
  if (std::filesystem::exists(file)) throw InputError(fmt::format("{}: there is a file of that name already", file));
  write_text_file(file, with_name(chosen_one.text, options.name));
  out << fmt::format(
      "{0}: {1}; sound as it stands. Change it, then\n  ergon check {0}\n  ergon plot {0}\n"
      "Its last line tells how it is used.\n",
      file, chosen_one.what);
  return exit_done;
}

}  // namespace

void add_new_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("new", "Writes the first file of a new energy");
  auto options = std::make_shared<Options>();
  std::string help = "what it is written over:";
  for (const EnergyTemplate& one : energy_templates()) help += fmt::format("\n{:<15} {}", one.kind, one.what);
  command->add_option("kind", options->kind, help)->required();
  command->add_option("name", options->name, "its name, and with .energy behind it that of its file")->required();
  command->add_option("--folder", options->folder, "where to write it; made if it is not there");
  command->callback([options, &run] { run = [options](std::ostream& out) { return make(*options, out); }; });
}

}  // namespace ergon
