// ergon plot ENERGY: its curves of stress, force or energy, as SVG or as numbers.

#include <fmt/format.h>

#include <memory>
#include <ostream>

#include "runtime/error.h"
#include "tools/assignments.h"
#include "tools/catalogue_page.h"
#include "tools/command.h"
#include "tools/files.h"
#include "tools/installation.h"
#include "tools/response.h"

namespace ergon {
namespace {

struct Options {
  std::string energy, out, csv;
  std::vector<std::string> set, modes;
  double from = 0, to = 0;
};

int plot(const Options& options, std::ostream& out) {
  const Energy energy = shown_whole(find_energy_or_part(options.energy));
  if (options.from > options.to || (options.from != 0 && options.from == options.to))
    throw InputError(fmt::format("--from: {} is not below --to, which is {}", options.from, options.to));
  ResponseOptions how;
  how.given = read_assignments(energy, options.set);
  how.low = options.from;
  how.high = options.to;
  how.modes = options.modes;
  const Response response = response_of(energy, how);
  const std::string data = data_text(energy, response.data);
  const std::string file = options.out.empty() ? energy.name.substr(0, energy.name.find(':')) + ".svg" : options.out;
  write_text_file(file, svg_of(charts_of(response), data.empty() ? energy.name : energy.name + ": " + data));
  if (!options.csv.empty()) write_text_file(options.csv, csv_of(response));
  out << fmt::format("{}: {}{}\n", file, energy.name, data.empty() ? "" : " with " + data);
  for (const ResponseCurve& curve : response.curves) {
    size_t first = 0, last = curve.x.size();
    while (first < last && !(curve.force[first] == curve.force[first])) ++first;
    while (last > first && !(curve.force[last - 1] == curve.force[last - 1])) --last;
    if (first == last)
      out << fmt::format("  {:<13} not defined\n", curve.mode);
    else
      out << fmt::format("  {:<13} {} {:.4g} to {:.4g}, {} {:.4g} to {:.4g} {}\n", curve.mode, curve.quantity,
                         curve.x[first], curve.x[last - 1], response.force, curve.force[first], curve.force[last - 1],
                         response.force_unit);
  }
  return exit_done;
}

}  // namespace

void add_plot_command(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("plot", "Draws an energy's curves of stress, force and energy");
  auto options = std::make_shared<Options>();
  command->add_option("energy", options->energy, "an .energy file, or a name in the catalogue")->required();
  command->add_option("--out", options->out, "the SVG file to write; default: NAME.svg");
  command->add_option("--csv", options->csv, "a file of the numbers, as `ergon fit` reads them");
  command
      ->add_option("--set", options->set,
                   "NAME=VALUE of a param, rest or lag; without: a usual value, 1 in SI for most; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_option("--mode", options->modes,
                   "this test only: uniaxial, equibiaxial, pure_shear, simple_shear, volumetric; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--from", options->from, "the first stretch, amount of shear, length, angle or distance");
  command->add_option("--to", options->to, "the last");
  command->callback([options, &run] { run = [options](std::ostream& out) { return plot(*options, out); }; });
}

}  // namespace ergon
