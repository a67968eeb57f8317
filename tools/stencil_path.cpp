#include "tools/stencil_path.h"

#include <cmath>

namespace ergon {
namespace {

using Points = std::vector<Eigen::Vector3d>;

Eigen::VectorXd flat(const Points& points) {
  Eigen::VectorXd x(3 * static_cast<Eigen::Index>(points.size()));
  for (size_t i = 0; i < points.size(); ++i) x.segment<3>(3 * static_cast<Eigen::Index>(i)) = points[i];
  return x;
}

// The whole stencil grows about the origin.
StencilPath scaled(const Points& points) {
  const Eigen::VectorXd x = flat(points);
  return {
      "scale", "scale", "1", 0.3, 2, 1, [x](double s) { return Eigen::VectorXd(s * x); }, [x](double) { return x; }};
}

// The first `moved` points go away from the others along z.
StencilPath apart(const Points& points, size_t moved) {
  Points along(points.size(), Eigen::Vector3d::Zero());
  for (size_t i = 0; i < moved; ++i) along[i] = Eigen::Vector3d::UnitZ();
  const Eigen::VectorXd x = flat(points), d = flat(along);
  return {"distance",
          "distance",
          "m",
          0.01,
          1.5,
          1,
          [=](double s) { return Eigen::VectorXd(x + s * d); },
          [d](double) { return d; }};
}

// The last point turns about an axis through the origin, from `arm` in the plane of `arm` and `side`.
StencilPath turned(const Points& others, const Eigen::Vector3d& arm, const Eigen::Vector3d& side, double most) {
  auto with_last = [others](const Eigen::Vector3d& last, double factor) {
    Points points = others;
    for (Eigen::Vector3d& point : points) point *= factor;
    points.push_back(last);
    return flat(points);
  };
  return {"angle",
          "angle",
          "rad",
          -most,
          most,
          0,
          [=](double s) { return with_last(std::cos(s) * arm + std::sin(s) * side, 1); },
          [=](double s) { return with_last(-std::sin(s) * arm + std::cos(s) * side, 0); }};
}

}  // namespace

std::vector<StencilPath> stencil_paths(const std::string& stencil) {
  const Eigen::Vector3d o = Eigen::Vector3d::Zero(), x = Eigen::Vector3d::UnitX(), y = Eigen::Vector3d::UnitY(),
                        z = Eigen::Vector3d::UnitZ();
  if (stencil == "point") {
    const Eigen::Vector3d along(0.6, 0, 0.8);  // across and along the usual direction of a normal
    return {{"displacement", "displacement", "m", -1, 1, 0, [along](double s) { return Eigen::VectorXd(s * along); },
             [along](double) { return Eigen::VectorXd(along); }}};
  }
  if (stencil == "edge")
    return {{"length", "length", "m", 0.3, 2.5, 1,
             [=](double s) {
               return flat({o, s * x});
             },
             [=](double) {
               return flat({o, x});
             }}};
  if (stencil == "hinge") return {turned({-0.5 * x, 0.5 * x, y}, -y, -z, 2.5)};
  if (stencil == "patch")  // flat, and the last triangle turns about its edge
    return {turned({-0.5 * x, 0.5 * x, y, x + 0.5 * y, -x + 0.5 * y}, -y, -z, 2.5)};
  if (stencil == "shell_triangle")  // flat, and the last normal turns about its edge
    return {turned({-0.5 * x, 0.5 * x, y, 0.25 * x + 0.5 * y + z, -0.25 * x + 0.5 * y + z}, z, -y, 1.5)};
  if (stencil == "rod_corner")
    return {{"twist", "twist", "m", -2.5, 2.5, 0,
             [=](double s) {
               return flat({-y, o, y, o, s * x});
             },
             [=](double) {
               return flat({o, o, o, o, x});
             }},
            {"angle", "angle", "rad", -2.5, 2.5, 0,
             [=](double s) {
               return flat({-y, o, std::cos(s) * y + std::sin(s) * z, o, o});
             },
             [=](double s) {
               return flat({o, o, std::cos(s) * z - std::sin(s) * y, o, o});
             }}};
  if (stencil == "corner") return {turned({-x, o}, x, y, 2.5)};
  if (stencil == "triangle") return {turned({-x, o}, x, y, 2.5), scaled({o, x, y}), apart({o, x, y}, 3)};
  if (stencil == "tetrahedron") return {scaled({o, x, y, z})};
  if (stencil == "point_point") return {apart({o, o}, 1)};
  if (stencil == "point_edge") return {apart({o, -x / 2, x / 2}, 1)};
  if (stencil == "point_triangle") return {apart({(x + y) / 3, o, x, y}, 1)};
  return {apart({-x / 2, x / 2, -y / 2, y / 2}, 2)};  // edge_edge
}

}  // namespace ergon
