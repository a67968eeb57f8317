#include "tools/sample.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "runtime/error.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_stencils.h"

namespace ergon {

Mesh sample_mesh(Element element, int cells) {
  if (cells < 1) throw InputError(fmt::format("{} cells per edge; at least 1 is needed", cells));
  const Eigen::Vector3d size = Eigen::Vector3d::Ones();
  const std::array<int, 3> counts = {cells, cells, cells};
  if (dimension_of(element) != 1) return box_mesh(element, size, counts);
  Mesh mesh = box_tets(size, counts);
  mesh.cells = stencils_on_mesh("edge", mesh);
  mesh.element = Element::edge2;
  return element == Element::edge2 ? mesh : to_quadratic(mesh, element);
}

Eigen::Matrix3Xd displaced(const Eigen::Matrix3Xd& X, double spacing, double amplitude) {
  std::mt19937_64 random(20);  // fixed seed; only its raw bits are used, which the standard defines
  auto uniform = [&random](double low, double high) { return low + (high - low) * double(random() >> 11) * 0x1p-53; };
  Eigen::Matrix3Xd noise = Eigen::Matrix3Xd::Zero(3, X.cols());
  for (int c = 0; c < 3; ++c) {
    for (int wave = 0; wave < 3; ++wave) {
      Eigen::Vector3d k(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
      k *= 2 * std::numbers::pi / (k.norm() * spacing * uniform(3, 6));
      const double phase = uniform(0, 2 * std::numbers::pi);
      noise.row(c) += ((k.transpose() * X).array() + phase).sin().matrix();
    }
  }
  return X + noise * (amplitude / noise.cwiseAbs().maxCoeff());
}

Element default_element(const Energy& density) {
  if (density.geometry == "solid") return Element::tet4;
  return density.geometry == "membrane" ? Element::tri3 : Element::edge2;
}

void check_element(const Energy& density, Element element) {
  const int dimension = density.geometry == "solid" ? 3 : density.geometry == "membrane" ? 2 : 1;
  if (dimension_of(element) != dimension) {
    throw InputError(fmt::format("{} is a density of a {}; {} elements have dimension {}, not {}", density.name,
                                 density.geometry, name_of(element), dimension_of(element), dimension));
  }
}

std::map<std::string, std::vector<double>> sample_values(const Energy& energy, Role role, int attempt) {
  // Rest data are drawn apart from params: an offset is not to equal a length.
  std::mt19937_64 random(static_cast<unsigned long>(attempt) + (role == Role::rest ? 1000000 : 0));
  auto uniform = [&random](double low, double high) { return low + (high - low) * double(random() >> 11) * 0x1p-53; };
  std::map<std::string, std::vector<double>> values;
  for (const Symbol* symbol : energy.with_role(role)) {
    std::vector<double>& at = values[symbol->name];
    const Range& range = symbol->range;
    const bool below = std::isfinite(range.lower), above = std::isfinite(range.upper);
    for (int i = 0; i < symbol->shape.size(); ++i) {
      const double fraction = attempt == 0 ? 0.8 : uniform(0.05, 0.95);
      const double distance = attempt == 0 ? 1 : std::pow(10, uniform(-2, 2));
      if (below && above) {
        at.push_back(range.lower + fraction * (range.upper - range.lower));
      } else if (below) {
        at.push_back(range.lower + distance);
      } else if (above) {
        at.push_back(range.upper - distance);
      } else {
        at.push_back(attempt == 0 ? 0 : uniform(-10, 10));
      }
    }
    // A direction: params of this shape are unit normals.
    if (symbol->shape != Shape{3, 1} || !symbol->unit.dimensionless()) continue;
    if (twists_of_stencil(energy.geometry) == 0) at = {0, 0, 1};
    if (twists_of_stencil(energy.geometry) > 0 && role == Role::rest) at = {symbol->name == "d0" ? 1.0 : 0.0, 0, 1};
  }
  return values;
}

}  // namespace ergon
