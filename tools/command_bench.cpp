// ergon bench: how fast kernels, the compiler and scenes are here.

#include <memory>
#include <optional>
#include <ostream>
#include <stdexcept>

#include "tools/bench.h"
#include "tools/choices.h"
#include "tools/command.h"
#include "tools/scene_run.h"

namespace ergon {
namespace {

void add_kernels(CLI::App& bench, Run& run) {
  CLI::App* command = bench.add_subcommand("kernels", "Evaluation and assembly on a cube of cells");
  auto options = std::make_shared<BenchKernels>();
  auto json = std::make_shared<bool>(false);
  command->add_option("--energy", options->energies, "name or file; may be repeated; default: the catalogue")
      ->take_all();
  command->add_option(
      "--element", options->element,
      "Tet4, Tet10, Hex8, Hex20, Hex27, Prism6, Tri3, Tri6, Quad4, Quad9, Edge2, Edge3; default: one that fits");
  command->add_option("--entry", options->entry, "value, gradient or hessian; default: all three");
  command->add_option("--project", options->projection, "negative eigenvalues: clamp, abs or none");
  command->add_option("--set", options->set, "NAME=VALUE of an input; the others are chosen within their ranges")
      ->take_all();
  command->add_option("--precision", options->precision, "double, float, or mixed: floats for the Hessian alone");
  command->add_option("--lanes", options->lanes,
                      "elements at a time: 1, 2, 4 or 8; default: the most this machine has");
  command->add_option("--threads", options->threads, "threads to use");
  command->add_option("--cells", options->cells, "cells per edge of the cube");
  command->add_option("--quadrature", options->quadrature, "exactness of the quadrature; default: the element's");
  command->add_option("--state", options->state,
                      "rest; noise; definite (stretched) or indefinite (pressed); default: noise");
  command->add_flag("--json", *json, "one JSON object per line instead of a table");
  command->callback([options, json, &run] {
    run = [options, json](std::ostream& out) {
      Rows rows(out, *json);
      bench_kernels(*options, rows);
      return exit_done;
    };
  });
}

void add_compile(CLI::App& bench, Run& run) {
  CLI::App* command =
      bench.add_subcommand("compile", "From an energy file to a loaded kernel, from nothing and cached");
  auto options = std::make_shared<BenchCompile>();
  auto json = std::make_shared<bool>(false);
  command->add_option("--energy", options->energies, "name or file; may be repeated; default: the catalogue")
      ->take_all();
  command->add_flag("--all", options->slowest, "the whole catalogue, then the largest of every figure");
  command->add_flag("--json", *json, "one JSON object per line instead of a table");
  command->callback([options, json, &run] {
    run = [options, json](std::ostream& out) {
      Rows rows(out, *json);
      bench_compile(*options, rows);
      return exit_done;
    };
  });
}

void add_contact(CLI::App& bench, Run& run) {
  CLI::App* command =
      bench.add_subcommand("contact", "Two noisy cloths that touch: candidates, stencils, barrier, steps");
  auto options = std::make_shared<BenchContact>();
  auto json = std::make_shared<bool>(false);
  command->add_option("--cells", options->cells, "cells per edge of each cloth");
  command->add_option("--barrier", options->barrier, "a law of contact in the catalogue");
  command->add_option("--threads", options->threads, "threads to use");
  command->add_flag("--json", *json, "one JSON object per line instead of a table");
  command->callback([options, json, &run] {
    run = [options, json](std::ostream& out) {
      Rows rows(out, *json);
      bench_contact(*options, rows);
      return exit_done;
    };
  });
}

void add_ccd(CLI::App& bench, Run& run) {
  CLI::App* command =
      bench.add_subcommand("ccd", "Continuous collision detection: time, false positives, missed collisions");
  auto options = std::make_shared<BenchCcd>();
  auto json = std::make_shared<bool>(false);
  command->add_option("--queries", options->queries, "how many, over all rows");
  command->add_option("--kept", options->kept, "fraction of a gap that is left, in (0, 1)");
  command->add_flag("--json", *json, "one JSON object per line instead of a table");
  command->callback([options, json, &run] {
    run = [options, json](std::ostream& out) {
      Rows rows(out, *json);
      bench_ccd(*options, rows);
      return exit_done;
    };
  });
}

void add_scene(CLI::App& bench, Run& run) {
  CLI::App* command = bench.add_subcommand("scene", "A whole scene: time by part, iterations, memory; writes nothing");
  auto options = std::make_shared<SceneRun>();
  auto threads = std::make_shared<std::optional<int>>();
  auto json = std::make_shared<bool>(false);
  command->add_option("scene", options->file, "a scene file (.toml)")->required();
  command->add_option("--threads", *threads, "threads to use; default: all cores");
  command->add_flag("--json", *json, "one JSON object instead of text");
  options->write = false;
  command->callback([options, threads, json, &run] {
    run = [options, threads, json](std::ostream& out) {
      if (threads->has_value()) set_threads(**threads);
      const RunSummary summary = run_scene_file(*options);
      out << (*json ? to_json(summary) + "\n" : to_text(summary)) << std::flush;
      if (!summary.failure.empty()) throw std::runtime_error(options->file + ": " + summary.failure);
      return exit_done;
    };
  });
}

void add_accuracy(CLI::App& bench, Run& run) {
  CLI::App* command = bench.add_subcommand(
      "accuracy", "What a digit costs: error against run time over elements, meshes, integrators, steps, tolerances");
  auto options = std::make_shared<BenchAccuracy>();
  command->add_option("--problem", options->problems, "cantilever, column, cloth, bounce or buckling; default: all")
      ->take_all();
  command->add_option("--out", options->folder, "for the table (CSV), plots (SVG) and what was run");
  command->add_flag("--brief", options->brief, "a few coarse settings, seconds in all");
  command->add_flag("--again", options->again, "run what the folder holds too");
  command->add_flag("--progress", options->progress, "a line for each run");
  command->add_flag("--json", options->json, "one JSON object per line instead of text");
  command->callback([options, &run] {
    run = [options](std::ostream& out) {
      bench_accuracy(*options, out);
      return exit_done;
    };
  });
}

void add_stopping(CLI::App& bench, Run& run) {
  CLI::App* command = bench.add_subcommand(
      "stopping", "What tolerances of iterations and stiffnesses of contact add to the error of dt and mesh");
  auto options = std::make_shared<BenchStopping>();
  command->add_option("--study", options->study, "tolerance, friction or barrier; default: all");
  command->add_option("--out", options->folder, "for what was run");
  command->add_flag("--brief", options->brief, "a part of each study, seconds in all");
  command->add_flag("--again", options->again, "run what the folder holds too");
  command->add_flag("--json", options->json, "one JSON object per line instead of text");
  command->callback([options, &run] {
    run = [options](std::ostream& out) {
      bench_stopping(*options, out);
      return exit_done;
    };
  });
}

}  // namespace

void add_bench_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("bench", "Measures kernels, the compiler, contact, a scene, or accuracy");
  command->require_subcommand(1);
  add_kernels(*command, run);
  add_compile(*command, run);
  add_contact(*command, run);
  add_ccd(*command, run);
  add_scene(*command, run);
  add_accuracy(*command, run);
  add_stopping(*command, run);
}

}  // namespace ergon
