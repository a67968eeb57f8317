#pragma once
// What a whole run did and cost.

#include <array>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "scenes/builder.h"

namespace ergon {

struct RunSummary {
  std::string scene;     // file
  std::string failure;   // empty when all steps were taken
  bool stopped = false;  // by whoever asked for the run, before its end
  std::string integrator;
  int threads = 0;
  int vertices = 0;
  int cells = 0;
  long steps = 0;              // taken
  double time = 0;             // s, simulated
  long unconverged_steps = 0;  // accepted all the same
  long newton_iterations = 0;
  long linear_solves = 0;
  double factor_flops = 0;  // of all factorisations
  long halvings = 0;        // of line searches
  long refused = 0;         // steps that were tried and undone
  int most_contacts = 0;
  double smallest_gap = std::numeric_limits<double>::infinity();  // m, over all steps
  // J, largest rise of kinetic and stored energy in a step, less what a change of barrier stiffness added; at most 0
  // when the energy never rose by itself.
  double max_energy_rise = -std::numeric_limits<double>::infinity();
  double start_energy = 0;                                            // J
  double end_energy = 0;                                              // J
  double largest_speed = 0;                                           // m/s, of any vertex at the end
  std::vector<std::pair<std::string, std::array<double, 3>>> probes;  // m, at the end, by name
  int frames = 0;
  long peak_memory = 0;  // bytes, of the process
  BuildSeconds build;
  StepSeconds step_seconds;  // sums
  double output_seconds = 0;
  // What was left out, "part: reason", with the number of steps in which it was; 0 for what the scene never needed.
  std::vector<std::pair<std::string, long>> skipped;
  std::vector<std::string> warnings;  // as in BuiltScene

  double total_seconds() const { return build.total() + step_seconds.total + output_seconds; }
};

// "part: reason" as its two parts.
std::pair<std::string, std::string> part_and_reason(const std::string& skipped);

// Takes a step into account.
void add_step(RunSummary& summary, const StepRecord& record);

// Seconds by part, in the order of a run; what the parts do not cover is "other".
std::vector<std::pair<std::string, double>> seconds_by_part(const RunSummary& summary);
std::vector<std::pair<std::string, double>> seconds_by_part(const StepSeconds& seconds);

// One JSON object without line end; numbers that are not finite are null.
std::string to_json(const RunSummary& summary);

}  // namespace ergon
