#pragma once
// The problems of the work-precision study, and the settings that each is run with.

#include <string>
#include <vector>

namespace ergon {

struct AccuracySetting {
  std::string element, cells;  // "tet10", "[8, 1, 1]"
  std::string integrator;
  double dt = 0;                     // s; the longest, where dt follows the error
  double tolerance = 1e-4;           // m/s, of Newton's method
  std::string precision = "double";  // of the energies
  double time_tolerance = 0;         // m; 0: dt does not follow the error

  // "PATH=VALUE" for a scene whose object is named body.
  std::vector<std::string> changes() const;
  std::string text() const;
};

struct AccuracyProblem {
  std::string name;     // of its scene in scenes/studies
  std::string summary;  // a line
  bool smooth = true;   // without contact: the orders of elements and integrators show
  // "PATH=VALUE", of all runs: what the solver would choose by the setting, so that all solve the same problem.
  std::vector<std::string> model;
  std::vector<AccuracySetting> settings;
  // What errors are counted against, and a setting of another element and integrator, whose error against it tells how
  // far both can be trusted.
  AccuracySetting reference, other_reference;

  // Of a run: those of the model and of the setting.
  std::vector<std::string> changes(const AccuracySetting& setting) const;
};

// brief: few settings and a coarse reference, a second or so in all.
std::vector<AccuracyProblem> accuracy_problems(bool brief);

// Of those, the ones named, in their order; all where none is named. Throws InputError with the nearest name.
std::vector<AccuracyProblem> accuracy_problems(bool brief, const std::vector<std::string>& names);

}  // namespace ergon
