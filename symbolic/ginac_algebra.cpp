#include "symbolic/ginac_algebra.h"

#include <stdexcept>

#include "symbolic/elaborate.h"

namespace ergon {

using GiNaC::ex;

ex GinacAlgebra::call(Function f, const std::vector<ex>& arguments) const {
  const ex& x = arguments[0];
  switch (f) {
    case Function::sqrt:
      return GiNaC::sqrt(x);
    case Function::log:
      return GiNaC::log(x);
    case Function::exp:
      return GiNaC::exp(x);
    case Function::log1p:
      return GiNaC::log(1 + x);
    case Function::expm1:
      return GiNaC::exp(x) - 1;
    case Function::sin:
      return GiNaC::sin(x);
    case Function::cos:
      return GiNaC::cos(x);
    case Function::tan:
      return GiNaC::tan(x);
    case Function::asin:
      return GiNaC::asin(x);
    case Function::acos:
      return GiNaC::acos(x);
    case Function::atan:
      return GiNaC::atan(x);
    case Function::atan2:
      return GiNaC::atan2(x, arguments[1]);
    case Function::abs:
      return GiNaC::abs(x);
    case Function::min:
      return (x + arguments[1] - GiNaC::abs(x - arguments[1])) / 2;
    case Function::max:
      return (x + arguments[1] + GiNaC::abs(x - arguments[1])) / 2;
  }
  throw std::logic_error("a function without a GiNaC form");
}

Decomposed<ex> GinacAlgebra::decompose_apart(const std::vector<ex>& F) const {
  const size_t columns = F.size() / 3;
  Decomposed<ex> out;
  for (size_t i = 0; i < 3; ++i) {
    out.u.push_back({ex(i == 0 ? 1 : 0), ex(i == 1 ? 1 : 0), ex(i == 2 ? 1 : 0)});
    if (i < columns) out.s.push_back(F[4 * i]);
  }
  for (size_t k = 0; k < F.size(); ++k)
    if (!GiNaC::is_a<GiNaC::numeric>(F[k]) || (k % 4 != 0 && !F[k].is_zero()))
      throw std::domain_error("the singular values of this matrix have no exact form");
  out.v.assign(out.u.begin(), out.u.begin() + static_cast<long>(columns));
  return out;
}

ex GinacAlgebra::input(const Symbol& symbol, int component) {
  const auto found = values_.find(symbol.name);
  if (found != values_.end()) return GiNaC::numeric(exact_input(values_, symbol, component));
  std::vector<ex>& components = symbols_[symbol.name];
  if (components.empty()) {
    const bool positive = symbol.range.lower > 0 || (symbol.range.lower == 0 && symbol.range.lower_open);
    for (int i = 0; i < symbol.shape.size(); ++i) {
      const std::string name = symbol.shape.scalar() ? symbol.name : symbol.name + "_" + std::to_string(i);
      components.push_back(positive ? ex(GiNaC::possymbol(name)) : ex(GiNaC::realsymbol(name)));
    }
  }
  return components[static_cast<size_t>(component)];
}

void GinacAlgebra::named(const std::string& let, int component, int size, const ex& value) {
  std::vector<ex>& components = lets_[let];
  components.resize(static_cast<size_t>(size));
  components[static_cast<size_t>(component)] = value;
}

bool GinacAlgebra::less(const ex& a, const ex& b) const {
  const ex difference = (a - b).evalf();
  if (!GiNaC::is_a<GiNaC::numeric>(difference) || !GiNaC::ex_to<GiNaC::numeric>(difference).is_real())
    throw std::domain_error("a comparison depends on symbols");
  return GiNaC::ex_to<GiNaC::numeric>(difference).is_negative();
}

SymbolicEnergy to_ginac(const Energy& energy, const std::string& case_name) {
  GinacAlgebra algebra;
  Elaborated<ex> result = elaborate(energy, case_name, algebra);
  return {result.value, result.active, result.require, algebra.symbols(), algebra.lets()};
}

}  // namespace ergon
