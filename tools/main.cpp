#include <malloc.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <limits>

#include "tools/command.h"

namespace {

// What libraries read when they are loaded, before main: so the program starts itself once more with it in place. A
// user's own settings stay.
//   OMP_WAIT_POLICY: idle threads that spin take the cores from the threads that work as soon as anything else runs on
// the machine: the bunny scene takes 8 times as long.
//   OPENBLAS_CORETYPE: OpenBLAS 0.3.21 knows no AMD processor with AVX-512 and takes its AVX2 kernels there, with which
// a large factorisation takes 1.2 times as long.
void set_libraries_up(char** argv) {
  bool changed = false;
  const auto set = [&](const char* name, const char* value) {
    if (std::getenv(name)) return;
    setenv(name, value, 1);
    changed = true;
  };
  if (!std::getenv("GOMP_SPINCOUNT")) set("OMP_WAIT_POLICY", "passive");
#ifdef __x86_64__
  if (__builtin_cpu_is("amd") && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
    set("OPENBLAS_CORETYPE", "SKYLAKEX");
#endif
  if (changed) execv("/proc/self/exe", argv);  // comes back only where it failed: then the libraries' own choice holds
}

// Factors of hundreds of megabytes come and go with the pattern of each matrix: memory that is given back to the system
// in between has to be cleared page by page before it can be used again.
void keep_freed_memory() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
}

}  // namespace

int main(int argc, char** argv) {
  set_libraries_up(argv);
  keep_freed_memory();
  std::signal(SIGXFSZ, SIG_IGN);  // a file-size limit is reported like a full disk
  return ergon::run_command_line(std::vector<std::string>(argv + 1, argv + argc), std::cout, std::cerr);
}
