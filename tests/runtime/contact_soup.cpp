#include "tests/runtime/contact_soup.h"

#include <cmath>

#include "runtime/mesh/mesh_build.h"

namespace ergon {

Eigen::Matrix3Xd noise(const Eigen::Matrix3Xd& x, double amount, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> spread(-amount, amount);
  Eigen::Matrix3Xd moved = x;
  for (double& each : moved.reshaped()) each += spread(random);
  return moved;
}

Soup make_soup(const SoupOptions& options) {
  std::mt19937 random(options.seed);
  std::uniform_real_distribution<double> unit(0, 1);
  const int n = options.cells;
  Mesh flat = box_mesh(Element::tri3, {1, 1, 1}, {n, n, n}), upright = flat,
       rod = box_mesh(Element::edge2, {1, 1, 1}, {4 * n, 1, 1}), loose;
  upright.X.row(2).swap(upright.X.row(1));
  upright.X.row(1).array() += 0.5;
  upright.X.row(2).array() -= 0.4;
  for (int v = 0; v < rod.vertices(); ++v) {
    const double s = rod.X(0, v);
    rod.X.col(v) = Eigen::Vector3d(s, 0.5 + 0.2 * std::cos(20 * s), 0.2 * std::sin(20 * s));
  }
  loose.element = Element::point;
  loose.X.resize(3, options.loose);
  for (int v = 0; v < options.loose; ++v) {
    loose.X.col(v) = Eigen::Vector3d(unit(random), unit(random), 0.3 * (unit(random) - 0.5));
    loose.cells.push_back(v);
  }
  const Mesh* meshes[] = {&flat, &upright, &rod, &loose};
  const char* names[] = {"flat", "upright", "rod", "loose"};
  std::vector<CollisionObject> objects;
  int vertices = 0;
  for (size_t i = 0; i < 4; ++i) {
    if (meshes[i]->cells.empty()) continue;
    objects.push_back({names[i], meshes[i], vertices, options.radius[i]});
    vertices += meshes[i]->vertices();
  }
  std::vector<char> moving(static_cast<size_t>(vertices));
  for (char& each : moving) each = unit(random) >= options.resting;
  Soup soup{make_surface(objects, moving), Eigen::Matrix3Xd(3, vertices)};
  for (const CollisionObject& object : objects)
    soup.x.middleCols(object.first_vertex, object.mesh->vertices()) = object.mesh->X;
  soup.x = noise(soup.x, options.noise / n, options.seed + 100);
  soup.x.array() += options.offset;
  return soup;
}

}  // namespace ergon
