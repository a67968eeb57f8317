#include "codegen/emit.h"

#include <algorithm>
#include <cmath>
#include <limits>
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

void count_calls(const Program& p, const std::vector<int>& code, bool scalar, std::set<std::string>& used) {
  for (int i : code) {
    const char* prefix = scalar || p[i].lifetime <= Lifetime::uniform ? "s_" : "v_";
    if (p[i].op == Opcode::sqrt) used.insert(std::string(prefix) + "sqrt");
    if (p[i].op == Opcode::call) used.insert(std::string(prefix) + name_of(p[i].call));
  }
}

// A function of q over lanes; `outputs` are the arrays that it writes.
std::string entry(const std::string& name, const std::string& real, const std::vector<std::string>& outputs,
                  const std::string& body, const std::string& first_parameter = "") {
  std::string parameters, vectors;
  for (const std::string& output : outputs) {
    parameters += fmt::format(", {}* {}_", real, output);
    vectors += fmt::format("  V* {0} = (V*){0}_;\n", output);
  }
  return fmt::format(
      "static void {}(const {}* q_, const {}* e_, const {}* u{}{}) {{\n"
      "  const V* q = (const V*)q_;\n  const V* e = (const V*)e_;\n{}  (void)q, (void)e, (void)u;\n{}}}\n\n",
      name, real, real, real, first_parameter, parameters, vectors, body);
}

// One of the three evaluations: its name, what it writes.
struct Evaluation {
  std::string name;
  std::vector<std::string> outputs;
};
std::vector<Evaluation> evaluations() {
  return {{"value", {"value", "require"}},
          {"gradient", {"value", "gradient"}},
          {"hessian", {"value", "gradient", "hessian"}}};
}

// Runs the form that all lanes ask for; where they differ, both, and picks by lane.
std::string dispatch(const Evaluation& e, const FunctionText& near, int q_size, int hessian_size, bool single) {
  std::string arrays, arguments, far_arguments, picks;
  for (const std::string& array : e.outputs) {
    const int size = array == "gradient" ? q_size : array == "hessian" ? hessian_size : 1;
    arrays += fmt::format("  V other_{}[{}];\n", array, size);
    arguments += fmt::format("{}{}_", arguments.empty() ? "" : ", ", array);
    far_arguments += fmt::format(", ({}*)other_{}", single ? "float" : "double", array);
    picks += fmt::format("  for (int i = 0; i < {0}; ++i) {1}[i] = near > {2} ? {1}[i] : other_{1}[i];\n", size, array,
                         literal(0, single));
  }
  return near.body + fmt::format(
                         "  const int lanes = lanes_above(near);\n"
                         "  if (lanes != 0) {0}_near(q_, e_, u, {1});\n"
                         "  if (lanes == 0) {0}_far(q_, e_, u, {1});\n"
                         "  if (lanes == 0 || lanes == all_lanes) return;\n"
                         "{2}  {0}_far(q_, e_, u{3});\n{4}",
                         e.name, arguments, arrays, far_arguments, picks);
}

// Every number of the code becomes a float that is neither zero nor infinite.
void check_floats(const Program& p, const Energy& energy) {
  for (int i = 0; i < p.size(); ++i) {
    const double number = p[i].constant, size = std::abs(number);
    if (p[i].op != Opcode::constant || number == 0 || !std::isfinite(number)) continue;
    if (number > 0 && number < kGuard) continue;
    if (size >= std::numeric_limits<float>::min() && size <= std::numeric_limits<float>::max()) continue;
    throw SourceError({energy.file}, fmt::format("{} cannot be evaluated in single precision: no float comes near its "
                                                 "number {}; use --precision double",
                                                 energy.name, number));
  }
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

// The numbers of what the energy renews among the inputs.
std::vector<int> updated_inputs(const Module& m) {
  std::vector<int> out;
  for (const Let& update : m.energy->updates) {
    int number = 0;
    for (const Symbol& s : m.energy->symbols) {
      if (s.name == update.name) out.push_back(number);
      number += s.role != Role::dof;
    }
  }
  return out;
}

std::string kernel_table(const Module& m, const OperationCounts& c, VectorType type) {
  const bool density = m.points == 0, principal = !m.principal.empty(), projected = m.changed >= 0;
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
  if (!m.update.empty())
    out += fmt::format("static const int updates[] = {{{}}};\n", fmt::join(updated_inputs(m), ", "));
  if (!m.parts.empty()) out += fmt::format("static const int parts[] = {{{}}};\n", fmt::join(m.parts, ", "));
  if (!density) out += fmt::format("static const char* const points[] = {{{}}};\n", points);
  const std::string entries =
      "prepare_uniforms, prepare_elements, conditions, value_entry, gradient_entry, hessian_entry";
  if (type.single)
    out += fmt::format("static const ErgonSingle single = {{\n  {},\n  {}, {}}};\n", entries,
                       principal ? "principal_entry" : "0", projected ? "projected_entry" : "0");
  out += fmt::format(
      "extern \"C\" __attribute__((visibility(\"default\"))) const ErgonKernel ergon_kernel = {{\n"
      "  ERGON_KERNEL_ABI, {}, {}, {}, {}, {}, {}, {}, {},\n  {}, inputs, {}, {}, {}, {}, {}, {},\n  {}, {}, {}, {},\n"
      "  {}, {}, {}, {},\n  {}, {},\n  {}, {}, {}, {}, {}, {}, {}, {}, {}, {}}};\n",
      type.lanes, quoted(m.energy->name), quoted(m.case_name), quoted(m.energy->geometry), density ? 1 : 0, m.points,
      m.q_vectors, density ? "0" : "weights", inputs, m.params, m.raw, c.uniforms, c.elements, m.require.size(),
      m.active.size(), int{m.constant_gradient}, int{m.constant_hessian}, int{m.zero_hessian}, int{m.psd_hessian},
      c.value, c.gradient, c.hessian, c.divisions, type.single ? "0, 0, 0, 0, 0, 0" : entries, density ? "0" : "points",
      int{m.displacement}, principal && !type.single ? "principal_entry" : "0", c.principal,
      projected && !type.single ? "projected_entry" : "0", type.single ? "&single" : "0",
      m.parts.empty() ? "0" : "parts", int{m.stretches}, m.energy->updates.size(), m.update.empty() ? "0" : "updates",
      m.update.empty() ? "0" : "update_entry");
  return out;
}

std::string header(const Module& m, const OperationCounts& c, const std::vector<EntryCost>& costs) {
  return fmt::format(
             "// {}{}: kernel made by Ergon from the energy below.\n"
             "// Cost per lane, as `ergon cost` tells it:\n{}"
             "// Kept: {} values per material, {} per element. q: {} components{}.\n//\n",
             m.energy->name, m.case_name.empty() ? "" : ", case " + m.case_name, cost_table(costs, "//   "), c.uniforms,
             c.elements, m.q_size(),
             m.stretches ? (m.displacement ? ", the stretches less 1" : ", the stretches")
                         : (m.displacement ? ", those of F - I" : "")) +
         commented(m.energy->text) + "\n";
}

}  // namespace

Emitted emit(const Module& m, const Schedule& s, VectorType type) {
  const Program& p = s.program;
  const std::string real = type.real();
  if (type.single) check_floats(p, *m.energy);
  if (type.single && !m.update.empty())
    throw SourceError({m.energy->file}, fmt::format("{} renews lags, which is not done in single precision; use "
                                                    "--precision double",
                                                    m.energy->name));
  Slots slots = assign_slots(s);
  auto text = [&](const std::vector<Output>& outputs) {
    return function_text(p, slots, outputs, false, true, true, "raw", real);
  };
  // The value entry also gives the smallest margin.
  std::vector<Output> margins;
  std::string smallest = fmt::format("  require[0] = {} - V{{}};\n", literal(HUGE_VAL, type.single));
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
  // In single precision what is kept per element is still computed in double: positions at rest lose little then.
  std::vector<Output> kept = outputs_to("e", slots.elements);
  if (type.single)
    for (size_t i = 0; i < kept.size(); ++i) kept[i].target = fmt::format("e[{}]", static_cast<int>(i) * type.lanes);
  FunctionText elements = function_text(p, slots, kept, type.single, true, false, "raw");
  FunctionText conditions = text(join(outputs_to("active", s.active), outputs_to("require", s.require)));
  FunctionText update_text = text(outputs_to("renewed", s.update));
  FunctionText principal_text = text(outputs_to("blocks", s.principal));
  FunctionText projected_text;
  if (s.changed >= 0)
    projected_text = text(join(join(outputs_to("gradient", s.gradient), outputs_to("projected", s.projected)),
                               {{"value[0]", s.value}, {"changed[0]", s.changed}}));
  FunctionText near = two_forms ? text({{"const V near", s.near}}) : FunctionText{};

  std::set<std::string> used;
  if (!s.require.empty()) used.insert("v_min");
  if (two_forms) used.insert("lanes_above");
  std::vector<const FunctionText*> all = {&uniforms,    &elements,       &conditions,    &near,
                                          &update_text, &principal_text, &projected_text};
  for (const FunctionText& t : texts) all.push_back(&t);
  for (const FunctionText* f : all)
    count_calls(p, f->instructions, f == &uniforms || (type.single && f == &elements), used);

  Emitted out;
  counts[0].principal = static_cast<int>(principal_text.instructions.size());
  counts[0].projected = static_cast<int>(projected_text.instructions.size());
  out.counts = counts[0];
  out.costs = cost_of_entries(s);
  out.source = header(m, out.counts, out.costs) + prelude(type, used) + kKernelAbiText + "\n";
  out.source +=
      fmt::format("static void prepare_uniforms(const double* params, {}* u) {{\n  (void)params, (void)u;\n{}}}\n\n",
                  real, uniforms.body);
  if (type.single) {
    out.source += fmt::format(
        "struct OneLane {{\n  const double* first;\n  double operator[](int i) const {{ return first[i*{0}]; }}\n}};\n"
        "static void prepare_elements(const double* raw_, const float* u, float* e_) {{\n"
        "  for (int lane = 0; lane < {0}; ++lane) {{\n  const OneLane raw = {{raw_ + lane}};\n"
        "  float* e = e_ + lane;\n  (void)raw, (void)u, (void)e;\n{1}  }}\n}}\n\n",
        type.lanes, elements.body);
  } else {
    out.source += fmt::format(
        "static void prepare_elements(const double* raw_, const double* u, double* e_) {{\n"
        "  const V* raw = (const V*)raw_;\n  V* e = (V*)e_;\n  (void)raw, (void)u, (void)e;\n{}}}\n\n",
        elements.body);
  }
  out.source += entry("conditions", real, {"active", "require"}, "  (void)active, (void)require;\n" + conditions.body);
  const std::vector<Evaluation> all_evaluations = evaluations();
  for (size_t i = 0; i < 3; ++i) {
    const Evaluation& e = all_evaluations[i];
    out.source += entry(e.name + (two_forms ? "_near" : "_entry"), real, e.outputs, texts[i].body);
    if (!two_forms) continue;
    out.source += entry(e.name + "_far", real, e.outputs, texts[3 + i].body);
    out.source += entry(e.name + "_entry", real, e.outputs,
                        dispatch(e, near, m.q_size(), static_cast<int>(m.hessian.size()), type.single));
  }
  if (!m.update.empty()) out.source += entry("update_entry", real, {"renewed"}, update_text.body);
  if (!m.principal.empty())
    out.source += fmt::format(
        "static void principal_entry(const {0}* s_, const {0}* e_, const {0}* u, {0}* blocks_) {{\n"
        "  const V* s = (const V*)s_;\n  const V* e = (const V*)e_;\n  V* blocks = (V*)blocks_;\n"
        "  (void)s, (void)e, (void)u;\n{1}}}\n\n",
        real, principal_text.body);
  if (s.changed >= 0)
    out.source +=
        entry("projected_entry", real, {"value", "gradient", "projected", "changed"},
              "  const V negative = negative_ - V{};\n" + projected_text.body, fmt::format(", {} negative_", real));
  out.source += kernel_table(m, counts[0], type);
  return out;
}

}  // namespace ergon
