#include "codegen/compile.h"

#include <chrono>

#include "codegen/build.h"
#include "codegen/cache.h"
#include "codegen/differentiate.h"
#include "codegen/frontier.h"
#include "codegen/hash.h"
#include "codegen/lower.h"
#include "codegen/principal.h"
#include "codegen/rest_form.h"
#include "codegen/schedule.h"
#include "codegen/structure.h"

namespace ergon {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Everything that determines the library besides the source text.
std::string cache_key(const std::string& source, const std::string& compiler, int lanes) {
  std::string all = source + '\0' + compiler;
  for (const std::string& flag : compiler_flags(lanes)) all += '\0' + flag;
  return content_hash(all);
}

}  // namespace

Generated generate(const Energy& energy, const CompileOptions& options) {
  Generated out;
  auto pass = [&](const char* name, double& seconds, auto&& run) {
    auto start = std::chrono::steady_clock::now();
    run();
    seconds = seconds_since(start);
    if (options.dump) options.dump(name, to_string(out.module.graph, out.module.roots()));
    if (options.dump) verify(out.module.graph);
  };
  Schedule code;
  pass("lower", out.times.lower, [&] { out.module = lower(energy, options.case_name); });
  pass("rest", out.times.rest, [&] {
    if (options.stable) rest_form(out.module);
  });
  pass("frontier", out.times.frontier, [&] { frontier(out.module); });
  pass("differentiate", out.times.differentiate, [&] { differentiate(out.module); });
  pass("structure", out.times.structure, [&] { find_structure(out.module); });
  pass("principal", out.times.principal, [&] { find_principal(out.module); });
  pass("schedule", out.times.schedule, [&] { code = schedule(out.module); });
  pass("emit", out.times.emit, [&] {
    Emitted emitted = emit(out.module, code, options.lanes);
    out.source = std::move(emitted.source);
    out.counts = emitted.counts;
  });
  return out;
}

CompiledKernel compile(const Energy& energy, const CompileOptions& options) {
  Generated generated = generate(energy, options);
  CompiledKernel out;
  out.counts = generated.counts;
  out.times = generated.times;

  std::vector<std::filesystem::path> folders = options.read_only_caches;
  folders.push_back(options.cache.empty() ? KernelCache::user_folder() : options.cache);
  std::string compiler = options.compiler.empty() ? default_compiler() : options.compiler;
  std::string key =
      energy.name + "-w" + std::to_string(options.lanes) + "-" + cache_key(generated.source, compiler, options.lanes);

  auto start = std::chrono::steady_clock::now();
  std::optional<LoadedKernel> kernel;
  if (options.use_cached) kernel = KernelCache(folders).load(key);
  out.cached = kernel.has_value();
  if (!kernel)
    kernel = KernelCache({folders.back()}).make(key, generated.source, options.lanes, compiler, &out.times.compile);
  out.times.load = seconds_since(start) - out.times.compile;

  out.library = kernel->library;
  out.table = kernel->table;
  out.source = std::move(generated.source);
  return out;
}

}  // namespace ergon
