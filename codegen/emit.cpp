#include "codegen/emit.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "codegen/function_text.h"
#include "codegen/kernel_abi_text.h"
#include "codegen/prelude.h"

namespace ergon {
namespace {

std::vector<Output> outputs_to(const std::string& array, const std::vector<int>& values) {
  std::vector<Output> out;
  for (size_t i = 0; i < values.size(); ++i) out.push_back({fmt::format("{}[{}]", array, i), values[i]});
  return out;
}

std::vector<Output> join(std::vector<Output> a, const std::vector<Output>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string commented(const std::string& text) {
  std::string out;
  size_t start = 0;
  while (start < text.size()) {
    size_t end = std::min(text.find('\n', start), text.size());
    std::string line = text.substr(start, end - start);
    // A backslash at the end of a line would continue the comment.
    while (!line.empty() && (line.back() == '\\' || line.back() == ' ' || line.back() == '\r')) line.pop_back();
    out += line.empty() ? "//\n" : "//   " + line + "\n";
    start = end + 1;
  }
  return out;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

void count_calls(const Program& p, const std::vector<int>& code, std::set<std::string>& used) {
  for (int i : code) {
    const char* prefix = p[i].lifetime <= Lifetime::uniform ? "s_" : "v_";
    if (p[i].op == Opcode::sqrt) used.insert(std::string(prefix) + "sqrt");
    if (p[i].op == Opcode::call) used.insert(std::string(prefix) + name_of(p[i].call));
  }
}

std::string entry(const std::string& name, const char* out_parameters, const char* out_vectors,
                  const std::string& body) {
  return fmt::format(
      "static void {}(const double* q_, const double* e_, const double* u, {}) {{\n"
      "  const V* q = (const V*)q_;\n  const V* e = (const V*)e_;\n{}  (void)q, (void)e, (void)u;\n{}}}\n\n",
      name, out_parameters, out_vectors, body);
}

// One of the three evaluations: its name, what it writes.
struct Evaluation {
  const char* name;
  const char* parameters;
  const char* vectors;
  const char* arguments;
};
constexpr Evaluation kEvaluations[] = {
    {"value", "double* value_, double* require_", "  V* value = (V*)value_;\n  V* require = (V*)require_;\n",
     "value_, require_"},
    {"gradient", "double* value_, double* gradient_", "  V* value = (V*)value_;\n  V* gradient = (V*)gradient_;\n",
     "value_, gradient_"},
    {"hessian", "double* value_, double* gradient_, double* hessian_",
     "  V* value = (V*)value_;\n  V* gradient = (V*)gradient_;\n  V* hessian = (V*)hessian_;\n",
     "value_, gradient_, hessian_"}};

// Runs the form that all lanes ask for; where they differ, both, and picks by lane.
std::string dispatch(const Evaluation& e, const FunctionText& near, int q_size) {
  const int packed = q_size * (q_size + 1) / 2, sizes[] = {1, q_size, packed};
  const std::string name = e.name;
  std::string arrays, far_arguments, picks;
  auto output = [&](const std::string& array, int size) {
    arrays += fmt::format("  V other_{}[{}];\n", array, size);
    far_arguments += fmt::format(", (double*)other_{}", array);
    picks += fmt::format("  for (int i = 0; i < {0}; ++i) {1}[i] = near > 0.0 ? {1}[i] : other_{1}[i];\n", size, array);
  };
  output("value", sizes[0]);
  if (name == "value") output("require", 1);
  if (name != "value") output("gradient", sizes[1]);
  if (name == "hessian") output("hessian", sizes[2]);
  return near.body + fmt::format(
                         "  const int lanes = lanes_above(near);\n"
                         "  if (lanes != 0) {0}_near(q_, e_, u, {1});\n"
                         "  if (lanes == 0) {0}_far(q_, e_, u, {1});\n"
                         "  if (lanes == 0 || lanes == all_lanes) return;\n"
                         "{2}  {0}_far(q_, e_, u{3});\n{4}",
                         name, e.arguments, arrays, far_arguments, picks);
}

std::string input_table(const Module& m) {
  std::string out = "static const ErgonInput inputs[] = {\n";
  for (size_t i = 0; i < m.energy->symbols.size(); ++i) {
    const Symbol& s = m.energy->symbols[i];
    if (s.role == Role::dof) continue;
    const char* role = s.role == Role::param ? "ERGON_PARAM" : s.role == Role::rest ? "ERGON_REST" : "ERGON_LAG";
    out += fmt::format("  {{{}, {}, {}, {}, {}}},\n", quoted(s.name), role, s.shape.rows, s.shape.cols, m.offsets[i]);
  }
  return out + "  {0, 0, 0, 0, 0}};\n";
}

std::string kernel_table(const Module& m, const OperationCounts& c, int lanes) {
  bool density = m.points == 0;
  std::string weights;
  for (double w : m.weights) weights += (weights.empty() ? "" : ", ") + literal(w);
  int inputs = 0;
  std::string points;
  for (const Symbol& s : m.energy->symbols) {
    inputs += s.role != Role::dof;
    if (s.role == Role::dof) points += (points.empty() ? "" : ", ") + quoted(s.name);
  }
  std::string out = input_table(m);
  if (!density) out += fmt::format("static const double weights[] = {{{}}};\n", weights);
  if (!density) out += fmt::format("static const char* const points[] = {{{}}};\n", points);
  out += fmt::format(
      "extern \"C\" __attribute__((visibility(\"default\"))) const ErgonKernel ergon_kernel = {{\n"
      "  ERGON_KERNEL_ABI, {}, {}, {}, {}, {}, {}, {}, {},\n  {}, inputs, {}, {}, {}, {}, {}, {},\n  {}, {}, {}, {},\n"
      "  {}, {}, {}, {},\n  prepare_uniforms, prepare_elements, conditions, value_entry, gradient_entry, "
      "hessian_entry, {},\n  {}, {}, {}, {}}};\n",
      lanes, quoted(m.energy->name), quoted(m.case_name), quoted(m.energy->geometry), density ? 1 : 0, m.points,
      m.q_vectors, density ? "0" : "weights", inputs, m.params, m.raw, c.uniforms, c.elements, m.require.size(),
      m.active.size(), int{m.constant_gradient}, int{m.constant_hessian}, int{m.zero_hessian}, int{m.psd_hessian},
      c.value, c.gradient, c.hessian, c.divisions, density ? "0" : "points", int{m.displacement},
      m.principal.empty() ? "0" : "principal_entry", c.principal, m.changed >= 0 ? "projected_entry" : "0");
  return out;
}

std::string header(const Module& m, const OperationCounts& c, const std::vector<EntryCost>& costs) {
  return fmt::format(
             "// {}{}: kernel made by Ergon from the energy below.\n"
             "// Cost per lane, as `ergon cost` tells it:\n{}"
             "// Kept: {} values per material, {} per element. q: {} components{}.\n//\n",
             m.energy->name, m.case_name.empty() ? "" : ", case " + m.case_name, cost_table(costs, "//   "), c.uniforms,
             c.elements, m.q_size(), m.displacement ? ", those of F - I" : "") +
         commented(m.energy->text) + "\n";
}

}  // namespace

Emitted emit(const Module& m, const Schedule& s, int lanes) {
  const Program& p = s.program;
  Slots slots = assign_slots(s);
  auto text = [&](const std::vector<Output>& outputs) {
    return function_text(p, slots, outputs, false, true, true, "raw");
  };
  // The value entry also gives the smallest margin.
  std::vector<Output> margins;
  std::string smallest = "  require[0] = __builtin_inf() - V{};\n";
  for (size_t i = 0; i < s.require.size(); ++i) {
    margins.push_back({fmt::format("const V margin{}", i), s.require[i]});
    smallest += fmt::format("  require[0] = v_min(margin{}, require[0]);\n", i);
  }
  // By form, near before far, and evaluation.
  const bool two_forms = m.near >= 0;
  std::vector<FunctionText> texts;
  OperationCounts counts[2];
  for (int form = 0; form < (two_forms ? 2 : 1); ++form) {
    std::vector<Output> value = {{"value[0]", form == 0 ? s.value : s.far_value}};
    std::vector<Output> gradient = join(value, outputs_to("gradient", form == 0 ? s.gradient : s.far_gradient));
    std::vector<Output> hessian = join(gradient, outputs_to("hessian", form == 0 ? s.hessian : s.far_hessian));
    OperationCounts& c = counts[form];
    c.value = static_cast<int>(text(value).instructions.size());
    texts.push_back(text(join(value, margins)));
    texts.back().body += smallest;
    texts.push_back(text(gradient));
    c.gradient = static_cast<int>(texts.back().instructions.size());
    texts.push_back(text(hessian));
    c.hessian = static_cast<int>(texts.back().instructions.size());
    for (int i : texts.back().instructions) {
      c.divisions += p[i].op == Opcode::divide;
      c.roots += p[i].op == Opcode::sqrt;
      c.calls += p[i].op == Opcode::call && p[i].call < Call::abs;
    }
    c.uniforms = static_cast<int>(slots.uniforms.size());
    c.elements = static_cast<int>(slots.elements.size());
  }
  FunctionText uniforms = function_text(p, slots, outputs_to("u", slots.uniforms), true, false, false, "raw");
  FunctionText elements = function_text(p, slots, outputs_to("e", slots.elements), false, true, false, "raw");
  FunctionText conditions = text(join(outputs_to("active", s.active), outputs_to("require", s.require)));
  FunctionText principal_text = text(outputs_to("blocks", s.principal));
  FunctionText projected_text;
  if (s.changed >= 0)
    projected_text = text(join(join(outputs_to("gradient", s.gradient), outputs_to("projected", s.projected)),
                               {{"value[0]", s.value}, {"changed[0]", s.changed}}));
  FunctionText near = two_forms ? text({{"const V near", s.near}}) : FunctionText{};

  std::set<std::string> used;
  if (!s.require.empty()) used.insert("v_min");
  if (two_forms) used.insert("lanes_above");
  std::vector<const FunctionText*> all = {&uniforms, &elements, &conditions, &near, &principal_text, &projected_text};
  for (const FunctionText& t : texts) all.push_back(&t);
  for (const FunctionText* f : all) count_calls(p, f->instructions, used);

  Emitted out;
  counts[0].principal = static_cast<int>(principal_text.instructions.size());
  counts[0].projected = static_cast<int>(projected_text.instructions.size());
  out.counts = counts[0];
  out.costs = cost_of_entries(s);
  out.source = header(m, out.counts, out.costs) + prelude(lanes, used) + kKernelAbiText + "\n";
  out.source += fmt::format(
      "static void prepare_uniforms(const double* params, double* u) {{\n  (void)params, (void)u;\n{}}}\n\n",
      uniforms.body);
  out.source += fmt::format(
      "static void prepare_elements(const double* raw_, const double* u, double* e_) {{\n"
      "  const V* raw = (const V*)raw_;\n  V* e = (V*)e_;\n  (void)raw, (void)u, (void)e;\n{}}}\n\n",
      elements.body);
  out.source += entry("conditions", "double* active_, double* require_",
                      "  V* active = (V*)active_;\n  V* require = (V*)require_;\n  (void)active, (void)require;\n",
                      conditions.body);
  for (size_t i = 0; i < 3; ++i) {
    const Evaluation& e = kEvaluations[i];
    const std::string name = e.name;
    out.source += entry(name + (two_forms ? "_near" : "_entry"), e.parameters, e.vectors, texts[i].body);
    if (!two_forms) continue;
    out.source += entry(name + "_far", e.parameters, e.vectors, texts[3 + i].body);
    out.source += entry(name + "_entry", e.parameters, e.vectors, dispatch(e, near, m.q_size()));
  }
  if (!m.principal.empty())
    out.source += fmt::format(
        "static void principal_entry(const double* s_, const double* e_, const double* u, double* blocks_) {{\n"
        "  const V* s = (const V*)s_;\n  const V* e = (const V*)e_;\n  V* blocks = (V*)blocks_;\n"
        "  (void)s, (void)e, (void)u;\n{}}}\n\n",
        principal_text.body);
  if (s.changed >= 0)
    out.source += entry(
        "projected_entry", "double negative_, double* value_, double* gradient_, double* projected_, double* changed_",
        "  const V negative = negative_ - V{};\n  V* value = (V*)value_;\n  V* gradient = (V*)gradient_;\n"
        "  V* projected = (V*)projected_;\n  V* changed = (V*)changed_;\n",
        projected_text.body);
  out.source += kernel_table(m, counts[0], lanes);
  return out;
}

}  // namespace ergon
