#include "runtime/mesh/element.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cctype>

#include "runtime/error.h"
#include "runtime/nearest.h"

namespace ergon {
namespace {

// Nodes are written as digits, one for each axis: 0, 1 and 2 stand for 0, 1/2 and 1.
struct ElementRow {
  Element element;
  const char* name;
  ReferenceShape shape;
  int dimension;
  int degree;
  int vtk_cell_type;
  const char* nodes;
};

// Corners of a cube, and the nodes amid its edges.
#define ERGON_CUBE_CORNERS "000 200 220 020 002 202 222 022"
#define ERGON_CUBE_EDGES " 100 210 120 010 102 212 122 012 001 201 221 021"

constexpr ElementRow kElements[] = {
    {Element::point, "Point", ReferenceShape::point, 0, 0, 1, "000"},
    {Element::edge2, "Edge2", ReferenceShape::edge, 1, 1, 3, "000 200"},
    {Element::edge3, "Edge3", ReferenceShape::edge, 1, 2, 21, "000 200 100"},
    {Element::tri3, "Tri3", ReferenceShape::triangle, 2, 1, 5, "000 200 020"},
    {Element::tri6, "Tri6", ReferenceShape::triangle, 2, 2, 22, "000 200 020 100 110 010"},
    {Element::quad4, "Quad4", ReferenceShape::quadrilateral, 2, 1, 9, "000 200 220 020"},
    {Element::quad9, "Quad9", ReferenceShape::quadrilateral, 2, 2, 28, "000 200 220 020 100 210 120 010 110"},
    {Element::tet4, "Tet4", ReferenceShape::tetrahedron, 3, 1, 10, "000 200 020 002"},
    {Element::tet10, "Tet10", ReferenceShape::tetrahedron, 3, 2, 24, "000 200 020 002 100 110 010 001 101 011"},
    {Element::hex8, "Hex8", ReferenceShape::hexahedron, 3, 1, 12, ERGON_CUBE_CORNERS},
    {Element::hex20, "Hex20", ReferenceShape::hexahedron, 3, 2, 25, ERGON_CUBE_CORNERS ERGON_CUBE_EDGES},
    {Element::hex27, "Hex27", ReferenceShape::hexahedron, 3, 2, 29,
     ERGON_CUBE_CORNERS ERGON_CUBE_EDGES " 011 211 101 121 110 112 111"},
    {Element::prism6, "Prism6", ReferenceShape::prism, 3, 1, 13, "000 200 020 002 202 022"}};

const ElementRow& row_of(Element element) { return kElements[static_cast<size_t>(element)]; }

using Exponents = std::array<int, 3>;

bool spans(const ElementRow& row, const Exponents& e) {
  for (int axis = row.dimension; axis < 3; ++axis) {
    if (e[static_cast<size_t>(axis)] > 0) return false;
  }
  switch (row.shape) {
    case ReferenceShape::edge:
    case ReferenceShape::triangle:
    case ReferenceShape::tetrahedron:
      return e[0] + e[1] + e[2] <= row.degree;
    case ReferenceShape::prism:
      return e[0] + e[1] <= row.degree && e[2] <= row.degree;
    default:
      break;
  }
  if (row.element != Element::hex20) return std::max({e[0], e[1], e[2]}) <= row.degree;
  int superlinear = 0;  // the total degree without variables that enter linearly
  for (const int power : e) superlinear += power > 1 ? power : 0;
  return superlinear <= row.degree;
}

// Shape functions as sums of monomials: N_a = sum_m coefficients(m, a) x^exponents[m]. With nodes at 0, 1/2 and 1 all
// coefficients are whole numbers.
struct Basis {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<Exponents> exponents;
  Eigen::MatrixXd coefficients;
};

// The powers 0 to 2 of each coordinate.
using Powers = std::array<std::array<double, 3>, 3>;

Powers powers_of(const Eigen::Vector3d& point) {
  Powers powers;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double x = point(static_cast<Eigen::Index>(axis));
    powers[axis] = {1, x, x * x};
  }
  return powers;
}

double monomial(const Exponents& e, const Powers& p) {
  return p[0][static_cast<size_t>(e[0])] * p[1][static_cast<size_t>(e[1])] * p[2][static_cast<size_t>(e[2])];
}

Basis make_basis(const ElementRow& row) {
  Basis basis;
  for (const char* digit = row.nodes; *digit != '\0'; digit += *digit == ' ') {
    Eigen::Vector3d node;
    for (int axis = 0; axis < 3; ++axis) node(axis) = (*digit++ - '0') / 2.0;
    basis.nodes.push_back(node);
  }
  for (int i = 0; i < 27; ++i) {
    const Exponents e{i % 3, i / 3 % 3, i / 9};
    if (spans(row, e)) basis.exponents.push_back(e);
  }
  const auto n = static_cast<Eigen::Index>(basis.nodes.size());
  Eigen::MatrixXd at_nodes(n, static_cast<Eigen::Index>(basis.exponents.size()));
  for (Eigen::Index a = 0; a < n; ++a) {
    const Powers powers = powers_of(basis.nodes[static_cast<size_t>(a)]);
    for (Eigen::Index m = 0; m < at_nodes.cols(); ++m) {
      at_nodes(a, m) = monomial(basis.exponents[static_cast<size_t>(m)], powers);
    }
  }
  basis.coefficients = at_nodes.fullPivLu().inverse().array().round();
  return basis;
}

const Basis& basis_of(Element element) {
  static const std::vector<Basis> bases = [] {
    std::vector<Basis> made;
    for (const ElementRow& row : kElements) made.push_back(make_basis(row));
    return made;
  }();
  return bases[static_cast<size_t>(element)];
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

}  // namespace

const std::vector<Element>& all_elements() {
  static const std::vector<Element> all = [] {
    std::vector<Element> elements;
    for (const ElementRow& row : kElements) elements.push_back(row.element);
    return elements;
  }();
  return all;
}

int nodes_of(Element element) {
  // Three digits and a space for each node.
  return static_cast<int>(std::string_view(row_of(element).nodes).size() + 1) / 4;
}
int dimension_of(Element element) { return row_of(element).dimension; }
int degree_of(Element element) { return row_of(element).degree; }
ReferenceShape shape_of(Element element) { return row_of(element).shape; }
std::string name_of(Element element) { return row_of(element).name; }
int vtk_cell_type(Element element) { return row_of(element).vtk_cell_type; }
bool has_constant_gradients(Element element) { return nodes_of(element) == dimension_of(element) + 1; }
const std::vector<Eigen::Vector3d>& reference_nodes(Element element) { return basis_of(element).nodes; }

Element element_named(std::string_view name) {
  const std::string wanted = lower_case(name);
  std::vector<std::string> known, lower;
  for (const ElementRow& row : kElements) {
    known.emplace_back(row.name);
    lower.push_back(lower_case(row.name));
    if (lower.back() == wanted) return row.element;
  }
  const std::string nearest = nearest_of(wanted, lower);
  if (nearest.empty()) {
    throw InputError(fmt::format("unknown element '{}'; known elements are {}", name, fmt::join(known, ", ")));
  }
  const auto place = std::find(lower.begin(), lower.end(), nearest) - lower.begin();
  throw InputError(fmt::format("unknown element '{}'; did you mean '{}'?", name, known[static_cast<size_t>(place)]));
}

Eigen::VectorXd shape_values(Element element, const Eigen::Vector3d& point) {
  const Basis& basis = basis_of(element);
  const Powers powers = powers_of(point);
  Eigen::VectorXd monomials(basis.coefficients.rows());
  for (Eigen::Index m = 0; m < monomials.size(); ++m) {
    monomials(m) = monomial(basis.exponents[static_cast<size_t>(m)], powers);
  }
  return basis.coefficients.transpose() * monomials;
}

Eigen::MatrixXd shape_gradients(Element element, const Eigen::Vector3d& point) {
  const Basis& basis = basis_of(element);
  const Powers powers = powers_of(point);
  Eigen::MatrixXd monomials(basis.coefficients.rows(), dimension_of(element));
  for (Eigen::Index m = 0; m < monomials.rows(); ++m) {
    for (Eigen::Index axis = 0; axis < monomials.cols(); ++axis) {
      Exponents e = basis.exponents[static_cast<size_t>(m)];
      const int power = e[static_cast<size_t>(axis)]--;
      monomials(m, axis) = power == 0 ? 0 : power * monomial(e, powers);
    }
  }
  return basis.coefficients.transpose() * monomials;
}

}  // namespace ergon
