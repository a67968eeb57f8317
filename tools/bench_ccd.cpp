#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numeric>

#include "runtime/contact/ccd_inclusion.h"
#include "runtime/error.h"
#include "tools/bench.h"
#include "tools/contact_cases.h"
#include "tools/exact_collision.h"

namespace ergon {
namespace {

using Method = double (*)(const CcdQuery&);

struct CcdPrimitives {
  const char* name;
  bool edges;
  Method additive, inclusion;
  bool (*collides)(const Eigen::Vector3d*, const Eigen::Vector3d*, double);
};
const CcdPrimitives kPrimitives[] = {
    {"point_triangle", false, point_triangle_step, point_triangle_step_by_inclusion, point_triangle_collides},
    {"edge_edge", true, edge_edge_step, edge_edge_step_by_inclusion, edge_edge_collides}};

Row measure(const std::vector<ContactCases::Moving>& queries, double kept, const CcdPrimitives& primitives,
            const Method& method) {
  using Clock = std::chrono::steady_clock;
  const size_t count = queries.size();
  std::vector<double> steps(count), ns(count);
  for (size_t i = 0; i < count; ++i) {
    const auto start = Clock::now();
    steps[i] = method({queries[i].x.data(), queries[i].motion.data(), 0, kept});
    ns[i] = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
  }
  long shortened = 0, missed = 0, none = 0;
#pragma omp parallel for reduction(+ : shortened, missed, none) schedule(dynamic, 64)
  for (size_t i = 0; i < count; ++i) {
    const auto collides = [&](double until) {
      return primitives.collides(queries[i].x.data(), queries[i].motion.data(), until);
    };
    none += steps[i] == 0 ? 1 : 0;
    shortened += steps[i] < 1 && !collides(1) ? 1 : 0;
    missed += steps[i] > 0 && collides(steps[i]) ? 1 : 0;
  }
  const double mean = std::accumulate(ns.begin(), ns.end(), 0.0) / static_cast<double>(count);
  const auto quantile = [&](size_t at) {
    std::nth_element(ns.begin(), ns.begin() + static_cast<std::ptrdiff_t>(at), ns.end());
    return ns[at];
  };
  return {{"primitives", primitives.name},
          {"queries", count},
          {"median_ns", quantile(count / 2)},
          {"mean_ns", mean},
          {"p99_ns", quantile(count * 99 / 100)},
          {"false_positives", static_cast<double>(shortened) / static_cast<double>(count)},
          {"without_step", none},
          {"missed", missed}};
}

}  // namespace

void bench_ccd(const BenchCcd& options, Rows& rows) {
  if (options.queries < 100) throw InputError(fmt::format("{} queries; at least 100 are needed", options.queries));
  if (!(options.kept > 0 && options.kept < 1)) {
    throw InputError(fmt::format("--kept {}: it is a fraction above 0 and below 1", options.kept));
  }
  const size_t share = static_cast<size_t>(options.queries) / 4;
  unsigned seed = 1;
  for (const char* set : {"near_contact", "adversarial"}) {
    for (const CcdPrimitives& primitives : kPrimitives) {
      ContactCases cases(seed++);
      std::vector<ContactCases::Moving> queries(share);
      for (ContactCases::Moving& query : queries) {
        query = std::string(set) == "near_contact" ? cases.near_contact(primitives.edges) : cases.any(primitives.edges);
      }
      const auto add = [&](const char* name, const Method& method) {
        Row row{{"set", set}, {"method", name}};
        row.update(measure(queries, options.kept, primitives, method));
        rows.add(row);
      };
      add("additive", primitives.additive);
      queries.resize((share + 19) / 20);
      add("inclusion", primitives.inclusion);
    }
  }
}

}  // namespace ergon
