#pragma once
// What each time step did and cost, one JSON object per line.

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ergon {

// A part of the work that a step did not do, and why.
struct SkippedPart {
  std::string part;
  std::string reason;
};

// Sums of the forces on the vertices of one object, N.
struct ObjectForces {
  std::string object;
  std::array<double, 3> contact{};
  std::array<double, 3> friction{};
};

// One record. Numbers that are not finite become null.
struct ReportRecord {
  int step = 0;
  double time = 0;  // at the end of the step, s
  double dt = 0;    // s
  bool converged = false;
  int newton_iterations = 0;
  int linear_iterations = 0;                                            // of an iterative linear solver
  double residual = 0;                                                  // in the unit of the solver's stopping rule
  std::vector<std::pair<std::string, double>> energies;                 // by term, J
  std::vector<std::pair<std::string, double>> budget;                   // of the step: change = sum of the others, J
  std::vector<std::pair<std::string, std::array<double, 3>>> momentum;  // linear, angular; none: left out of the line
  std::vector<std::pair<std::string, double>> times;                    // by part, s
  std::vector<SkippedPart> skipped;
  std::optional<double> smallest_gap;  // m; none where no surfaces are within dhat and no ground is
  int contacts = 0;
  std::vector<std::pair<std::string, std::array<double, 3>>> probes;  // m, by name; none: left out of the line
  std::vector<ObjectForces> forces;                                   // none: left out of the line
  std::vector<std::pair<std::string, double>> more;                   // further numbers by name, last in the line
};

// The record as a line of JSON without its line end: {"step": .., "time": .., "dt": .., "converged": ..,
// "newton_iterations": .., "linear_iterations": .., "residual": .., "energy": {term: J}, "budget": {part: J},
// "momentum": {kind: [..]}, "seconds": {part: s}, "skipped": [{"part": .., "reason": ..}], "smallest_gap": ..,
// "contacts": .., "forces": {object: {"contact": [..], "friction": [..]}}, "probes": {name: [..]}, more ..}, keys in
// this order.
std::string to_json(const ReportRecord& record);

// A .jsonl file to which lines are added one by one. Each line is handed to the system as a whole and at once, so that
// it can be read while the program runs; when that fails, what was written of the line is taken back. Throws
// OutputError naming the path and the system's reason.
class Report {
 public:
  // Starts the file anew, or goes on with it.
  explicit Report(std::string path, bool go_on = false);
  ~Report();
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  void append(const ReportRecord& record) { append_line(to_json(record)); }
  // For records of another kind; `json` must not hold a line end.
  void append_line(const std::string& json);

 private:
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace ergon
