#include "symbolic/isotropy.h"

#include "symbolic/elaborate.h"
#include "symbolic/sample_states.h"

namespace ergon {
namespace {

constexpr int digits = 50;
constexpr double tolerance = 1e-40;
constexpr int wanted = 3, attempts = 24;  // states

// a*b, both column by column, with `inner` columns of a.
std::vector<Rational> product(const std::vector<Rational>& a, const std::vector<Rational>& b, size_t inner) {
  const size_t rows = a.size() / inner, columns = b.size() / inner;
  std::vector<Rational> c(rows * columns, Rational(0));
  for (size_t j = 0; j < columns; ++j)
    for (size_t k = 0; k < inner; ++k)
      for (size_t i = 0; i < rows; ++i) c[j * rows + i] = c[j * rows + i] + a[k * rows + i] * b[j * inner + k];
  return c;
}

// A rotation of the material: of space for a solid, of the plane for a membrane.
std::vector<Rational> material_rotation(StateSampler& sampler, int columns) {
  if (columns == 3) return sampler.rotation();
  if (columns == 1) return {Rational(1)};
  const Rational t = sampler.fraction(9, 4), s = 1 / (1 + t * t);
  return {(1 - t * t) * s, 2 * t * s, -2 * t * s, (1 - t * t) * s};
}

ClnNumber value(const Energy& energy, const std::string& case_name, const ExactInputs& inputs) {
  ClnAlgebra algebra(inputs, digits);
  return elaborate(energy, case_name, algebra).value;
}

bool is_invariant(const Energy& energy, const std::string& case_name, bool of_material) {
  if (energy.kind != Energy::Kind::density) return false;
  const Symbol& F = *energy.with_role(Role::dof).front();
  StateSampler sampler;
  int seen = 0;
  for (int attempt = 0; attempt < attempts && seen < wanted; ++attempt) {
    const ExactInputs state = sampler.any(energy);
    ExactInputs turned = state;
    std::vector<Rational>& f = turned.at(F.name);
    f = product(sampler.rotation(), f, 3);
    if (of_material) f = product(f, material_rotation(sampler, F.shape.cols), static_cast<size_t>(F.shape.cols));
    const ClnNumber a = value(energy, case_name, state), b = value(energy, case_name, turned);
    if (!a.defined && !b.defined) continue;
    if (!a.defined || !b.defined) return false;
    if (cln::abs(a.value - b.value) > tolerance * (1 + cln::abs(a.value))) return false;
    ++seen;
  }
  return seen == wanted;
}

}  // namespace

bool is_isotropic(const Energy& energy, const std::string& case_name) { return is_invariant(energy, case_name, true); }

bool is_frame_invariant(const Energy& energy, const std::string& case_name) {
  return is_invariant(energy, case_name, false);
}

}  // namespace ergon
