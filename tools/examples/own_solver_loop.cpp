// A solver of one's own over potentials: a rubber bar, held at one end, sags under its weight. Newton's method with
// halved steps, written out; what the library brings is value, gradient, Hessian and the sparse factorisation.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "codegen/compile.h"
#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/solver/linear_solver.h"
#include "runtime/system.h"
#include "symbolic/energy.h"

namespace {

using namespace ergon;

Kernel kernel_of(const std::string& text) {
  CompileOptions options;
  options.lanes = lanes::best_lanes();
  const CompiledKernel compiled = compile(parse_energy(text, "own_solver_loop"), options);
  return {compiled.library, compiled.table};
}

const char* const rubber =
    "density  rubber  solid\nparam    mu  Pa  (0, inf)\nparam    la  Pa  (0, inf)\nlet      J = det(F)\n"
    "value    mu/2*(norm2(F) - 3) - mu*(J - 1) + (la + mu)/2*(J - 1)^2\n";
const char* const weight =
    "energy   weight  point\nframe    fixed\ndof      x     m\nrest     mass  kg  (0, inf)\n"
    "param    g     m/s^2  (0, inf)\nvalue    mass*g*x[2]\n";

}  // namespace

int main() {
  const Mesh mesh = box_mesh(Element::hex8, {0.4, 0.05, 0.05}, {16, 2, 2});
  const int n = mesh.vertices();
  System system(n);
  system.add(Potential::on_mesh("rubber", kernel_of(rubber), mesh, 0, {{"mu", {3e5}}, {"la", {2e6}}}));
  std::vector<int> points(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) points[static_cast<size_t>(i)] = i;
  const std::vector<double> mass(static_cast<size_t>(n), 1100 * 0.4 * 0.05 * 0.05 / n);
  system.add(Potential::on_stencils("weight", kernel_of(weight), points, mesh.X, {{"g", {9.81}}}, {{"mass", mass}}));
  std::vector<char> fixed(static_cast<size_t>(n), 0);
  for (int i = 0; i < n; ++i) fixed[static_cast<size_t>(i)] = mesh.X(0, i) < 1e-9 ? 1 : 0;
  system.set_fixed(fixed);

  Eigen::Matrix3Xd x = mesh.X, gradient;
  BlockMatrix hessian;
  LinearSolver solver;
  bool converged = false;
  int iteration = 0;
  for (; iteration < 50 && !converged; ++iteration) {
    // The Hessian as it is converges quadratically; where it is not positive definite, projected it still descends.
    Evaluation state = system.hessian(x, Projection::none, gradient, hessian);
    const bool definite = !solver.factor(hessian);
    if (!definite) state = system.hessian(x, Projection::clamp, gradient, hessian);
    if (!definite && solver.factor(hessian)) break;
    Eigen::VectorXd force(hessian.rows()), step;
    for (int i = 0; i < n; ++i)
      if (system.block_of(i) >= 0) force.segment<3>(3 * system.block_of(i)) = -gradient.col(i);
    solver.solve(force, step);
    Eigen::Matrix3Xd direction = Eigen::Matrix3Xd::Zero(3, n);
    for (int i = 0; i < n; ++i)
      if (system.block_of(i) >= 0) direction.col(i) = step.segment<3>(3 * system.block_of(i));
    double part = 1;
    while (part > 1e-9 && !(system.value(x + part * direction).value <= state.value + 1e-14 * std::fabs(state.value)))
      part /= 2;
    x += part * direction;
    converged = direction.cwiseAbs().maxCoeff() < 1e-9;
    fmt::print("{:2}  energy {:.9g} J  residual {:.2e} N  step {:.2e} m x {}\n", iteration, state.value, force.norm(),
               direction.cwiseAbs().maxCoeff(), part);
  }
  fmt::print("the free end hangs {:.4g} m low after {} iterations\n", -(x - mesh.X).row(2).minCoeff(), iteration);
  return converged ? EXIT_SUCCESS : EXIT_FAILURE;
}
