#include "tools/problem.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "runtime/aligned.h"
#include "runtime/error.h"
#include "tools/assignments.h"
#include "tools/sample.h"

namespace ergon {
namespace {

// The point whose rest position this is, or -1.
int point_at_rest(const Energy& energy, const Symbol& rest) {
  std::string dof = rest.name;
  dof[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(dof[0])));
  const std::vector<const Symbol*> dofs = energy.with_role(Role::dof);
  for (size_t i = 0; i < dofs.size(); ++i) {
    if (rest.role == Role::rest && dofs[i]->name == dof && dof != rest.name && dofs[i]->shape == rest.shape) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

void check_given(const Energy& energy, const Values& values) {
  for (const Symbol* symbol : needed_inputs(energy)) {
    if (values.contains(symbol->name)) continue;
    throw InputError(fmt::format("{} needs '{}': {}, in {}; give it with --set {}=VALUE", energy.name, symbol->name,
                                 symbol->help.empty() ? "a " + to_string(symbol->shape) : symbol->help,
                                 range_in_unit(*symbol), symbol->name));
  }
}

Values with_role(const Energy& energy, Role role, const Values& values, size_t copies) {
  Values chosen;
  for (const Symbol* symbol : energy.with_role(role)) {
    auto given = values.find(symbol->name);
    if (given == values.end()) continue;
    std::vector<double>& at = chosen[symbol->name];
    for (size_t i = 0; i < copies; ++i) at.insert(at.end(), given->second.begin(), given->second.end());
  }
  return chosen;
}

}  // namespace

std::vector<const Symbol*> needed_inputs(const Energy& energy) {
  std::vector<const Symbol*> needed;
  for (const Symbol& symbol : energy.symbols) {
    if (symbol.role != Role::dof && point_at_rest(energy, symbol) < 0) needed.push_back(&symbol);
  }
  return needed;
}

std::vector<int> active_stencils(const Energy& energy, const Kernel& kernel, const Mesh& mesh,
                                 const std::vector<int>& all, const Values& values, const Eigen::Matrix3Xd& x) {
  check_given(energy, values);
  if (kernel->actives == 0) return all;
  // One stencil at a time, the same in every lane.
  const auto lanes = static_cast<size_t>(kernel->lanes), points = static_cast<size_t>(kernel->points);
  auto lanes_of = [&](int rows) { return AlignedVector<double>(static_cast<size_t>(std::max(rows, 1)) * lanes); };
  auto fill = [&](AlignedVector<double>& at, size_t row, double value) {
    std::fill_n(at.begin() + static_cast<std::ptrdiff_t>(row * lanes), lanes, value);
  };
  std::vector<double> params(static_cast<size_t>(kernel->params) + 1);
  std::vector<double> uniforms(static_cast<size_t>(kernel->uniforms) + 1);
  auto raw = lanes_of(kernel->raw), elements = lanes_of(kernel->elements), q = lanes_of(3 * kernel->q_vectors);
  auto active = lanes_of(kernel->actives), require = lanes_of(kernel->requires_);

  for (int i = 0; i < kernel->n_inputs; ++i) {
    const ErgonInput& input = kernel->inputs[i];
    auto given = values.find(input.name);
    if (given == values.end()) continue;
    for (size_t c = 0; c < given->second.size(); ++c) {
      const size_t row = static_cast<size_t>(input.offset) + c;
      if (input.role == ERGON_PARAM) {
        params[row] = given->second[c];
      } else {
        fill(raw, row, given->second[c]);
      }
    }
  }
  kernel->prepare_uniforms(params.data(), uniforms.data());

  std::vector<int> kept;
  for (size_t start = 0; start < all.size(); start += points) {
    for (int i = 0; i < kernel->n_inputs; ++i) {
      const ErgonInput& input = kernel->inputs[i];
      if (input.role != ERGON_REST || values.contains(input.name)) continue;
      const auto point = static_cast<size_t>(point_at_rest(energy, *energy.find(input.name)));
      for (int c = 0; c < 3; ++c) fill(raw, static_cast<size_t>(input.offset + c), mesh.X(c, all[start + point]));
    }
    for (int v = 0; v < kernel->q_vectors; ++v) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (size_t a = 0; a < points; ++a)
        sum += kernel->weights[static_cast<size_t>(v) * points + a] * x.col(all[start + a]);
      for (int c = 0; c < 3; ++c) fill(q, static_cast<size_t>(3 * v + c), sum[c]);
    }
    kernel->prepare_elements(raw.data(), uniforms.data(), elements.data());
    kernel->conditions(q.data(), elements.data(), uniforms.data(), active.data(), require.data());
    bool holds = true;
    for (int i = 0; i < kernel->actives; ++i) holds = holds && active[static_cast<size_t>(i) * lanes] > 0;
    if (holds)
      kept.insert(kept.end(), all.begin() + static_cast<std::ptrdiff_t>(start),
                  all.begin() + static_cast<std::ptrdiff_t>(start + points));
  }
  return kept;
}

System make_system(const Energy& energy, const Kernel& kernel, const Mesh& mesh, const std::vector<int>& stencils,
                   const Values& values, std::optional<int> exactness) {
  check_given(energy, values);
  const Values params = with_role(energy, Role::param, values, 1);
  const bool density = energy.kind == Energy::Kind::density;
  if (density) check_element(energy, mesh.element);
  if (density && !energy.with_role(Role::rest).empty()) {
    throw InputError(fmt::format("{} has rest data, which a mesh alone does not tell", energy.name));
  }
  const size_t count = density ? 0 : stencils.size() / energy.with_role(Role::dof).size();
  Potential potential = density ? Potential::on_mesh(energy.name, kernel, mesh, 0, params, exactness)
                                : Potential::on_stencils(energy.name, kernel, stencils, mesh.X, params,
                                                         with_role(energy, Role::rest, values, count));
  for (const auto& [name, value] : with_role(energy, Role::lag, values, 1)) potential.set_lag(name, value);
  System system(mesh.vertices());
  system.add(std::move(potential));
  return system;
}

}  // namespace ergon
