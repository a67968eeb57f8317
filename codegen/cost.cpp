#include "codegen/cost.h"

#include <algorithm>

#include <fmt/format.h>

#include "codegen/slots.h"

namespace ergon {
namespace {

constexpr int bytes = 8;  // of a double

using Roots = std::vector<int>;

Roots join(Roots a, const Roots& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class Counter {
 public:
  explicit Counter(const Schedule& schedule) : p_(schedule.program), slots_(assign_slots(schedule)) {}

  const Slots& slots() const { return slots_; }

  EntryCost count(const char* entry, const Roots& roots, bool reads_uniforms, bool reads_elements, int outputs) const {
    std::vector<const std::vector<int>*> given;
    if (reads_uniforms) given.push_back(&slots_.uniform);
    if (reads_elements) given.push_back(&slots_.element);
    EntryCost cost;
    cost.entry = entry;
    cost.bytes_out = bytes * outputs;
    for (int i : needed(p_, roots, given)) {
      const Instruction& code = p_[i];
      if (reads_uniforms && slots_.uniform[static_cast<size_t>(i)] >= 0) {
        cost.bytes_uniform += bytes;
      } else if (reads_elements && slots_.element[static_cast<size_t>(i)] >= 0) {
        cost.bytes_in += bytes;
      } else if (code.op == Opcode::input) {
        (code.source == Source::param ? cost.bytes_uniform : cost.bytes_in) += bytes;
      } else if (is_operation(code)) {
        ++cost.operations;
        cost.divisions += code.op == Opcode::divide;
        cost.roots += code.op == Opcode::sqrt;
        cost.calls += code.op == Opcode::call && code.call < Call::abs;
      }
    }
    return cost;
  }

 private:
  const Program& p_;
  Slots slots_;
};

}  // namespace

std::vector<EntryCost> cost_of_entries(const Schedule& s) {
  const Counter counter(s);
  const Slots& slots = counter.slots();
  auto size = [](const Roots& roots) { return static_cast<int>(roots.size()); };
  const Roots value = {s.value}, gradient = join(value, s.gradient), hessian = join(gradient, s.hessian);
  const Roots conditions = join(s.active, s.require);
  std::vector<EntryCost> entries = {
      counter.count("prepare_uniforms", slots.uniforms, false, false, size(slots.uniforms)),
      counter.count("prepare_elements", slots.elements, true, false, size(slots.elements)),
      counter.count("conditions", conditions, true, true, size(conditions)),
      counter.count("value", join(value, s.require), true, true, 2),  // and the smallest margin
      counter.count("gradient", gradient, true, true, size(gradient)),
      counter.count("hessian", hessian, true, true, size(hessian))};
  if (s.near >= 0) {
    const Roots far_value = {s.far_value}, far_gradient = join(far_value, s.far_gradient),
                far_hessian = join(far_gradient, s.far_hessian);
    entries.push_back(counter.count("value, far", join(far_value, s.require), true, true, 2));
    entries.push_back(counter.count("gradient, far", far_gradient, true, true, size(far_gradient)));
    entries.push_back(counter.count("hessian, far", far_hessian, true, true, size(far_hessian)));
  }
  if (!s.update.empty()) entries.push_back(counter.count("update", s.update, true, true, size(s.update)));
  if (!s.principal.empty()) entries.push_back(counter.count("principal", s.principal, true, true, size(s.principal)));
  if (s.changed >= 0) {
    const Roots projected = join(join(gradient, s.projected), {s.changed});
    entries.push_back(counter.count("projected", projected, true, true, size(projected)));
  }
  return entries;
}

int operations_when_projected(const std::vector<EntryCost>& entries) {
  const auto of = [&](const std::string& entry) -> const EntryCost* {
    const auto found =
        std::find_if(entries.begin(), entries.end(), [&](const EntryCost& c) { return c.entry == entry; });
    return found == entries.end() ? nullptr : &*found;
  };
  if (of("principal")) return of("gradient")->operations + of("principal")->operations;
  return (of("projected") ? of("projected") : of("hessian"))->operations;
}

std::string cost_table(const std::vector<EntryCost>& entries, const std::string& margin) {
  std::string text = fmt::format("{}{:<16}  {:>10}  {:>9}  {:>5}  {:>5}  {:>8}  {:>10}  {:>9}\n", margin, "entry point",
                                 "operations", "divisions", "roots", "calls", "bytes in", "of uniform", "bytes out");
  for (const EntryCost& c : entries)
    text += fmt::format("{}{:<16}  {:>10}  {:>9}  {:>5}  {:>5}  {:>8}  {:>10}  {:>9}\n", margin, c.entry, c.operations,
                        c.divisions, c.roots, c.calls, c.bytes_in, c.bytes_uniform, c.bytes_out);
  return text;
}

}  // namespace ergon
