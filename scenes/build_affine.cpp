#include "scenes/build_affine.h"

#include <Eigen/Geometry>
#include <cmath>

namespace ergon {
namespace {

constexpr double same = 1e-9;  // relative difference of stiffness, of bodies that are alike up to rounding

double volume_of(const Eigen::Matrix<double, 3, 4>& points) {
  const Eigen::Vector3d a = points.col(1) - points.col(0), b = points.col(2) - points.col(0),
                        c = points.col(3) - points.col(0);
  return a.cross(b).dot(c) / 6;
}

}  // namespace

void start_affine(const SceneObject& object, const Body& body, BuiltScene& out) {
  out.start.x.middleCols<4>(body.first_control) = equimomental_points(*body.moments);
  for (int k = 0; k < 4; ++k)
    out.start.v.col(body.first_control + k) = Eigen::Map<const Eigen::Vector3d>(object.velocity.data());
  out.mass.segment<4>(body.first_control).setConstant(object.density * body.moments->volume / 4);
}

Carriers carriers_of(const std::vector<Body>& bodies) {
  Carriers out;
  for (const Body& body : bodies) {
    if (!body.affine()) continue;
    const int number = out.add_body(body.first_control);
    const Eigen::Matrix<double, 3, 4> points = equimomental_points(*body.moments);
    for (int v = 0; v < body.ordered.vertices(); ++v)
      out.carry(body.first_vertex + v, number, barycentric(points, body.ordered.X.col(v)));
    for (size_t i = 0; i < body.places.size(); ++i)
      out.carry(body.first_place + static_cast<int>(i), number, barycentric(points, body.places[i]));
  }
  return out;
}

void add_affine_potentials(const Scene& scene, const Kernel& orthogonality, BuiltScene& out) {
  Mesh controls;
  controls.element = Element::tet4;
  controls.source = "control points of affine bodies";
  struct Kind {
    double stiffness;        // Pa, over the volume of the control points
    std::vector<int> cells;  // of `controls`
  };
  std::vector<Kind> kinds;
  int first = -1, last = -1;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const Body& body = out.bodies[i];
    if (!body.affine()) continue;
    if (first < 0) first = body.first_control;
    last = body.first_control + 4;
    const double volume = volume_of(out.start.x.middleCols<4>(body.first_control));
    const double stiffness = scene.objects[i].stiffness * body.moments->volume / volume;
    auto kind = kinds.begin();
    while (kind != kinds.end() && std::abs(kind->stiffness - stiffness) > same * stiffness) ++kind;
    if (kind == kinds.end()) kind = kinds.insert(kind, {stiffness, {}});
    for (int k = 0; k < 4; ++k) kind->cells.push_back(body.first_control - first + k);
  }
  if (first < 0) return;
  controls.X = out.start.x.middleCols(first, last - first);
  for (const Kind& kind : kinds) {
    controls.cells = kind.cells;
    out.system->add(
        Potential::on_mesh("affine_orthogonality", orthogonality, controls, first, {{"stiffness", {kind.stiffness}}}));
  }
}

}  // namespace ergon
