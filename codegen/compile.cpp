#include "codegen/compile.h"

#include <chrono>

#include "codegen/build.h"
#include "codegen/cache.h"
#include "codegen/differentiate.h"
#include "codegen/front_key.h"
#include "codegen/frontier.h"
#include "codegen/hash.h"
#include "codegen/lower.h"
#include "codegen/parts.h"
#include "codegen/principal.h"
#include "codegen/rest_form.h"
#include "codegen/schedule.h"
#include "codegen/structure.h"
#include "symbolic/stretches.h"

namespace ergon {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Everything that determines the library besides the source text.
std::string cache_key(const std::string& source, const std::string& compiler, VectorType type) {
  std::string all = source + '\0' + compiler;
  for (const std::string& flag : compiler_flags(type)) all += '\0' + flag;
  return content_hash(all);
}

std::string note_of(const PreparedKernel& prepared) {
  return to_text({prepared.key, prepared.kernel.source_bytes, prepared.kernel.counts}, prepared.front);
}

}  // namespace

Generated generate(const Energy& energy, const CompileOptions& options) {
  // A density in principal stretches is taken for a symmetric function of them.
  if (const auto fault = check_stretches(energy, options.case_name); fault && fault->severity == Severity::error)
    throw SourceError(fault->place, fault->message + ", at " + fault->state);
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
  pass("parts", out.times.parts, [&] { find_parts(out.module); });
  pass("schedule", out.times.schedule, [&] { code = schedule(out.module); });
  pass("emit", out.times.emit, [&] {
    Emitted emitted = emit(out.module, code, {options.lanes, options.single});
    out.source = std::move(emitted.source);
    out.counts = emitted.counts;
    out.costs = std::move(emitted.costs);
  });
  return out;
}

PreparedKernel prepare(const Energy& energy, const CompileOptions& options) {
  PreparedKernel out;
  out.cache = options.cache.empty() ? KernelCache::user_folder() : options.cache;
  out.compiler = options.compiler.empty() ? default_compiler() : options.compiler;
  out.maker = compiler_identity(out.compiler);
  out.type = {options.lanes, options.single};
  out.front = front_key(energy, {options.case_name, out.type, options.stable, out.compiler});
  const KernelCache given(options.read_only_caches), own({out.cache});
  const auto find = [&](const std::string& key) {
    const auto start = std::chrono::steady_clock::now();
    // What came with the program serves whatever compiler is here.
    std::optional<LoadedKernel> found = given.load(key, out.maker);
    if (!found) found = given.load(key, "");
    if (!found) found = own.load(key, out.maker);
    if (found) {
      out.kernel.library = found->library;
      out.kernel.table = found->table;
      out.kernel.cached = true;
    }
    out.kernel.times.load += seconds_since(start);
  };
  if (options.use_cached && !options.dump) {
    for (const KernelCache* cache : {&given, &own}) {
      const std::optional<std::string> text = cache->note(out.front);
      const std::optional<KernelNote> note = text ? note_from(*text, out.front) : std::nullopt;
      if (!note) continue;
      find(note->key);
      out.kernel.counts = note->counts;
      out.kernel.source_bytes = note->source_bytes;
      if (out.kernel.cached) return out;
    }
  }
  Generated generated = generate(energy, options);
  out.kernel.counts = generated.counts;
  out.kernel.source_bytes = generated.source.size();
  generated.times.load = out.kernel.times.load;
  out.kernel.times = generated.times;
  out.key = key_stem(energy, out.type) + cache_key(generated.source, out.compiler, out.type);
  if (options.use_cached) find(out.key);
  if (out.kernel.cached) own.keep_note(out.front, note_of(out));
  out.source = std::move(generated.source);
  return out;
}

CompiledKernel finish(PreparedKernel prepared) {
  if (prepared.kernel.cached) return std::move(prepared.kernel);
  CompileTimes& times = prepared.kernel.times;
  const KernelCache cache({prepared.cache});
  auto start = std::chrono::steady_clock::now();
  const LoadedKernel made =
      cache.make(prepared.key, prepared.maker, prepared.source, prepared.type, prepared.compiler, &times.compile);
  times.load += seconds_since(start) - times.compile;
  cache.keep_note(prepared.front, note_of(prepared));
  CompiledKernel out = std::move(prepared.kernel);
  out.library = made.library;
  out.table = made.table;
  return out;
}

CompiledKernel compile(const Energy& energy, const CompileOptions& options) { return finish(prepare(energy, options)); }

}  // namespace ergon
