#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <ostream>

#include "runtime/error.h"
#include "symbolic/diagnostic.h"
#include "tools/command.h"

namespace ergon {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

const CLI::App* innermost(const CLI::App* app) {
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  return app;
}

std::string full_name(const CLI::App* app) {
  return app->get_parent() == nullptr ? app->get_name() : full_name(app->get_parent()) + " " + app->get_name();
}

// What was typed that nothing of that name exists for, with the nearest name.
std::string unexpected(const CLI::App& app) {
  const CLI::App* command = innermost(&app);
  const std::string name = full_name(command);
  for (const std::string& word : app.remaining(true)) {
    if (word.starts_with("-")) {
      return fmt::format("unknown option '{}' of '{}'{}", word, name, did_you_mean(word, option_names(*command)));
    }
    const std::vector<std::string> commands = command_names(*command);
    if (!commands.empty()) return fmt::format("unknown command '{} {}'{}", name, word, did_you_mean(word, commands));
    return fmt::format("'{}' does not expect '{}'; see '{} --help'", name, word, name);
  }
  return fmt::format("see '{} --help'", name);
}

std::string message_of(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = innermost(&app);
  // A misspelt word is the better explanation also where CLI11 reports what it therefore missed.
  if (!app.remaining(true).empty()) return unexpected(app);
  if (!command_names(*command).empty()) {
    return fmt::format("'{}' needs a command: {}", full_name(command), fmt::join(command_names(*command), ", "));
  }
  return fmt::format("{}; see '{} --help'", error.what(), full_name(command));
}

}  // namespace

int run_command_line(std::vector<std::string> arguments, std::ostream& out, std::ostream& err) {
  CLI::App app("Compiles energies written as symbols, and time-steps scenes made of them.", "ergon");
  app.set_version_flag("--version", "ergon " ERGON_VERSION);
  app.require_subcommand(1);
  Run run;
  add_run_command(app, run);
  add_batch_command(app, run);
  add_new_command(app, run);
  add_check_command(app, run);
  add_show_command(app, run);
  add_plot_command(app, run);
  add_fit_command(app, run);
  add_compile_command(app, run);
  add_cost_command(app, run);
  add_eval_command(app, run);
  add_bench_command(app, run);
  add_accuracy_command(app, run);
  add_stress_command(app, run);
  add_verify_command(app, run);

  try {
    std::reverse(arguments.begin(), arguments.end());  // the order CLI11 consumes a vector in
    app.parse(arguments);
    const int code = run(out);
    out.flush();
    if (!out) {
      err << "ergon: error: the standard output could not be written\n";
      return exit_failed;
    }
    return code;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error, out, err);  // --help, --version
    err << "ergon: error: " << message_of(app, error) << '\n';
    return exit_bad_input;
  } catch (const SourceError& error) {
    err << "ergon: error: " << error.what() << '\n';
    return exit_bad_input;
  } catch (const InputError& error) {
    err << "ergon: error: " << error.what() << '\n';
    return exit_bad_input;
  } catch (const std::exception& error) {
    err << "ergon: error: " << error.what() << '\n';
    return exit_failed;
  }
}

}  // namespace ergon
