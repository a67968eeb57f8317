#include "tools/kernel_findings.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "codegen/compile.h"
#include "codegen/interpret.h"
#include "symbolic/isotropy.h"
#include "symbolic/reference.h"
#include "tools/accuracy_states.h"
#include "tools/installation.h"

namespace ergon {
namespace {

constexpr double unit = 0x1p-53;
// Of the result; what a careless author loses near rest is told by `ergon accuracy`, this finds what is wrong.
constexpr double largest_error = 1e-6;

std::string structure_of(const Module& module, bool isotropic) {
  if (module.zero_hessian) return "the Hessian is zero";
  std::string text = module.constant_hessian ? "the Hessian is constant: evaluated and assembled once" : "";
  auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (isotropic) add("isotropic");
  if (module.psd_hessian) add("convex: the Hessian is never projected");
  if (!module.psd_hessian && module.changed >= 0) add("a function of one scalar: projected in closed form");
  if (!module.psd_hessian && !module.principal.empty()) add("projected in closed form over the singular values of F");
  return text.empty() ? "the Hessian depends on the state and is projected where a test finds it needed" : text;
}

// Largest difference, relative to the largest entry of the second; absolute where that is 0.
double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (!a.allFinite()) return std::numeric_limits<double>::infinity();
  const double size = b.size() > 0 ? b.cwiseAbs().maxCoeff() : 0;
  const double most = a.size() > 0 ? (a - b).cwiseAbs().maxCoeff() : 0;
  return size > 0 ? most / size : most;
}

// The module's value, gradient and Hessian at one state in doubles against 50 digits.
class GraphAtState {
 public:
  GraphAtState(const Module& module, const AccuracyState& state) : m_(module) {
    const Energy& energy = *m_.energy;
    const std::vector<double> at = kernel_points(state, m_.displacement);
    points_ = Eigen::Map<const Eigen::VectorXd>(at.data(), static_cast<Eigen::Index>(at.size()));
    GraphInputs inputs;
    inputs.params.resize(static_cast<size_t>(m_.params));
    inputs.raw.resize(static_cast<size_t>(m_.raw));
    for (size_t i = 0; i < energy.symbols.size(); ++i) {
      const Symbol& symbol = energy.symbols[i];
      if (symbol.role == Role::dof) continue;
      const std::vector<double>& values = state.inputs.at(symbol.name);
      auto& to = symbol.role == Role::param ? inputs.params : inputs.raw;
      std::copy(values.begin(), values.end(), to.begin() + m_.offsets[i]);
    }
    const ReferenceValue reference =
        evaluate_reference_at(energy, m_.case_name, exact_inputs(energy, state, m_.displacement, {}));
    const auto n = static_cast<Eigen::Index>(reference.gradient.size());
    Eigen::VectorXd exact_gradient = Eigen::Map<const Eigen::VectorXd>(reference.gradient.data(), n);
    Eigen::MatrixXd exact_hessian = Eigen::Map<const Eigen::MatrixXd>(reference.hessian.data(), n, n);

    const Eigen::Index q = m_.q_size();
    Eigen::MatrixXd chain = Eigen::MatrixXd::Identity(n, n);  // how q changes with the dofs
    Eigen::VectorXd qs;
    if (m_.points > 0) {
      chain = Eigen::MatrixXd::Zero(q, n);
      for (Eigen::Index r = 0; r < q; ++r)
        for (Eigen::Index i = r % 3; i < n; i += 3)
          chain(r, i) = m_.weights[static_cast<size_t>(r / 3 * m_.points + i / 3)];
      qs = chain * points_;
    } else {
      qs = deformation();
      if (q != n) in_principal_axes(qs, exact_gradient, exact_hessian);
      if (q != n) chain = Eigen::MatrixXd::Identity(q, q);
    }
    inputs.q.assign(qs.data(), qs.data() + q);

    const bool near = m_.near < 0 || interpret(m_.graph, {m_.near}, inputs)[0] > 0;
    std::vector<NodeId> wanted = {near ? m_.value : m_.far.value};
    const auto& gradient = near ? m_.gradient : m_.far.gradient;
    const auto& hessian = near ? m_.hessian : m_.far.hessian;
    wanted.insert(wanted.end(), gradient.begin(), gradient.end());
    wanted.insert(wanted.end(), hessian.begin(), hessian.end());
    const std::vector<double> found = interpret(m_.graph, wanted, inputs);
    const Eigen::VectorXd by_q = Eigen::Map<const Eigen::VectorXd>(found.data() + 1, q);
    Eigen::MatrixXd by_qq(q, q);
    for (Eigen::Index r = 0, k = 1 + q; r < q; ++r)
      for (Eigen::Index s = 0; s <= r; ++s, ++k) by_qq(r, s) = by_qq(s, r) = found[static_cast<size_t>(k)];
    error[0] = difference(Eigen::VectorXd::Constant(1, found[0]), Eigen::VectorXd::Constant(1, reference.value));
    error[1] = difference(chain.transpose() * by_q, exact_gradient);
    error[2] = difference(chain.transpose() * by_qq * chain, exact_hessian);
  }

  double error[3];

 private:
  // F, or F - I, on the simplex of the coordinate axes, column by column.
  Eigen::VectorXd deformation() const {
    Eigen::VectorXd F(points_.size() - 3);
    for (Eigen::Index i = 0; i < F.size(); ++i) F[i] = points_[i + 3] - points_[i % 3];
    return F;
  }

  // The singular values of F (less 1) in place of its components, and the derivatives by them: a change of F along
  // u v' changes the singular value of the vectors u and v alone, by as much.
  void in_principal_axes(Eigen::VectorXd& F, Eigen::VectorXd& gradient, Eigen::MatrixXd& hessian) const {
    const Eigen::Index columns = F.size() / 3;
    Eigen::MatrixXd whole = Eigen::Map<const Eigen::MatrixXd>(F.data(), 3, columns);
    if (m_.displacement) whole += Eigen::MatrixXd::Identity(3, columns);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(whole, Eigen::ComputeThinU | Eigen::ComputeThinV);
    Eigen::MatrixXd along(F.size(), columns);
    for (Eigen::Index i = 0; i < columns; ++i) {
      const Eigen::MatrixXd direction = svd.matrixU().col(i) * svd.matrixV().col(i).transpose();
      along.col(i) = Eigen::Map<const Eigen::VectorXd>(direction.data(), direction.size());
    }
    F = svd.singularValues().array() - (m_.displacement ? 1 : 0);
    gradient = (along.transpose() * gradient).eval();
    hessian = (along.transpose() * hessian * along).eval();
  }

  const Module& m_;
  Eigen::VectorXd points_;
};

std::optional<Finding> accuracy_of(const Module& module) {
  constexpr double strain = 0.25;
  std::mt19937_64 random(1);
  double worst[3] = {0, 0, 0};
  int states = 0;
  for (int i = 0; i < 4; ++i) {
    const auto state = accuracy_state(*module.energy, module.case_name, strain, random);
    if (!state) continue;
    ++states;
    const GraphAtState at(module, *state);
    for (size_t k = 0; k < 3; ++k) worst[k] = std::max(worst[k], at.error[k]);
  }
  if (states == 0) return std::nullopt;
  const double most = *std::max_element(worst, worst + 3);
  return Finding{most < largest_error ? Severity::ok : Severity::error,
                 "accuracy",
                 fmt::format("against 50 digits at strains of 0.25, in units of 2^-53: value {:.2g}, gradient {:.2g}, "
                             "Hessian {:.2g}",
                             worst[0] / unit, worst[1] / unit, worst[2] / unit),
                 {},
                 ""};
}

}  // namespace

std::string structure_text(const Energy& energy, const std::string& case_name) {
  return structure_of(generate(energy, compile_options(case_name, 1)).module,
                      energy.kind == Energy::Kind::density && is_isotropic(energy, case_name));
}

std::vector<Finding> kernel_findings(const Energy& energy) {
  std::vector<Finding> findings;
  for (const std::string& name : cases_of(energy)) {
    const Generated kernel = generate(energy, compile_options(name, 1));
    const OperationCounts& n = kernel.counts;
    const std::string prefix = name.empty() ? "" : "case " + name + ": ";
    auto add = [&](Finding finding) {
      finding.message = prefix + finding.message;
      findings.push_back(std::move(finding));
    };
    const bool density = energy.kind == Energy::Kind::density;
    add({Severity::ok, "structure", structure_of(kernel.module, density && is_isotropic(energy, name)), {}, ""});
    add({Severity::ok,
         "cost",
         fmt::format(
             "operations per {}: value {}, with gradient {}, with Hessian {}; of these {} divisions, {} roots, {} "
             "other functions",
             density ? "point of quadrature" : "stencil", n.value, n.gradient, n.hessian, n.divisions, n.roots,
             n.calls),
         {},
         ""});
    if (auto accuracy = accuracy_of(kernel.module)) add(std::move(*accuracy));
  }
  return findings;
}

}  // namespace ergon
