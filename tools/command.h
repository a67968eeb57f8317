#pragma once
// The subcommands of `ergon`. Each adds itself to the command line and, when it is the one that was asked for, sets
// `run`; main() then runs it and turns what it throws into a message and an exit code.

#include <CLI/CLI.hpp>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace ergon {

enum ExitCode { exit_done = 0, exit_failed = 1, exit_bad_input = 2 };

// Writes its answer to `out` and returns an exit code. Throws SourceError and InputError for bad input.
using Run = std::function<int(std::ostream& out)>;

void add_run_command(CLI::App& app, Run& run);
void add_new_command(CLI::App& app, Run& run);
void add_check_command(CLI::App& app, Run& run);
void add_show_command(CLI::App& app, Run& run);
void add_plot_command(CLI::App& app, Run& run);
void add_fit_command(CLI::App& app, Run& run);
void add_cost_command(CLI::App& app, Run& run);
void add_eval_command(CLI::App& app, Run& run);
void add_batch_command(CLI::App& app, Run& run);
void add_bench_command(CLI::App& app, Run& run);
void add_compile_command(CLI::App& app, Run& run);
void add_verify_command(CLI::App& app, Run& run);
void add_accuracy_command(CLI::App& app, Run& run);
void add_stress_command(CLI::App& app, Run& run);

// The whole program: parses the arguments (without the program's name), runs the subcommand, and writes messages as
// "ergon: error: ..." to `err`. Returns the exit code.
int run_command_line(std::vector<std::string> arguments, std::ostream& out, std::ostream& err);

}  // namespace ergon
