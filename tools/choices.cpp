#include "tools/choices.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <array>

#include "runtime/error.h"
#include "symbolic/diagnostic.h"

namespace ergon {

size_t chosen(std::string_view option, const std::string& word, const std::vector<std::string>& choices) {
  auto found = std::find(choices.begin(), choices.end(), word);
  if (found != choices.end()) return static_cast<size_t>(found - choices.begin());
  throw InputError(
      fmt::format("{}: '{}' is none of {}{}", option, word, fmt::join(choices, ", "), did_you_mean(word, choices)));
}

Projection projection_named(const std::string& name) {
  const std::array kinds = {Projection::clamp, Projection::absolute, Projection::none};
  return kinds[chosen("--project", name, {"clamp", "abs", "none"})];
}

Precision precision_named(const std::string& name) {
  const std::array kinds = {Precision::double_, Precision::single, Precision::mixed};
  return kinds[chosen("--precision", name, {"double", "float", "mixed"})];
}

void set_threads(int threads) {
  if (threads < 1) throw InputError(fmt::format("--threads: {} is below 1", threads));
  omp_set_num_threads(threads);
}

}  // namespace ergon
