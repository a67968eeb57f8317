// ergon check FILE: is this energy sound?

#include <fmt/format.h>
#include <memory>
#include <ostream>

#include "symbolic/energy.h"
#include "tools/command.h"

namespace ergon {

void add_check_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("check", "Reads an energy and tells whether it is sound");
  auto file = std::make_shared<std::string>();
  command->add_option("file", *file, "an .energy file")->required();
  command->callback([file, &run] {
    run = [file](std::ostream& out) {
      const Energy energy = read_energy(*file);
      out << fmt::format("{}: {} is read\n", *file, energy.name);
      return exit_done;
    };
  });
}

}  // namespace ergon
