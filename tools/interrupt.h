#pragma once
// Ending after a whole piece of work when the process is interrupted.

#include <csignal>

namespace ergon {

// While it lives, the first interrupt (SIGINT, SIGTERM) is remembered; a second one ends the process.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  struct sigaction old_int_ {};
  struct sigaction old_term_ {};
};

bool was_interrupted();

}  // namespace ergon
