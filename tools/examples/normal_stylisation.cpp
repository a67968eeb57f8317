// Styles by normals: a surface is moved so that its normals go to those that a style wants, here the nearest axis of
// space, which makes a cube of anything, while the stars of its vertices keep their shape. Energies without time again,
// with a lag: the rotations of the stars are found between solves, and the Hessian of the rest is constant.
// Liu, Jacobson 2021. Normal-Driven Spherical Shape Analogies. CGF 40(5): as-rigid-as-possible stars whose rotations
// also take the normal of each vertex to its target. usage: normal_stylisation SURFACE [OUT.obj]

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>

#include "codegen/compile.h"
#include "runtime/lanes/lanes.h"
#include "runtime/mesh/mesh_import.h"
#include "runtime/solver/linear_solver.h"
#include "runtime/system.h"
#include "symbolic/energy.h"

namespace {

using namespace ergon;
using Eigen::Matrix3d;
using Eigen::Vector3d;

const char* const law =
    "energy   star_edge  edge\ndof      x0 x1   m\nrest     X0[3] X1[3]   m\nrest     w   N/m   cotangent weight\n"
    "lag      R[3, 3]   1   rotation of the star that the edge is seen from\n"
    "value    w/2*norm2(x1 - x0 - R*(X1 - X0))\n";

// Every edge once for each of the stars that it is in: its own ends' and those of the corners across (spokes and rims).
struct Stars {
  std::vector<int> edges;  // two vertices each
  std::vector<int> owner;  // vertex whose star it is
  std::vector<double> weight;
  std::vector<double> area;  // per vertex, a third of its triangles'
  Eigen::Matrix3Xd normal;   // per vertex, weighted by area
};

Stars stars_of(const Mesh& mesh) {
  Stars out;
  out.area.assign(static_cast<size_t>(mesh.vertices()), 0);
  out.normal.setZero(3, mesh.vertices());
  for (size_t t = 0; t < mesh.cells.size(); t += 3) {
    const int* v = &mesh.cells[t];
    const Vector3d n = (mesh.X.col(v[1]) - mesh.X.col(v[0])).cross(mesh.X.col(v[2]) - mesh.X.col(v[0]));
    for (int c = 0; c < 3; ++c) {
      out.area[static_cast<size_t>(v[c])] += n.norm() / 6;
      out.normal.col(v[c]) += n;
      const int a = v[(c + 1) % 3], b = v[(c + 2) % 3];
      const Vector3d p = mesh.X.col(a) - mesh.X.col(v[c]), q = mesh.X.col(b) - mesh.X.col(v[c]);
      const double half_cotangent = p.dot(q) / p.cross(q).norm() / 2;
      for (int star = 0; star < 3; ++star) {
        out.edges.insert(out.edges.end(), {a, b});
        out.owner.push_back(v[star]);
        out.weight.push_back(half_cotangent);
      }
    }
  }
  out.normal.colwise().normalize();
  return out;
}

// The rotation that takes the sum of b a' nearest to itself. Kabsch 1976, Acta Cryst. A32.
Matrix3d rotation_to(const Matrix3d& sum) {
  const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vector3d sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

Vector3d nearest_axis(const Vector3d& n) {
  Eigen::Index axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  return std::copysign(1, n[axis]) * Vector3d::Unit(axis);
}

// Area whose normal is within 15 degrees of an axis, as a part of all.
double part_along_axes(const Mesh& mesh, const Eigen::Matrix3Xd& x) {
  double along = 0, all = 0;
  for (size_t t = 0; t < mesh.cells.size(); t += 3) {
    const Vector3d a = x.col(mesh.cells[t]);
    const Vector3d n = (x.col(mesh.cells[t + 1]) - a).cross(x.col(mesh.cells[t + 2]) - a);
    all += n.norm();
    if (n.cwiseAbs().maxCoeff() > std::cos(std::atan(1) / 3) * n.norm()) along += n.norm();
  }
  return along / all;
}

int stylise(int argc, char** argv) {
  constexpr double strength = 8;  // of normals, against the shape of stars
  constexpr int rounds = 60;
  const Mesh mesh = read_surface(argv[1]);
  const int n = mesh.vertices();
  const Stars stars = stars_of(mesh);
  CompileOptions options;
  options.lanes = lanes::best_lanes();
  const CompiledKernel compiled = compile(parse_energy(law, "normal_stylisation"), options);
  System system(n);
  system.add(Potential::on_stencils("stars", {compiled.library, compiled.table}, stars.edges, mesh.X, {},
                                    {{"w", stars.weight}}));
  std::vector<char> fixed(static_cast<size_t>(n), 0);
  fixed[0] = 1;
  system.set_fixed(fixed);

  Eigen::Matrix3Xd x = mesh.X, gradient;
  BlockMatrix hessian;
  LinearSolver solver;
  std::vector<double> rotations(9 * stars.owner.size());
  for (int round = 0; round < rounds; ++round) {
    std::vector<Matrix3d> sums(static_cast<size_t>(n));
    for (size_t v = 0; v < sums.size(); ++v) {
      const Vector3d normal = stars.normal.col(static_cast<Eigen::Index>(v));
      sums[v] = strength * stars.area[v] * nearest_axis(normal) * normal.transpose();
    }
    for (size_t e = 0; e < stars.owner.size(); ++e) {
      const int a = stars.edges[2 * e], b = stars.edges[2 * e + 1];
      sums[static_cast<size_t>(stars.owner[e])] +=
          stars.weight[e] * (x.col(b) - x.col(a)) * (mesh.X.col(b) - mesh.X.col(a)).transpose();
    }
    for (Matrix3d& sum : sums) sum = rotation_to(sum);
    for (size_t e = 0; e < stars.owner.size(); ++e) {
      const Matrix3d& rotation = sums[static_cast<size_t>(stars.owner[e])];
      std::copy(rotation.data(), rotation.data() + 9, rotations.begin() + static_cast<ptrdiff_t>(9 * e));
    }
    system.potential(0).set_lag("R", rotations);
    system.hessian(x, Projection::none, gradient, hessian);
    if (round == 0 && solver.factor(hessian)) throw std::runtime_error("the Hessian has no factor");
    Eigen::VectorXd force(hessian.rows()), step;
    for (int i = 0; i < n; ++i)
      if (system.block_of(i) >= 0) force.segment<3>(3 * system.block_of(i)) = -gradient.col(i);
    solver.solve(force, step);
    for (int i = 0; i < n; ++i)
      if (system.block_of(i) >= 0) x.col(i) += step.segment<3>(3 * system.block_of(i));
  }
  fmt::print("{} triangles: {:.3g} of the area along an axis before, {:.3g} after {} rounds\n", mesh.cell_count(),
             part_along_axes(mesh, mesh.X), part_along_axes(mesh, x), rounds);
  if (argc > 2) {
    std::FILE* file = std::fopen(argv[2], "w");
    if (file == nullptr) throw std::runtime_error(fmt::format("{}: cannot be written", argv[2]));
    for (int i = 0; i < n; ++i) fmt::print(file, "v {:.9g} {:.9g} {:.9g}\n", x(0, i), x(1, i), x(2, i));
    for (size_t t = 0; t < mesh.cells.size(); t += 3)
      fmt::print(file, "f {} {} {}\n", mesh.cells[t] + 1, mesh.cells[t + 1] + 1, mesh.cells[t + 2] + 1);
    std::fclose(file);
  }
  return EXIT_SUCCESS;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw std::runtime_error("usage: normal_stylisation SURFACE [OUT.obj]");
    return stylise(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "normal_stylisation: error: {}\n", error.what());
    return EXIT_FAILURE;
  }
}
