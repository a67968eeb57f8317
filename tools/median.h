#pragma once
// How long something takes.

#include <algorithm>
#include <chrono>
#include <vector>

namespace ergon {

// Seconds of one call: the median of at least five and one second, after a first that is not counted.
template <class Call>
double median_seconds(const Call& call) {
  using Clock = std::chrono::steady_clock;
  call();
  std::vector<double> seconds;
  double sum = 0;
  while (seconds.size() < 5 || (sum < 1 && seconds.size() < 1000)) {
    const Clock::time_point start = Clock::now();
    call();
    seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    sum += seconds.back();
  }
  const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
  std::nth_element(seconds.begin(), middle, seconds.end());
  return *middle;
}

}  // namespace ergon
