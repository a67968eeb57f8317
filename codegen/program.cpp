#include "codegen/program.h"

#include <algorithm>
#include <utility>

namespace ergon {

int Program::append(Instruction i) {
  for (int operand : {i.a, i.b, i.c})
    if (operand >= 0) i.lifetime = std::max(i.lifetime, (*this)[operand].lifetime);
  auto key = std::tuple(static_cast<int>(i.op), static_cast<int>(i.call), i.a, i.b, i.c, i.constant,
                        static_cast<int>(i.source), i.index);
  auto [it, is_new] = numbers_.try_emplace(key, size());
  if (is_new) code_.push_back(std::move(i));
  return it->second;
}

int Program::constant(double value) {
  Instruction i;
  i.constant = value;
  return append(std::move(i));
}

int Program::input(Source source, int index) {
  Instruction i;
  i.op = Opcode::input;
  i.source = source;
  i.index = index;
  i.lifetime = source == Source::param ? Lifetime::uniform
               : source == Source::raw ? Lifetime::element
                                       : Lifetime::state;
  return append(std::move(i));
}

namespace {

Instruction binary(Opcode op, int a, int b) {
  Instruction i;
  i.op = op;
  i.a = a;
  i.b = b;
  return i;
}

}  // namespace

int Program::add(int a, int b) {
  if (is_constant(a, 0)) return b;
  if (is_constant(b, 0)) return a;
  return append(binary(Opcode::add, std::min(a, b), std::max(a, b)));
}

int Program::subtract(int a, int b) {
  if (is_constant(b, 0)) return a;
  if (is_constant(a, 0)) return negate(b);
  return append(binary(Opcode::subtract, a, b));
}

int Program::multiply(int a, int b) {
  if (is_constant(a, 1)) return b;
  if (is_constant(b, 1)) return a;
  if (is_constant(a, -1)) return negate(b);
  if (is_constant(b, -1)) return negate(a);
  return append(binary(Opcode::multiply, std::min(a, b), std::max(a, b)));
}

int Program::divide(int a, int b) { return append(binary(Opcode::divide, a, b)); }

int Program::negate(int a) {
  if ((*this)[a].op == Opcode::constant) return constant(-(*this)[a].constant);
  if ((*this)[a].op == Opcode::negate) return (*this)[a].a;
  return append(binary(Opcode::negate, a, -1));
}

int Program::sqrt(int a) { return append(binary(Opcode::sqrt, a, -1)); }

int Program::call(Call call, int a, int b, int c) {
  Instruction i;
  i.op = Opcode::call;
  i.call = call;
  i.a = a;
  i.b = b;
  i.c = c;
  return append(std::move(i));
}

bool is_operation(const Instruction& i) { return i.op != Opcode::constant && i.op != Opcode::input; }

}  // namespace ergon
