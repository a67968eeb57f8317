#include "symbolic/stretches.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "symbolic/elaborate.h"
#include "symbolic/isotropy.h"
#include "symbolic/sample_states.h"
#include "symbolic/state_text.h"
#include "symbolic/typing.h"

namespace ergon {
namespace {

constexpr int digits = 50;
constexpr double tolerance = 1e-40;
constexpr int wanted = 3, attempts = 24;  // states

bool calls_stretches(const Expression& e) {
  return (e.kind == Expression::Kind::call && e.text == "stretches") ||
         std::any_of(e.arguments.begin(), e.arguments.end(), [](const auto& a) { return calls_stretches(*a); });
}

// Gives two of the stretches in the other order.
class Exchanged : public ClnAlgebra {
 public:
  Exchanged(const ExactInputs& inputs, size_t i, size_t j) : ClnAlgebra(inputs, digits), i_(i), j_(j) {}
  std::vector<ClnNumber> stretches(const Tensor<ClnNumber>& F) const {
    std::vector<ClnNumber> s = ClnAlgebra::stretches(F);
    std::swap(s[i_], s[j_]);
    return s;
  }

 private:
  size_t i_, j_;
};

bool same(const ClnNumber& a, const ClnNumber& b) {
  return a.defined == b.defined && (!a.defined || cln::abs(a.value - b.value) <= tolerance * (1 + cln::abs(a.value)));
}

std::string list(const std::vector<ClnNumber>& values) {
  std::string text;
  for (const ClnNumber& x : values) text += fmt::format("{}{:.6g}", text.empty() ? "" : ", ", to_double(x));
  return text;
}

}  // namespace

bool uses_stretches(const Energy& energy) {
  const auto in = [](const Condition& c) { return calls_stretches(*c.left) || calls_stretches(*c.right); };
  return (energy.value && calls_stretches(*energy.value)) ||
         std::any_of(energy.lets.begin(), energy.lets.end(),
                     [](const Let& let) { return calls_stretches(*let.expression); }) ||
         std::any_of(energy.active.begin(), energy.active.end(), in) ||
         std::any_of(energy.require.begin(), energy.require.end(), in);
}

int digits_for_derivatives(const Energy& energy, int digits) {
  return uses_stretches(energy) ? 2 * digits + 20 : digits;
}

std::optional<Finding> check_stretches(const Energy& energy, const std::string& case_name) {
  if (energy.kind != Energy::Kind::density || !uses_stretches(energy)) return std::nullopt;
  const auto count = static_cast<size_t>(energy.symbols[0].shape.cols);
  const auto fault = [&](std::string message, const ExactInputs& state) {
    return Finding{Severity::error, "stretches", std::move(message), start_of(*energy.value),
                   state_text(energy, state)};
  };
  StateSampler sampler;
  std::optional<ExactInputs> any;
  for (int attempt = 0, seen = 0; attempt < attempts && seen < wanted; ++attempt) {
    const ExactInputs state = sampler.any(energy);
    ClnAlgebra numbers(state, digits);
    const ClnNumber value = elaborate(energy, case_name, numbers).value;
    if (!value.defined) continue;
    ++seen;
    if (!any) any = state;
    for (size_t i = 0; i < count; ++i) {
      for (size_t j = i + 1; j < count; ++j) {
        Exchanged exchanged(state, i, j);
        const ClnNumber other = elaborate(energy, case_name, exchanged).value;
        if (same(value, other)) continue;
        Tensor<ClnNumber> F{energy.symbols[0].shape, {}};
        for (int k = 0; k < F.shape.size(); ++k) F.at.push_back(numbers.input(energy.symbols[0], k));
        return fault(fmt::format("the value is not symmetric in the stretches: with {} it is {:.6g}, with {} it is "
                                 "{:.6g}{}; each must enter as the others do",
                                 list(numbers.stretches(F)), to_double(value), list(exchanged.stretches(F)),
                                 to_double(other), derivative_unit(energy, 0)),
                     state);
      }
    }
  }
  if (any && !is_isotropic(energy, case_name))
    return fault(
        "a density that calls `stretches` is a function of them alone, but this one sees more of F: the value "
        "changes when F is turned on either side; beside `stretches` use det(F), norm2(F) and the like, and "
        "put what has a direction into an energy of its own",
        *any);
  return Finding{Severity::ok, "stretches", "a symmetric function of the stretches (to 40 digits)", {}, ""};
}

}  // namespace ergon
