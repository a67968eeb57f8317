#include <unistd.h>

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <filesystem>

#include "runtime/lanes/lanes.h"
#include "tools/bench.h"
#include "tools/installation.h"

namespace ergon {
namespace {

// An empty folder that goes with the object.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(std::filesystem::temp_directory_path() / fmt::format("ergon-bench-{}", getpid())) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct Timing {
  double read = 0, differentiate = 0, emit = 0, compile = 0, load = 0, total = 0;  // s
  size_t source_bytes = 0;
  bool cached = false;
  double generate() const { return read + differentiate + emit; }  // all that is done without the C++ compiler
};

Timing time_of(const std::string& name, const std::string& case_name, const std::filesystem::path& cache,
               bool use_cached) {
  using Clock = std::chrono::steady_clock;
  auto seconds = [](Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); };
  const Clock::time_point start = Clock::now();
  const Energy energy = find_energy(name);
  Timing timing;
  timing.read = seconds(start);
  CompileOptions options;
  options.case_name = case_name;
  options.lanes = lanes::best_lanes();
  options.cache = cache;
  options.use_cached = use_cached;
  const CompiledKernel kernel = compile(energy, options);
  const CompileTimes& t = kernel.times;
  timing.differentiate = t.lower + t.rest + t.frontier + t.differentiate + t.structure + t.principal;
  timing.emit = t.schedule + t.emit;
  timing.compile = t.compile;
  timing.load = t.load;
  timing.total = seconds(start);
  timing.source_bytes = kernel.source_bytes;
  timing.cached = kernel.cached;
  return timing;
}

// The one in the middle by total time.
Timing median_of(int count, const std::string& name, const std::string& case_name, const std::filesystem::path& cache,
                 bool use_cached) {
  std::vector<Timing> all;
  for (int i = 0; i < count; ++i) all.push_back(time_of(name, case_name, cache, use_cached));
  std::sort(all.begin(), all.end(), [](const Timing& a, const Timing& b) { return a.total < b.total; });
  return all[all.size() / 2];
}

Row row_of(const std::string& energy, const std::string& element, const Timing& t) {
  return {{"energy", energy},       {"element", element},
          {"read_s", t.read},       {"differentiate_s", t.differentiate},
          {"emit_s", t.emit},       {"generate_s", t.generate()},
          {"compile_s", t.compile}, {"load_s", t.load},
          {"total_s", t.total},     {"source_bytes", t.source_bytes},
          {"cached", t.cached}};
}

// Each figure the largest of the two.
Timing slower(const Timing& a, const Timing& b) {
  return {std::max(a.read, b.read),
          std::max(a.differentiate, b.differentiate),
          std::max(a.emit, b.emit),
          std::max(a.compile, b.compile),
          std::max(a.load, b.load),
          std::max(a.total, b.total),
          std::max(a.source_bytes, b.source_bytes),
          b.cached};
}

}  // namespace

void bench_compile(const BenchCompile& options, Rows& rows) {
  const TemporaryFolder cache;
  Timing slowest[2];
  for (const std::string& name : options.energies.empty() ? catalogue_names() : options.energies) {
    const Energy energy = find_energy(name);
    for (const std::string& case_name : cases_of(energy)) {
      const std::string shown = case_name.empty() ? energy.name : energy.name + "/" + case_name;
      const Timing first = median_of(3, name, case_name, cache.path(), false);
      const Timing again = median_of(5, name, case_name, cache.path(), true);
      rows.add(row_of(shown, energy.geometry, first));
      rows.add(row_of(shown, energy.geometry, again));
      slowest[0] = slower(slowest[0], first);
      slowest[1] = slower(slowest[1], again);
    }
  }
  if (!options.slowest) return;
  for (const Timing& timing : slowest) rows.add(row_of("slowest", "-", timing));
}

}  // namespace ergon
