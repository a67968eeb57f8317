#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iostream>

#include "tools/command.h"

namespace {

// Idle threads that spin take the cores from the threads that work as soon as anything else runs on the machine: the
// bunny scene takes 8 times as long. The OpenMP library reads its settings when it is loaded, before main, so the
// program starts itself once more with the setting in place; a user's own setting stays.
void let_idle_threads_sleep(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") || std::getenv("GOMP_SPINCOUNT")) return;
  setenv("OMP_WAIT_POLICY", "passive", 1);
  execv("/proc/self/exe", argv);  // comes back only where it failed: then idle threads spin
}

}  // namespace

int main(int argc, char** argv) {
  let_idle_threads_sleep(argv);
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is reported like a full disk
  return ergon::run_command_line(std::vector<std::string>(argv + 1, argv + argc), std::cout, std::cerr);
}
