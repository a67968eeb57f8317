#include "codegen/front_key.h"

#include <sstream>

#include <fmt/format.h>

#include "codegen/hash.h"

namespace ergon {
namespace {

// All that an energy is, in an order of its own. Texts go with their lengths, so that no two energies give the same
// bytes. The structured bindings name every member: a new one does not compile until it is written here.
class Bytes {
 public:
  void add(std::string_view text) { all_ += fmt::format("{}:{},", text.size(), text); }
  void add(double value) { all_ += fmt::format("{},", value); }
  void add(size_t value) { all_ += fmt::format("{},", value); }
  void add(int value) { all_ += fmt::format("{},", value); }

  void add(const Shape& shape) {
    const auto& [rows, cols] = shape;
    add(rows), add(cols);
  }
  void add(const ExpressionPtr& expression) {
    if (!expression) return add(std::string_view("none"));
    const auto& [kind, text, arguments, place, shape, unit] = *expression;
    add(static_cast<int>(kind)), add(text), add(shape), add(to_string(unit)), add(arguments.size());
    for (const ExpressionPtr& argument : arguments) add(argument);
  }
  void add(const Condition& condition) {
    const auto& [left, right, place] = condition;
    add(left), add(right);
  }
  void add(const Let& let) {
    const auto& [name, case_name, expression, place] = let;
    add(name), add(case_name), add(expression);
  }
  void add(const Symbol& symbol) {
    const auto& [name, role, shape, unit, range, help, place] = symbol;
    const auto& [lower, upper, lower_open, upper_open] = range;
    add(name), add(static_cast<int>(role)), add(shape), add(to_string(unit)), add(help);
    add(lower), add(upper), add(int{lower_open}), add(int{upper_open});
  }
  template <class T>
  void add(const std::vector<T>& list) {
    add(list.size());
    for (const T& item : list) add(item);
  }
  void add(const Energy& energy) {
    const auto& [kind, name, geometry, summary, cite, symbols, lets, cases, active, require, updates, value, natural,
                 part_of, constraint, load, fixed_frame, text, file] = energy;
    add(static_cast<int>(kind)), add(name), add(geometry), add(summary), add(cite), add(symbols), add(lets);
    add(cases), add(active), add(require), add(updates), add(value), add(natural), add(part_of), add(int{fixed_frame}),
        add(text);
  }
  void add(const FrontOptions& options) {
    const auto& [case_name, type, stable, compiler] = options;
    add(case_name), add(type.lanes), add(int{type.single}), add(int{stable}), add(compiler);
  }
  const std::string& all() const { return all_; }

 private:
  std::string all_;
};

}  // namespace

std::string front_key(const Energy& energy, const FrontOptions& options, std::string_view program) {
  Bytes bytes;
  bytes.add(program);
  bytes.add(options);
  bytes.add(energy);
  return key_stem(energy, options.type) + content_hash(bytes.all());
}

std::string key_stem(const Energy& energy, VectorType type) {
  return fmt::format("{}-{}{}-", energy.name, type.single ? 'f' : 'w', type.lanes);
}

std::string to_text(const KernelNote& note, const std::string& front) {
  const auto& [value, gradient, hessian, projected, divisions, roots, calls, principal, uniforms, elements] =
      note.counts;
  return fmt::format("{} {} {}\n{} {} {} {} {} {} {} {} {} {}\n", front, note.key, note.source_bytes, value, gradient,
                     hessian, projected, divisions, roots, calls, principal, uniforms, elements);
}

std::optional<KernelNote> note_from(const std::string& text, const std::string& front) {
  std::istringstream in(text);
  std::string of;
  KernelNote note;
  OperationCounts& c = note.counts;
  in >> of >> note.key >> note.source_bytes >> c.value >> c.gradient >> c.hessian >> c.projected >> c.divisions >>
      c.roots >> c.calls >> c.principal >> c.uniforms >> c.elements;
  if (!in || of != front) return std::nullopt;
  return note;
}

}  // namespace ergon
