#include "scenes/build_mass.h"

#include <algorithm>
#include <numeric>

#include "runtime/mesh/consistent_mass.h"

namespace ergon {
namespace {

// Points that have mass of their own: not those of obstacles, nor those that affine bodies carry or that hold one in
// its place.
std::vector<int> heavy_points(const BuiltScene& built) {
  std::vector<int> out;
  for (int v = 0; v < built.mass.size(); ++v)
    if (built.mass[v] > 0 && !built.coupled_mass.couples(v)) out.push_back(v);
  return out;
}

std::vector<double> masses_of(const Eigen::VectorXd& mass, const std::vector<int>& points) {
  std::vector<double> out;
  for (const int v : points) out.push_back(mass[v]);
  return out;
}

}  // namespace

bool has_consistent_mass(const SceneObject& object, const Body& body) {
  if (object.affine()) return false;
  return object.mass == "consistent" || (object.mass == "automatic" && !lumping_suits(body.ordered.element));
}

CoupledMass coupled_mass_of(const Scene& scene, const std::vector<Body>& bodies, int vertices) {
  CoupledMass out;
  out.bound.setZero(vertices);
  std::vector<Eigen::Triplet<double>> mass, drag;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const SceneObject& object = scene.objects[i];
    const Body& body = bodies[i];
    if (!has_consistent_mass(object, body)) continue;
    const CoupledMass own = consistent_mass(body.ordered, object.density * body.section);
    out.bound.segment(body.first_vertex, own.bound.size()) = own.bound;
    for (int row = 0; row < own.mass.rows(); ++row)
      for (CoupledMass::Matrix::InnerIterator entry(own.mass, row); entry; ++entry) {
        const int i = body.first_vertex + row, j = body.first_vertex + static_cast<int>(entry.col());
        mass.emplace_back(i, j, entry.value());
        if (object.mass_damping > 0) drag.emplace_back(i, j, object.mass_damping * entry.value());
      }
  }
  out.mass.resize(vertices, vertices);
  out.mass.setFromTriplets(mass.begin(), mass.end());
  out.drag.resize(vertices, vertices);
  out.drag.setFromTriplets(drag.begin(), drag.end());
  return out;
}

void add_inertia(const Kernel& kernel, BuiltScene& out) {
  const std::vector<int> points = heavy_points(out);
  if (points.empty()) return;
  out.system->add(
      Potential::on_stencils("inertia", kernel, points, out.start.x, {}, {{"mass", masses_of(out.mass, points)}}));
}

void add_gravity(const Scene& scene, const Kernel& kernel, BuiltScene& out) {
  const Eigen::VectorXd share = out.mass_shares();
  std::vector<int> points;
  for (int v = 0; v < share.size(); ++v)
    if (share[v] != 0) points.push_back(v);
  const std::vector<double> g(scene.gravity.begin(), scene.gravity.end());
  const int index = out.system->add(
      Potential::on_stencils("gravity", kernel, points, out.start.x, {{"g", g}}, {{"mass", masses_of(share, points)}}));
  add_load(scene, index, "g", g, out);
}

void add_mass_damping(const Scene& scene, const Kernel& kernel, BuiltScene& out) {
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].mass_damping == 0) continue;
    const Body& body = out.bodies[i];
    const int first = body.affine() ? body.first_control : body.first_vertex;
    std::vector<int> points(body.affine() ? 4 : static_cast<size_t>(body.ordered.vertices()));
    std::iota(points.begin(), points.end(), first);
    for (int cell = 0; body.twists() && cell < body.ordered.cell_count(); ++cell)
      points.push_back(body.first_twist + cell);
    for (int edge = 0; edge < body.tips; ++edge) points.push_back(body.first_tip() + edge);
    std::erase_if(points, [&](int v) { return out.mass[v] == 0 || out.coupled_mass.couples(v); });
    if (points.empty()) continue;
    out.system->add(Potential::on_stencils("drag", kernel, points, out.start.x,
                                           {{"rate", {scene.objects[i].mass_damping}}},
                                           {{"mass", masses_of(out.mass, points)}}));
  }
}

}  // namespace ergon
