#include "tools/stencils.h"

#include "runtime/mesh/mesh_stencils.h"
#include "tools/sample.h"

namespace ergon {
namespace {

// Sheets one above the other, every second one shifted against its neighbours by a part of a cell, so that vertices lie
// over the inside of triangles and edges cross inside.
class Sheets {
 public:
  explicit Sheets(int cells) : cells_(cells), row_(cells + 1), size_(row_ * row_) {
    const Mesh sheet = sample_mesh(Element::tri3, cells);
    mesh.element = Element::tri3;
    mesh.X.resize(3, size_ * row_);
    for (int k = 0; k <= cells; ++k) {
      const double shift = k % 2;
      const Eigen::Vector3d corner = Eigen::Vector3d(shift * shift_x, shift * shift_y, k) / cells;
      mesh.X.middleCols(k * size_, size_) = sheet.X.colwise() + corner;
      for (const int v : sheet.cells) mesh.cells.push_back(k * size_ + v);
    }
  }

  // p, then the triangle of a neighbouring sheet that it projects into.
  std::vector<int> point_triangles() const {
    std::vector<int> flat;
    for_each_pair([&](int of, int to, int i, int j) {
      // A shifted vertex is over the upper triangle of its cell, one that is not over the lower one of the cell before.
      const bool shifted = of % 2 != 0;
      const int c = shifted ? i : i - 1, r = shifted ? j : j - 1;
      if (c < 0 || r < 0 || c == cells_ || r == cells_) return;
      const int a = vertex(to, c, r), b = vertex(to, c + 1, r + 1),
                side = shifted ? vertex(to, c, r + 1) : vertex(to, c + 1, r);
      flat.insert(flat.end(), {vertex(of, i, j), a, shifted ? b : side, shifted ? side : b});
    });
    return flat;
  }

  // Triangles, and corners of them in the sheet above, or below the last, for the tips of their normals.
  std::vector<int> shell_triangles() const {
    std::vector<int> flat;
    for (size_t c = 0; c < mesh.cells.size(); c += 3) {
      const int *t = &mesh.cells[c], other = t[0] < cells_ * size_ ? size_ : -size_;
      flat.insert(flat.end(), {t[0], t[1], t[2], t[1] + other, t[2] + other, t[0] + other});
    }
    return flat;
  }

  // Edges along x of one sheet with those along y of the other that they cross.
  std::vector<int> edge_edges() const {
    std::vector<int> flat;
    for_each_pair([&](int of, int to, int i, int j) {
      const bool shifted = of % 2 != 0;
      const int c = shifted ? i + 1 : i, r = shifted ? j : j - 1;
      if (i == cells_ || r < 0 || r == cells_) return;
      flat.insert(flat.end(), {vertex(of, i, j), vertex(of, i + 1, j), vertex(to, c, r), vertex(to, c, r + 1)});
    });
    return flat;
  }

  Mesh mesh;

 private:
  static constexpr double shift_x = 0.35, shift_y = 0.6;  // of a cell

  int vertex(int sheet, int i, int j) const { return sheet * size_ + j * row_ + i; }
  // f(sheet, a neighbour, column, row) for each vertex of the sheet.
  template <class F>
  void for_each_pair(F f) const {
    for (int k = 0; k <= cells_; ++k) {
      for (int to = k - 1; to <= k + 1; to += 2) {
        if (to < 0 || to > cells_) continue;
        for (int j = 0; j < row_; ++j) {
          for (int i = 0; i < row_; ++i) f(k, to, i, j);
        }
      }
    }
  }

  int cells_, row_, size_;
};

// The first `kept` of every `points` points.
std::vector<int> shortened(const std::vector<int>& stencils, size_t kept, size_t points = 4) {
  std::vector<int> flat;
  for (size_t start = 0; start < stencils.size(); start += points) {
    for (size_t i = 0; i < kept; ++i) flat.push_back(stencils[start + i]);
  }
  return flat;
}

}  // namespace

StencilSample sample_stencils(std::string_view geometry, int cells) {
  if (geometry == "point" || geometry == "edge" || geometry == "tetrahedron") {
    Mesh mesh = sample_mesh(Element::tet4, cells);
    std::vector<int> stencils = stencils_on_mesh(geometry, mesh);
    return {std::move(mesh), std::move(stencils)};
  }
  const bool patches = geometry == "patch" || geometry == "rod_corner";
  Sheets sheets(patches ? std::max(cells, 2) : cells);  // two triangles are too few
  std::vector<int> stencils;
  if (geometry == "point_triangle") {
    stencils = sheets.point_triangles();
  } else if (geometry == "point_edge") {
    stencils = shortened(sheets.point_triangles(), 3);
  } else if (geometry == "point_point") {
    stencils = shortened(sheets.point_triangles(), 2);
  } else if (geometry == "edge_edge") {
    stencils = sheets.edge_edges();
  } else if (geometry == "rod_corner") {
    stencils = shortened(stencils_on_mesh("patch", sheets.mesh), 5, 6);
  } else if (geometry == "shell_triangle") {
    stencils = sheets.shell_triangles();
  } else {
    stencils = stencils_on_mesh(geometry == "corner" ? "triangle" : geometry, sheets.mesh);
  }
  return {std::move(sheets.mesh), std::move(stencils)};
}

}  // namespace ergon
