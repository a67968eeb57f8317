// An energy without time: a surface with one boundary is laid out flat with as little distortion as can be. The law is
// the symmetric Dirichlet energy of its triangles, the solver a static Newton solve, the start an embedding of Tutte's.
// Smith, Schaefer 2015. Bijective Parameterization with Free Boundaries. TOG 34(4). The energy, here in stretches of
// the surface. Tutte 1963. How to Draw a Graph. Proc. London Math. Soc. 13. The start. usage: surface_parametrisation
// SURFACE [OUT.obj]

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <numbers>
#include <set>

#include "codegen/compile.h"
#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_import.h"
#include "runtime/solver/linear_solver.h"
#include "runtime/system.h"
#include "symbolic/energy.h"

namespace {

using namespace ergon;

// F takes the plane of a triangle to space; what leaves the plane z = 0 is only pulled back into it.
const char* const law =
    "density  flat_symmetric_dirichlet  membrane\nframe    fixed\nparam    k  N/m  (0, inf)\n"
    "let      A = [F[0, 0], F[0, 1]; F[1, 0], F[1, 1]]\nrequire  det(A) > 0\n"
    "value    k/2*(norm2(A) + norm2(inverse(A)) - 4) + k/2*(F[2, 0]^2 + F[2, 1]^2)\n";

// The part of a closed surface that is above a fifth of its height: with one boundary, as a disc has.
Mesh open_part(const Mesh& closed) {
  const double low = closed.X.row(1).minCoeff(), high = closed.X.row(1).maxCoeff();
  Mesh open = closed;
  open.cells.clear();
  std::map<int, int> number;
  std::vector<int> kept;
  for (size_t t = 0; t < closed.cells.size(); t += 3) {
    bool above = true;
    for (size_t c = 0; c < 3; ++c) above = above && closed.X(1, closed.cells[t + c]) > low + 0.2 * (high - low);
    for (size_t c = 0; c < 3 && above; ++c) {
      const auto [found, fresh] = number.emplace(closed.cells[t + c], static_cast<int>(kept.size()));
      if (fresh) kept.push_back(closed.cells[t + c]);
      open.cells.push_back(found->second);
    }
  }
  open.X.resize(3, static_cast<Eigen::Index>(kept.size()));
  for (size_t i = 0; i < kept.size(); ++i) open.X.col(static_cast<Eigen::Index>(i)) = closed.X.col(kept[i]);
  return open;
}

// The vertices of the boundary in their order along it, the surface to the left.
std::vector<int> boundary_of(const Mesh& mesh) {
  std::set<std::pair<int, int>> halves;
  for (size_t t = 0; t < mesh.cells.size(); t += 3)
    for (size_t c = 0; c < 3; ++c) halves.emplace(mesh.cells[t + c], mesh.cells[t + (c + 1) % 3]);
  std::map<int, int> next;
  for (const auto& [a, b] : halves)
    if (!halves.contains({b, a})) next[a] = b;
  if (next.empty()) throw std::runtime_error("the surface has no boundary");
  std::vector<int> loop;
  for (int v = next.begin()->first; loop.empty() || v != loop.front(); v = next.at(v)) loop.push_back(v);
  if (loop.size() != next.size()) throw std::runtime_error("the surface has more than one boundary");
  return loop;
}

// The boundary on a circle of the surface's area, every other vertex at the mean of its neighbours.
Eigen::Matrix3Xd tutte_embedding(const Mesh& mesh, double area) {
  const int n = mesh.vertices();
  const std::vector<int> loop = boundary_of(mesh);
  std::vector<char> on_boundary(static_cast<size_t>(n), 0);
  Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(n, 2);
  for (size_t i = 0; i < loop.size(); ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(loop.size());
    on_boundary[static_cast<size_t>(loop[i])] = 1;
    right.row(loop[i]) = std::sqrt(area / std::numbers::pi) * Eigen::RowVector2d(std::cos(angle), std::sin(angle));
  }
  std::set<std::pair<int, int>> edges;
  for (size_t t = 0; t < mesh.cells.size(); t += 3)
    for (size_t c = 0; c < 3; ++c) edges.insert(std::minmax(mesh.cells[t + c], mesh.cells[t + (c + 1) % 3]));
  std::vector<Eigen::Triplet<double>> entries;
  const Eigen::MatrixX2d at_boundary = right;
  for (int i = 0; i < n; ++i)
    if (on_boundary[static_cast<size_t>(i)]) entries.emplace_back(i, i, 1);
  for (const auto& edge : edges)
    for (const auto& [a, b] : {edge, std::pair(edge.second, edge.first)}) {
      if (on_boundary[static_cast<size_t>(a)]) continue;
      entries.emplace_back(a, a, 1);
      if (on_boundary[static_cast<size_t>(b)])
        right.row(a) += at_boundary.row(b);
      else
        entries.emplace_back(a, b, -1);
    }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixX2d flat = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
  Eigen::Matrix3Xd x = Eigen::Matrix3Xd::Zero(3, n);
  x.topRows(2) = flat.transpose();
  return x;
}

double area_of(const Mesh& mesh, const Eigen::Matrix3Xd& x) {
  double area = 0;
  for (size_t t = 0; t < mesh.cells.size(); t += 3) {
    const Eigen::Vector3d a = x.col(mesh.cells[t]), b = x.col(mesh.cells[t + 1]), c = x.col(mesh.cells[t + 2]);
    area += (b - a).cross(c - a).norm() / 2;
  }
  return area;
}

void write_flat(const char* path, const Mesh& mesh, const Eigen::Matrix3Xd& x) {
  std::FILE* file = std::fopen(path, "w");
  if (file == nullptr) throw std::runtime_error(fmt::format("{}: cannot be written", path));
  for (int i = 0; i < mesh.vertices(); ++i) fmt::print(file, "v {:.9g} {:.9g} 0\n", x(0, i), x(1, i));
  for (size_t t = 0; t < mesh.cells.size(); t += 3)
    fmt::print(file, "f {} {} {}\n", mesh.cells[t] + 1, mesh.cells[t + 1] + 1, mesh.cells[t + 2] + 1);
  std::fclose(file);
}

int flatten(int argc, char** argv) {
  const Mesh mesh = open_part(read_surface(argv[1]));
  const double area = area_of(mesh, mesh.X);
  CompileOptions options;
  options.lanes = lanes::best_lanes();
  const CompiledKernel compiled = compile(parse_energy(law, "surface_parametrisation"), options);
  System system(mesh.vertices());
  system.add(Potential::on_mesh("layout", {compiled.library, compiled.table}, mesh, 0, {{"k", {1}}}));
  std::vector<char> fixed(static_cast<size_t>(mesh.vertices()), 0);
  fixed[0] = 1;
  system.set_fixed(fixed);

  Eigen::Matrix3Xd x = tutte_embedding(mesh, area), gradient;
  BlockMatrix hessian;
  LinearSolver solver;
  bool converged = false;
  int iteration = 0;
  double first = 0, last = 0;
  for (; iteration < 300 && !converged; ++iteration) {
    const Evaluation state = system.hessian(x, Projection::clamp, gradient, hessian);
    if (iteration == 0) first = state.value;
    last = state.value;
    Eigen::VectorXd force(hessian.rows()), step;
    for (int i = 0; i < mesh.vertices(); ++i)
      if (system.block_of(i) >= 0) force.segment<3>(3 * system.block_of(i)) = -gradient.col(i);
    // The layout may turn about the fixed vertex: a little of the identity keeps the matrix definite.
    if (solver.factor(hessian, 1e-9)) throw std::runtime_error("the Hessian has no factor");
    solver.solve(force, step);
    Eigen::Matrix3Xd direction = Eigen::Matrix3Xd::Zero(3, mesh.vertices());
    for (int i = 0; i < mesh.vertices(); ++i)
      if (system.block_of(i) >= 0) direction.col(i) = step.segment<3>(3 * system.block_of(i));
    const double slope = -force.dot(step);
    double part = 1;
    for (; part > 1e-12; part /= 2) {
      const Evaluation trial = system.value(x + part * direction);
      if (trial.require > 0 && trial.value <= state.value + 1e-4 * part * slope) break;
    }
    if (part > 1e-12) x += part * direction;
    converged = -slope < 1e-10 * state.value;
  }
  const Evaluation end = system.value(x);
  fmt::print("{} triangles laid out in {} iterations: energy per area {:.4g} -> {:.4g}, no triangle turned over: {}\n",
             mesh.cell_count(), iteration, first / area, last / area, end.require > 0);
  if (argc > 2) write_flat(argv[2], mesh, x);
  return converged && end.require > 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw std::runtime_error("usage: surface_parametrisation SURFACE [OUT.obj]");
    return flatten(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "surface_parametrisation: error: {}\n", error.what());
    return EXIT_FAILURE;
  }
}
