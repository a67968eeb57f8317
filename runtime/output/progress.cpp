#include "runtime/output/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ostream>

namespace ergon {
namespace {

constexpr size_t kRecentSteps = 50;
constexpr size_t kWidth = 79;  // a longer line would wrap on a terminal and could not be rewritten

}  // namespace

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds)) return "unknown";
  if (seconds < 9.95) return fmt::format("{:.1f} s", std::max(0.0, seconds));
  const long long whole = std::llround(std::min(seconds, 1e15));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  if (whole < 86400) return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
  return fmt::format("{} d {} h", whole / 86400, whole % 86400 / 3600);
}

double Progress::steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Progress::Progress(std::ostream& out, bool is_terminal, int steps, std::function<double()> clock)
    : out_(out), is_terminal_(is_terminal), steps_(std::max(steps, 1)), clock_(std::move(clock)), start_(clock_()) {
  recent_.emplace_back(0, start_);
}

double Progress::seconds_left(int step, double now) const {
  const auto& [from_step, from] = recent_.front();
  return step > from_step ? (now - from) / (step - from_step) * (steps_ - step) : NAN;
}

void Progress::update(int step, double time, const std::string& note) {
  const double now = clock_();
  const double left = seconds_left(step, now);
  recent_.emplace_back(step, now);
  if (recent_.size() > kRecentSteps) recent_.pop_front();

  const bool done = step >= steps_;
  const int tenth = static_cast<int>(10LL * std::clamp(step, 0, steps_) / steps_);
  if (is_terminal_ ? !done && last_written_ >= 0 && now - last_written_ < 0.1 : tenth <= last_tenth_) return;
  last_written_ = now;
  last_tenth_ = tenth;

  std::string line = fmt::format("step {}/{}  {:3d} %  t = {:.4g} s", step, steps_,
                                 static_cast<int>(100LL * std::clamp(step, 0, steps_) / steps_), time);
  line += done ? fmt::format("  took {}", duration_text(now - start_)) : fmt::format("  {} left", duration_text(left));
  if (!note.empty()) line += "  " + note;
  if (is_terminal_) {
    if (line.size() > kWidth) line.resize(kWidth);
    // Back to the start of the line, and clear what is longer than the new one.
    out_ << '\r' << line << "\x1b[K" << std::flush;
    line_open_ = true;
  } else {
    out_ << line << '\n' << std::flush;
  }
}

void Progress::finish() {
  if (line_open_) out_ << '\n' << std::flush;
  line_open_ = false;
}

}  // namespace ergon
