#pragma once
// How far a run is and how long it will take: one line that is rewritten on a terminal, few plain lines elsewhere.

#include <deque>
#include <functional>
#include <iosfwd>
#include <string>

namespace ergon {

// "3.2 s", "4 min 10 s", "2 h 5 min", "3 d 4 h".
std::string duration_text(double seconds);

class Progress {
 public:
  // `steps` is the number of steps of the whole run. `clock` tells the seconds since any fixed moment.
  Progress(std::ostream& out, bool is_terminal, int steps, std::function<double()> clock = steady_seconds);

  // Tells that `step` steps are done and which simulated time (s) is reached. On a terminal the line is rewritten at
  // most ten times a second; elsewhere a line is written for each tenth of the run.
  void update(int step, double time, const std::string& note = "");

  // Ends the line on a terminal, so that what is printed next starts on a new one. May be called more than once.
  void finish();

  static double steady_seconds();

 private:
  double seconds_left(int step, double now) const;

  std::ostream& out_;
  bool is_terminal_;
  int steps_;
  std::function<double()> clock_;
  std::deque<std::pair<int, double>> recent_;  // steps done and when, for the pace of the last steps
  double start_;
  double last_written_ = -1;
  int last_tenth_ = 0;
  bool line_open_ = false;
};

}  // namespace ergon
