#include "runtime/mesh/mesh_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <climits>
#include <cmath>
#include <map>

#include "runtime/error.h"

namespace ergon {
namespace {

// An element in a brick: the corners at the reference element's origin and at the ends of its axes. Corner c is
// displaced by bit 0 of c along x, bit 1 along y, bit 2 along z.
using BrickPart = std::array<int, 4>;

std::vector<BrickPart> parts_of(Element element) {
  switch (shape_of(element)) {
    case ReferenceShape::point:
      break;
    case ReferenceShape::edge:
    case ReferenceShape::quadrilateral:
    case ReferenceShape::hexahedron:
      return {{0, 1, 2, 4}};
    case ReferenceShape::triangle:  // the first side of each lies along x
      return {{0, 1, 3, 4}, {3, 2, 0, 4}};
    case ReferenceShape::prism:
      return {{0, 1, 3, 4}, {0, 3, 2, 4}};
    case ReferenceShape::tetrahedron:
      // Each follows one order of the axes from corner 0 to corner 7; odd orders are listed mirrored.
      return {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  }
  return {};
}

void check_box(int dimension, const Eigen::Vector3d& size, const std::array<int, 3>& cells, size_t nodes_per_brick) {
  const char axes[] = "xyz";
  double bricks = 1;
  for (int axis = 0; axis < dimension; ++axis) {
    const int count = cells[static_cast<size_t>(axis)];
    if (!(size(axis) > 0) || !std::isfinite(size(axis))) {
      throw InputError(
          fmt::format("box: size along {} is {} m; it must be positive and finite", axes[axis], size(axis)));
    }
    if (count < 1) {
      throw InputError(fmt::format("box: {} cells along {}; at least 1 is needed", count, axes[axis]));
    }
    bricks *= count;
  }
  const size_t most = INT_MAX / nodes_per_brick;
  if (bricks > static_cast<double>(most)) {
    throw InputError(fmt::format("box: {} x {} x {} cells are too many; at most {} bricks can be numbered", cells[0],
                                 cells[1], cells[2], most));
  }
}

// Corners and middles of all bricks, x fastest; those that nodes lie on are numbered in this order.
class BoxLattice {
 public:
  BoxLattice(int dimension, const std::array<int, 3>& cells) {
    for (size_t axis = 0; axis < 3; ++axis) {
      cells_[axis] = static_cast<int>(axis) < dimension ? cells[axis] : 0;
      points_[axis] = 2 * static_cast<size_t>(cells_[axis]) + 1;
    }
    number_.assign(points_[0] * points_[1] * points_[2], -1);
  }

  int& number(const Eigen::Vector3i& place) {
    const Eigen::Array<size_t, 3, 1> at = place.array().cast<size_t>();
    return number_[at(0) + points_[0] * (at(1) + points_[1] * at(2))];
  }

  // Numbers all places at which number(place) is not negative, and gives their positions.
  Eigen::Matrix3Xd count(const Eigen::Vector3d& size) {
    int vertices = 0;
    for (int& number : number_) number = number < 0 ? -1 : vertices++;
    Eigen::Matrix3Xd X = Eigen::Matrix3Xd::Zero(3, vertices);
    for (size_t i = 0; i < number_.size(); ++i) {
      if (number_[i] < 0) continue;
      const std::array<size_t, 3> at{i % points_[0], i / points_[0] % points_[1], i / points_[0] / points_[1]};
      for (size_t axis = 0; axis < 3; ++axis) {
        const auto row = static_cast<Eigen::Index>(axis);
        if (cells_[axis] > 0) X(row, number_[i]) = size(row) * static_cast<double>(at[axis]) / (2 * cells_[axis]);
      }
    }
    return X;
  }

 private:
  std::array<int, 3> cells_;
  std::array<size_t, 3> points_;
  std::vector<int> number_;
};

// Places of the nodes of a brick on the lattice, from the brick's lowest corner.
std::vector<Eigen::Vector3i> places_of(Element element, const std::vector<BrickPart>& parts) {
  std::vector<Eigen::Vector3i> nodes;
  for (const BrickPart& part : parts) {
    const auto corner = [](int c) { return Eigen::Vector3i(c & 1, c >> 1 & 1, c >> 2); };
    Eigen::Matrix3i axes;
    for (int axis = 0; axis < 3; ++axis) axes.col(axis) = corner(part[static_cast<size_t>(axis) + 1]) - corner(part[0]);
    for (const Eigen::Vector3d& node : reference_nodes(element)) {
      nodes.emplace_back(2 * corner(part[0]) + axes * (2 * node).cast<int>());
    }
  }
  return nodes;
}

// Bricks are cut in one of two ways, in turn.
Mesh lattice_mesh(Element element, const Eigen::Vector3d& size, const std::array<int, 3>& cells,
                  const std::array<std::vector<BrickPart>, 2>& parts) {
  const int dimension = dimension_of(element);
  if (parts[0].empty()) throw InputError(fmt::format("box: a box is not made of {} elements", name_of(element)));
  check_box(dimension, size, cells, parts[0].size() * static_cast<size_t>(nodes_of(element)));
  const std::array<std::vector<Eigen::Vector3i>, 2> nodes = {places_of(element, parts[0]),
                                                             places_of(element, parts[1])};
  const auto for_each_node = [&](auto visit) {
    for (int k = 0; k < (dimension > 2 ? cells[2] : 1); ++k) {
      for (int j = 0; j < (dimension > 1 ? cells[1] : 1); ++j) {
        for (int i = 0; i < cells[0]; ++i) {
          for (const Eigen::Vector3i& node : nodes[static_cast<size_t>((i + j + k) % 2)])
            visit(2 * Eigen::Vector3i(i, j, k) + node);
        }
      }
    }
  };
  BoxLattice lattice(dimension, cells);
  for_each_node([&](const Eigen::Vector3i& place) { lattice.number(place) = 0; });
  Mesh mesh;
  mesh.element = element;
  mesh.source = "box";
  mesh.X = lattice.count(size);
  for_each_node([&](const Eigen::Vector3i& place) { mesh.cells.push_back(lattice.number(place)); });
  return mesh;
}

}  // namespace

Mesh box_mesh(Element element, const Eigen::Vector3d& size, const std::array<int, 3>& cells) {
  return lattice_mesh(element, size, cells, {parts_of(element), parts_of(element)});
}

Mesh alternating_triangles(Element element, const Eigen::Vector3d& size, const std::array<int, 3>& cells) {
  if (shape_of(element) != ReferenceShape::triangle)
    throw InputError(fmt::format("box: {} elements have no diagonals to turn", name_of(element)));
  return lattice_mesh(element, size, cells, {{parts_of(element), {{0, 1, 2, 4}, {3, 2, 1, 4}}}});
}

int elements_per_brick(Element element) { return static_cast<int>(parts_of(element).size()); }

Element linear_element(Element element) {
  for (const Element linear : all_elements()) {
    if (shape_of(linear) == shape_of(element)) return linear;  // the table lists it first
  }
  return element;
}

Mesh to_quadratic(const Mesh& mesh, Element element) {
  const Element linear = linear_element(element);
  if (mesh.element != linear || degree_of(element) != 2) {
    throw InputError(fmt::format("{}: only {} meshes become {}, this one is {}", mesh.source, name_of(linear),
                                 name_of(element), name_of(mesh.element)));
  }
  const auto corners = static_cast<size_t>(nodes_of(linear)), nodes = static_cast<size_t>(nodes_of(element));
  // Shares of the corners in the nodes that are added.
  std::vector<Eigen::VectorXd> shares;
  for (size_t i = corners; i < nodes; ++i) shares.push_back(shape_values(linear, reference_nodes(element)[i]));
  Mesh quadratic;
  quadratic.element = element;
  quadratic.source = mesh.source;
  quadratic.cells.reserve(static_cast<size_t>(mesh.cell_count()) * nodes);
  std::map<std::array<int, 8>, int> node_amid;  // by its corners in descending order, filled up with -1
  std::vector<Eigen::Vector3d> added;
  for (size_t cell = 0; cell < mesh.cells.size(); cell += corners) {
    const int* corner = &mesh.cells[cell];
    quadratic.cells.insert(quadratic.cells.end(), corner, corner + corners);
    for (const Eigen::VectorXd& share : shares) {
      std::array<int, 8> around;
      around.fill(-1);
      for (size_t c = 0; c < corners; ++c) {
        if (share(static_cast<Eigen::Index>(c)) != 0) around[c] = corner[c];
      }
      std::sort(around.rbegin(), around.rend());
      const auto [place, is_new] = node_amid.try_emplace(around, mesh.vertices() + static_cast<int>(added.size()));
      if (is_new) {
        added.push_back(Eigen::Vector3d::Zero());
        for (size_t c = 0; c < corners; ++c)
          added.back() += share(static_cast<Eigen::Index>(c)) * mesh.X.col(corner[c]);
      }
      quadratic.cells.push_back(place->second);
    }
  }
  quadratic.X.resize(3, mesh.vertices() + static_cast<Eigen::Index>(added.size()));
  quadratic.X.leftCols(mesh.vertices()) = mesh.X;
  for (size_t i = 0; i < added.size(); ++i) {
    quadratic.X.col(mesh.vertices() + static_cast<Eigen::Index>(i)) = added[i];
  }
  return quadratic;
}

}  // namespace ergon
