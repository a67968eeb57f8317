// A law made in C++, compiled and evaluated: rubber in as many powers of its first invariant as are asked for. The text
// of an .energy file is the language of the library too, so a family of laws is a loop that writes text.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "codegen/compile.h"
#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/system.h"
#include "symbolic/energy.h"

namespace {

std::string power_rubber(int terms) {
  std::string params, value = "K/2*(J - 1)^2";
  for (int i = 1; i <= terms; ++i) {
    params += fmt::format("param    C{}  Pa  (0, inf)   of power {}\n", i, i);
    value += fmt::format(" + C{0}*I^{0}", i);
  }
  return "density  power_rubber  solid\n" + params +
         "param    K   Pa  (0, inf)   bulk modulus\nlet      J = det(F)\nlet      I = norm2(F)*J^(-2/3) - 3\n"
         "require  J > 0\nvalue    " +
         value + "\n";
}

}  // namespace

int main() {
  using namespace ergon;
  const Energy energy = parse_energy(power_rubber(3), "power_rubber");

  CompileOptions options;
  options.lanes = lanes::best_lanes();
  const CompiledKernel compiled = compile(energy, options);

  const Mesh mesh = box_mesh(Element::tet10, {1, 1, 1}, {2, 2, 2});
  System system(mesh.vertices());
  system.add(Potential::on_mesh(energy.name, {compiled.library, compiled.table}, mesh, 0,
                                {{"C1", {2e5}}, {"C2", {1e3}}, {"C3", {50}}, {"K", {1e7}}}));

  Eigen::Matrix3Xd x = mesh.X;
  x.row(0) *= 1.3;
  x.row(2) += 0.1 * mesh.X.row(0).cwiseAbs2();
  Eigen::Matrix3Xd gradient;
  BlockMatrix hessian;
  const Evaluation state = system.hessian(x, Projection::clamp, gradient, hessian);

  // The gradient along one direction against the values on both sides.
  const Eigen::Matrix3Xd direction = (3 * mesh.X).array().sin().matrix();
  const double step = 1e-6;
  const double slope =
      (system.value(x + step * direction).value - system.value(x - step * direction).value) / (2 * step);
  const double error = std::fabs(gradient.cwiseProduct(direction).sum() / slope - 1);
  fmt::print("energy {:.6g} J, largest force {:.6g} N, {} blocks of the Hessian, {} points projected\n", state.value,
             gradient.colwise().norm().maxCoeff(), hessian.blocks(), state.indefinite);
  fmt::print("slope along a direction {:.6g} J, relative error of the gradient {:.1g}\n", slope, error);
  return error < 1e-7 ? EXIT_SUCCESS : EXIT_FAILURE;
}
