#include "tools/verify/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "runtime/error.h"
#include "symbolic/diagnostic.h"

namespace ergon {

double VerifyRow::error() const {
  return reference == 0 ? std::fabs(value) : std::fabs(value - reference) / std::fabs(reference);
}

VerifyRow limit_of(const VerifyRow& coarse, const VerifyRow& fine, double reference) {
  VerifyRow row{fine.quantity + ", limit", fine.element, "cells to 0", 2 * fine.value - coarse.value, reference};
  row.note = "what the two tend to, as errors go in proportion to cells";
  return row;
}

const VerifyCase& verify_case(const std::string& name) {
  const std::vector<VerifyCase>& cases = verify_cases();
  const auto found = std::find_if(cases.begin(), cases.end(), [&](const VerifyCase& c) { return c.name == name; });
  if (found != cases.end()) return *found;
  std::vector<std::string> names;
  for (const VerifyCase& c : cases) names.push_back(c.name);
  throw InputError(fmt::format("there is no verification case '{}'{}", name, did_you_mean(name, names)));
}

}  // namespace ergon
