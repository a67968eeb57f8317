#include <unistd.h>

#include <fmt/format.h>
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

void bench_case(const std::string& name, const std::string& case_name, const std::filesystem::path& cache, Rows& rows) {
  using Clock = std::chrono::steady_clock;
  auto seconds = [](Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); };
  const Clock::time_point start = Clock::now();
  const Energy energy = find_energy(name);
  const double read = seconds(start);
  CompileOptions options;
  options.case_name = case_name;
  options.lanes = lanes::best_lanes();
  options.cache = cache;
  const CompiledKernel kernel = compile(energy, options);
  const CompileTimes& t = kernel.times;
  rows.add({{"energy", case_name.empty() ? energy.name : energy.name + "/" + case_name},
            {"element", energy.geometry},
            {"read_s", read},
            {"differentiate_s", t.lower + t.rest + t.frontier + t.differentiate + t.structure + t.principal},
            {"emit_s", t.schedule + t.emit},
            {"compile_s", t.compile},
            {"load_s", t.load},
            {"total_s", seconds(start)},
            {"source_bytes", kernel.source.size()},
            {"cached", kernel.cached}});
}

}  // namespace

void bench_compile(const BenchCompile& options, Rows& rows) {
  const TemporaryFolder cache;
  for (const std::string& name : options.energies.empty() ? catalogue_names() : options.energies) {
    for (const std::string& case_name : cases_of(find_energy(name))) {
      bench_case(name, case_name, cache.path(), rows);
      bench_case(name, case_name, cache.path(), rows);
    }
  }
}

}  // namespace ergon
