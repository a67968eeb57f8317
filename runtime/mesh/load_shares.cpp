#include "runtime/mesh/load_shares.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "runtime/error.h"
#include "runtime/mesh/element_faces.h"
#include "runtime/mesh/quadrature.h"

namespace ergon {
namespace {

constexpr int exactness = 4;  // of products of the shape functions of degree 2 along an axis with the size of a face

// A face or edge of the reference element: origin + s*u + t*v.
struct ReferencePart {
  Eigen::Vector3d origin, u, v = Eigen::Vector3d::Zero();
};

// A face or edge of a mesh.
struct MeshPart {
  size_t first_node = 0;   // of the first cell that it belongs to, in Mesh::cells
  std::vector<int> nodes;  // of that cell, that lie on it
  ReferencePart part;
  Element shape = Element::edge2;
  int cells = 0;  // that it belongs to
};

// Adds the integrals of the shape functions over the part, of which those of nodes elsewhere are nothing; the part's
// measure.
double integrate(const Mesh& mesh, const MeshPart& at, Eigen::VectorXd& sums) {
  const QuadratureRule rule = quadrature(at.shape, exactness);
  const ReferencePart& part = at.part;
  const int* cell = mesh.cells.data() + at.first_node;
  double measure = 0;
  for (size_t k = 0; k < rule.points.size(); ++k) {
    const Eigen::Vector3d point = part.origin + rule.points[k].x() * part.u + rule.points[k].y() * part.v;
    const Eigen::MatrixXd gradients = shape_gradients(mesh.element, point);
    const Eigen::VectorXd values = shape_values(mesh.element, point);
    Eigen::Vector3d along_u = Eigen::Vector3d::Zero(), along_v = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < gradients.rows(); ++i) {
      along_u += mesh.X.col(cell[i]) * gradients.row(i).dot(part.u.head(gradients.cols()));
      along_v += mesh.X.col(cell[i]) * gradients.row(i).dot(part.v.head(gradients.cols()));
    }
    const double size = rule.weights[k] * (part.v.isZero(0) ? along_u.norm() : along_u.cross(along_v).norm());
    for (const int node : at.nodes) sums[cell[node]] += size * values[node];
    measure += size;
  }
  return measure;
}

template <class Visit>  // visit(first node of the cell, nodes of the part in the cell, its reference part, its shape)
void over_faces(const Mesh& mesh, Visit visit) {
  const std::vector<Eigen::Vector3d>& nodes = reference_nodes(mesh.element);
  const auto node = [&](const ElementFace& face, size_t i) { return nodes[static_cast<size_t>(face.nodes[i])]; };
  for (size_t first = 0; first < mesh.cells.size(); first += static_cast<size_t>(nodes_of(mesh.element)))
    for (const ElementFace& face : faces_of(mesh.element)) {
      const Eigen::Vector3d origin = node(face, 0);
      const size_t last = static_cast<size_t>(face.corners) - 1;
      visit(first, face.nodes, ReferencePart{origin, node(face, 1) - origin, node(face, last) - origin},
            face.corners == 3 ? Element::tri3 : Element::quad4);
    }
}

template <class Visit>
void over_edges(const Mesh& mesh, Visit visit) {
  const std::vector<Eigen::Vector3d>& nodes = reference_nodes(mesh.element);
  for (size_t first = 0; first < mesh.cells.size(); first += static_cast<size_t>(nodes_of(mesh.element)))
    for (const auto& [a, b] : corner_edges(mesh.element)) {
      const Eigen::Vector3d from = nodes[static_cast<size_t>(a)], to = nodes[static_cast<size_t>(b)];
      std::vector<int> ends = {a, b};
      const auto amid = std::find(nodes.begin(), nodes.end(), ((from + to) / 2).eval());
      if (amid != nodes.end()) ends.push_back(static_cast<int>(amid - nodes.begin()));
      visit(first, ends, ReferencePart{from, to - from}, Element::edge2);
    }
}

// Parts that have all their nodes among the chosen vertices; faces of solids inside the mesh are none.
std::vector<MeshPart> chosen_parts(const Mesh& mesh, const std::vector<char>& chosen, int dimension) {
  std::map<std::vector<int>, MeshPart> found;
  const auto visit = [&](size_t first, const std::vector<int>& nodes, const ReferencePart& part, Element shape) {
    std::vector<int> vertices;
    for (const int n : nodes) vertices.push_back(mesh.cells[first + static_cast<size_t>(n)]);
    if (!std::all_of(vertices.begin(), vertices.end(), [&](int v) { return chosen[static_cast<size_t>(v)] != 0; }))
      return;
    std::sort(vertices.begin(), vertices.end());
    MeshPart& entry = found.try_emplace(vertices, MeshPart{first, nodes, part, shape, 0}).first->second;
    ++entry.cells;
  };
  if (dimension == 2)
    over_faces(mesh, visit);
  else
    over_edges(mesh, visit);
  const bool inside = dimension == 2 && dimension_of(mesh.element) == 3;
  std::vector<MeshPart> out;
  for (const auto& [vertices, part] : found)
    if (!inside || part.cells == 1) out.push_back(part);
  return out;
}

}  // namespace

LoadShares load_shares(const Mesh& mesh, const std::vector<int>& vertices) {
  if (vertices.empty()) throw InputError("a load needs at least one vertex to act on");
  std::vector<char> chosen(static_cast<size_t>(mesh.vertices()), 0);
  for (const int v : vertices) chosen[static_cast<size_t>(v)] = 1;
  LoadShares out;
  out.shares = Eigen::VectorXd::Zero(mesh.vertices());
  for (int dimension = std::min(2, dimension_of(mesh.element)); dimension > 0; --dimension) {
    for (const MeshPart& part : chosen_parts(mesh, chosen, dimension)) out.measure += integrate(mesh, part, out.shares);
    out.dimension = dimension;
    if (out.measure > 0) {
      out.shares /= out.measure;
      return out;
    }
  }
  out.dimension = 0;
  for (int v = 0; v < mesh.vertices(); ++v) out.shares[v] = chosen[static_cast<size_t>(v)];
  out.measure = out.shares.sum();
  out.shares /= out.measure;
  return out;
}

}  // namespace ergon
