// A param as a field: a bar whose Young's modulus is another in every cell, given from memory, pulled at its end. As it
// has Poisson's ratio 0 its cells are springs in a row, so that its elongation is a sum.

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "codegen/compile.h"
#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/sites.h"
#include "runtime/solver/newton.h"
#include "runtime/system.h"
#include "symbolic/energy_builder.h"
#include "symbolic/varied.h"

namespace {

using namespace ergon;

Energy soft_solid() {
  EnergyBuilder law("density", "soft_solid", "solid");
  const Expr E = law.param("E", "Pa", "(0, inf)", "Young's modulus");
  law.value(E / 2 * norm2(sym(law.F()) - identity(3)));
  return law.build();
}

Energy pull() {
  EnergyBuilder law("energy", "pull", "point");
  law.fixed_frame();
  const Expr x = law.dof("x", "m"), force = law.param("force", "N");
  law.value(-force * x[0]);
  return law.build();
}

Kernel kernel_of(const Energy& energy) {
  CompileOptions options;
  options.lanes = lanes::best_lanes();
  const CompiledKernel compiled = compile(energy, options);
  return {compiled.library, compiled.table};
}

// By how much the bar with these values of E, per cell or point of quadrature, becomes longer.
double elongation(const Mesh& mesh, const std::vector<double>& E, double force) {
  System system(mesh.vertices());
  // The same law with E as data of the cells: nothing else differs from one value for all.
  const Energy graded = varied(soft_solid(), {"E"});
  system.add(Potential::on_mesh("bar", kernel_of(graded), mesh, 0, {}, std::nullopt, {{"E", E}}));
  const double end = mesh.X.row(0).maxCoeff();
  std::vector<int> pulled;
  std::vector<char> fixed(static_cast<size_t>(mesh.vertices()), 0);
  for (int v = 0; v < mesh.vertices(); ++v) {
    if (mesh.X(0, v) > end - 1e-9) pulled.push_back(v);
    fixed[static_cast<size_t>(v)] = mesh.X(0, v) < 1e-9 ? 1 : 0;
  }
  const double each = force / static_cast<double>(pulled.size());
  system.add(Potential::on_stencils("pull", kernel_of(pull()), pulled, mesh.X, {{"force", {each}}}, {}));
  system.set_fixed(fixed);
  Eigen::Matrix3Xd x = mesh.X;
  NewtonOptions options;
  options.tolerance = 1e-12;  // m
  Newton().minimise(system, x, options, nullptr);
  return x.row(0).maxCoeff() - end;
}

}  // namespace

int main() {
  constexpr int cells = 20;
  constexpr double length = 1, width = 0.1, force = 10;
  const Mesh mesh = box_mesh(Element::hex8, {length, width, width}, {cells, 1, 1});

  // Per cell: ten times as stiff at the far end as at the held one.
  std::vector<double> E;
  double exact = 0;
  for (int i = 0; i < mesh.cell_count(); ++i) {
    double middle = 0;
    for (int a = 0; a < 8; ++a) middle += mesh.X(0, mesh.cells[static_cast<size_t>(8 * i + a)]) / 8;
    E.push_back(1e5 * std::pow(10, middle / length));
    exact += force / (width * width) * (length / cells) / E.back();
  }
  const double by_cells = elongation(mesh, E, force);
  fmt::print("data of cells:    {:.9g} m, a row of springs gives {:.9g} m\n", by_cells, exact);

  // Per vertex, interpolated to the points of quadrature: of second order in the length of a cell.
  std::vector<double> at_vertices;
  for (int v = 0; v < mesh.vertices(); ++v) at_vertices.push_back(1e5 * std::pow(10, mesh.X(0, v) / length));
  const double smooth = force / (width * width) * length * (1 - 0.1) / (1e5 * std::log(10));
  const double by_vertices = elongation(mesh, sites_of_cells(mesh).of_vertices(at_vertices, 1), force);
  fmt::print("data of vertices: {:.6g} m, the smooth field gives {:.6g} m\n", by_vertices, smooth);
  return std::fabs(by_cells / exact - 1) < 1e-9 && std::fabs(by_vertices / smooth - 1) < 3e-3 ? EXIT_SUCCESS
                                                                                              : EXIT_FAILURE;
}
