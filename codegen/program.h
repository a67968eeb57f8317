#pragma once
// Straight-line code: numbered instructions of two or three operands, each computed once, with the lifetime of its
// value.

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "codegen/graph.h"

namespace ergon {

// How long a value lasts; a value's lifetime is the shortest of its operands'.
enum class Lifetime { constant, uniform, element, state };

enum class Opcode { constant, input, add, subtract, multiply, divide, negate, sqrt, call };

struct Instruction {
  Opcode op = Opcode::constant;
  Call call = Call::log;
  int a = -1, b = -1, c = -1;  // operands: instructions
  double constant = 0;
  Source source = Source::param;
  int index = 0;
  Lifetime lifetime = Lifetime::constant;
  std::string name;
};

class Program {
 public:
  // Each returns the number of the instruction, an existing one when it computes the same.
  int constant(double value);
  int input(Source source, int index);
  int add(int a, int b);
  int subtract(int a, int b);
  int multiply(int a, int b);
  int divide(int a, int b);
  int negate(int a);
  int sqrt(int a);
  int call(Call call, int a, int b = -1, int c = -1);

  const Instruction& operator[](int i) const { return code_[static_cast<size_t>(i)]; }
  int size() const { return static_cast<int>(code_.size()); }
  bool is_constant(int i, double value) const {
    return (*this)[i].op == Opcode::constant && (*this)[i].constant == value;
  }
  void set_name(int i, const std::string& name) {
    if (code_[static_cast<size_t>(i)].name.empty()) code_[static_cast<size_t>(i)].name = name;
  }

 private:
  int append(Instruction instruction);
  std::vector<Instruction> code_;
  std::map<std::tuple<int, int, int, int, int, double, int, int>, int> numbers_;
};

// Arithmetic that instruction i costs: 1 for everything but constants and inputs.
bool is_operation(const Instruction& instruction);

}  // namespace ergon
