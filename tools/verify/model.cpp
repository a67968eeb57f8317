#include "tools/verify/model.h"

#include <fmt/format.h>

#include <numeric>
#include <stdexcept>

#include "runtime/lanes/lanes.h"
#include "runtime/mesh/edge_normals.h"
#include "runtime/mesh/mesh_stencils.h"
#include "symbolic/energy.h"
#include "tools/installation.h"

namespace ergon {

std::vector<int> vertices_where(const Mesh& mesh, const std::function<bool(const Eigen::Vector3d& X)>& chosen) {
  std::vector<int> out;
  for (int v = 0; v < mesh.vertices(); ++v)
    if (chosen(mesh.X.col(v))) out.push_back(v);
  return out;
}

int vertex_near(const Mesh& mesh, const Eigen::Vector3d& place) {
  Eigen::Index nearest = 0;
  (mesh.X.colwise() - place).colwise().squaredNorm().minCoeff(&nearest);
  return static_cast<int>(nearest);
}

Kernel catalogue_kernel(const std::string& law) { return load_kernel(find_energy(law), "", lanes::best_lanes()); }

namespace {

Eigen::Matrix3Xd at_rest(const Mesh& mesh, bool normals) {
  if (!normals) return mesh.X;
  const Eigen::Matrix3Xd tips = edge_normal_tips(mesh);
  Eigen::Matrix3Xd x(3, mesh.X.cols() + tips.cols());
  x << mesh.X, tips;
  return x;
}

}  // namespace

Model::Model(Mesh mesh, bool normals)
    : x(at_rest(mesh, normals)),
      rest_(x),
      mesh_(std::move(mesh)),
      system_(static_cast<int>(x.cols())),
      held_(static_cast<size_t>(x.cols()), 0) {}

int Model::add(const std::string& law, const Parameters& params, std::optional<int> exactness) {
  const Energy energy = find_energy(law);
  const Kernel kernel = load_kernel(energy, "", lanes::best_lanes());
  if (energy.kind == Energy::Kind::density)
    return system_.add(Potential::on_mesh(law, kernel, mesh_, 0, params, exactness));
  const std::vector<int> stencils = stencils_on_mesh(energy.geometry, mesh_);
  StencilData rest;
  for (const RestSize& size : rest_sizes(energy.geometry))
    if (energy.find(size.name) != nullptr) rest[size.name] = rest_size_of(size, energy.geometry, stencils, mesh_);
  return system_.add(Potential::on_stencils(law, kernel, stencils, rest_, params, rest));
}

int Model::add_load(const Eigen::VectorXd& shares, const Eigen::Vector3d& force) {
  std::vector<int> points;
  std::vector<double> of_points;
  for (int v = 0; v < mesh_.vertices(); ++v) {
    if (shares[v] == 0) continue;
    points.push_back(v);
    of_points.push_back(shares[v]);
  }
  return system_.add(Potential::on_stencils("dead_load", catalogue_kernel("dead_load"), points, mesh_.X,
                                            {{"force", {force[0], force[1], force[2]}}}, {{"share", of_points}}));
}

void Model::set_load(int load, const Eigen::Vector3d& force) {
  system_.potential(load).set_param("force", {force[0], force[1], force[2]});
}

void Model::mirror(char axis) {
  const int k = axis - 'x';
  const double rounding = 1e-9 * mesh_.X.row(k).cwiseAbs().maxCoeff();
  const auto in_plane = [&](int v) { return std::abs(mesh_.X(k, v)) < rounding; };
  hold(vertices_where(mesh_, [&](const Eigen::Vector3d& X) { return std::abs(X[k]) < rounding; }), {&axis, 1});
  if (x.cols() == mesh_.vertices()) return;
  const std::vector<int> edges = stencils_on_mesh("edge", mesh_);
  for (size_t e = 0; e < edges.size(); e += 2) {
    if (!in_plane(edges[e]) || !in_plane(edges[e + 1])) continue;
    const auto a = mesh_.X.col(edges[e]), b = mesh_.X.col(edges[e + 1]);
    const int tip = mesh_.vertices() + static_cast<int>(e / 2);
    // That of the border's triangle; the mirrored one makes it lie in the plane.
    Eigen::Vector3d normal = x.col(tip) - (a + b) / 2;
    normal[k] = 0;
    x.col(tip) = rest_.col(tip) = (a + b) / 2 + (b - a).norm() * normal.normalized();
    hold({tip}, {&axis, 1});
  }
}

void Model::hold_normals(const std::vector<int>& vertices) {
  const std::vector<int> edges = stencils_on_mesh("edge", mesh_);
  std::vector<char> in(static_cast<size_t>(mesh_.vertices()), 0);
  for (const int v : vertices) in[static_cast<size_t>(v)] = 1;
  std::vector<int> tips;
  for (size_t e = 0; e < edges.size(); e += 2)
    if (in[static_cast<size_t>(edges[e])] != 0 && in[static_cast<size_t>(edges[e + 1])] != 0)
      tips.push_back(mesh_.vertices() + static_cast<int>(e / 2));
  hold(tips);
}

void Model::hold(const std::vector<int>& vertices, std::string_view axes) {
  for (const int v : vertices)
    for (const char axis : axes) held_[static_cast<size_t>(v)] |= static_cast<unsigned char>(1 << (axis - 'x'));
  holds_changed_ = true;
}

void Model::apply_holds() {
  if (!holds_changed_) return;
  std::vector<char> fixed;
  std::vector<Guide> guides;
  for (int v = 0; v < system_.vertices(); ++v) {
    const unsigned held = held_[static_cast<size_t>(v)];
    fixed.push_back(held == 7);
    if (held == 0 || held == 7) continue;
    guides.push_back({v, Eigen::Matrix3d::Identity()});
    for (int axis = 0; axis < 3; ++axis)
      if ((held >> axis & 1) != 0) guides.back().along(axis, axis) = 0;
  }
  system_.set_fixed(fixed);
  system_.set_guides(std::move(guides));
  holds_changed_ = false;
}

NewtonResult Model::solve(double tolerance) {
  apply_holds();
  NewtonOptions options;
  options.tolerance = tolerance;
  options.on_demand = true;
  NewtonResult result = newton_.minimise(system_, x, options);
  if (!result.converged) throw std::runtime_error("no equilibrium was found: " + result.reason);
  return result;
}

const BlockMatrix& Model::tangent() {
  apply_holds();
  Eigen::Matrix3Xd gradient;
  system_.hessian(x, Projection::none, gradient, tangent_);
  return tangent_;
}

bool Model::stable() { return !solver_.factor(tangent()); }

Eigen::Matrix3Xd Model::reactions() {
  std::vector<int> all(static_cast<size_t>(system_.potential_count()));
  std::iota(all.begin(), all.end(), 0);
  Eigen::Matrix3Xd gradient;
  system_.gradient_of(all, x, gradient);
  return gradient;
}

}  // namespace ergon
