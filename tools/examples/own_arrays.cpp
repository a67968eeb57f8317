// Potentials over arrays of one's own: a net of threads that only pull, each of its own length and stiffness, carries
// weights at its knots. The laws are written in C++; no mesh, no scene.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "codegen/compile.h"
#include "runtime/lanes/lanes.h"
#include "runtime/solver/newton.h"
#include "runtime/system.h"
#include "symbolic/energy_builder.h"

namespace {

using namespace ergon;

Energy thread() {
  EnergyBuilder law("energy", "thread", "edge");
  const Expr x0 = law.dof("x0", "m"), x1 = law.dof("x1", "m");
  const Expr k = law.rest("k", "N/m", "(0, inf)", "stiffness");
  const Expr L = law.rest("L", "m", "(0, inf)", "length");
  const Expr longer = law.let("longer", max(norm(x1 - x0) - L, 0));
  law.value(k / 2 * pow(longer, 2));
  return law.build();
}

Energy weight() {
  EnergyBuilder law("energy", "weight", "point");
  law.fixed_frame();
  const Expr x = law.dof("x", "m");
  const Expr force = law.rest("force", "N", "[0, inf)", "down");
  law.value(force * x[2]);
  return law.build();
}

Kernel kernel_of(const Energy& energy) {
  CompileOptions options;
  options.lanes = lanes::best_lanes();
  const CompiledKernel compiled = compile(energy, options);
  return {compiled.library, compiled.table};
}

}  // namespace

int main() {
  constexpr int side = 9;  // knots
  constexpr double width = 0.1;
  const auto knot = [](int i, int j) { return side * i + j; };

  // The arrays: knots, threads as pairs of knots, and what each has.
  Eigen::Matrix3Xd x(3, side * side);
  std::vector<int> knots, threads;
  std::vector<double> force, stiffness, length;
  std::vector<char> fixed;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      x.col(knot(i, j)) << width * i, width * j, -0.02 * std::min({i, j, side - 1 - i, side - 1 - j});
      knots.push_back(knot(i, j));
      force.push_back(i == side / 2 && j == side / 2 ? 20 : 0.1);  // one knot carries more
      fixed.push_back((i == 0 || i == side - 1) && (j == 0 || j == side - 1));
      for (const auto& [a, b] : {std::pair(i + 1, j), std::pair(i, j + 1)}) {
        if (a == side || b == side) continue;
        threads.insert(threads.end(), {knot(i, j), knot(a, b)});
        const bool border = (i == a && (i == 0 || i == side - 1)) || (j == b && (j == 0 || j == side - 1));
        stiffness.push_back(border ? 1e5 : 1e4);
        length.push_back(border ? width : 1.05 * width);
      }
    }
  }

  System system(side * side);
  system.add(Potential::on_stencils("threads", kernel_of(thread()), threads, x, {}, {{"k", stiffness}, {"L", length}}));
  system.add(Potential::on_stencils("weights", kernel_of(weight()), knots, x, {}, {{"force", force}}));
  system.set_fixed(fixed);

  NewtonOptions options;
  options.tolerance = 1e-9;  // m
  options.max_iterations = 2000;
  Newton newton;
  const NewtonResult result = newton.minimise(system, x, options, nullptr);

  // The corners bear all the weight there is.
  Eigen::Matrix3Xd gradient;
  system.gradient(x, gradient);
  double borne = 0, carried = 0;
  for (size_t i = 0; i < fixed.size(); ++i)
    (fixed[i] ? borne : carried) += fixed[i] ? gradient(2, static_cast<Eigen::Index>(i)) - force[i] : force[i];
  fmt::print("{} threads at rest after {} iterations, the lowest knot at {:.4g} m\n", threads.size() / 2,
             result.iterations, x.row(2).minCoeff());
  fmt::print("the corners bear {:.9g} N of {:.9g} N\n", borne, carried);
  return result.converged && std::fabs(borne - carried) < 1e-6 * carried ? EXIT_SUCCESS : EXIT_FAILURE;
}
