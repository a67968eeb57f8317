#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <optional>
#include <unordered_map>

#include "runtime/error.h"
#include "runtime/mesh/mesh_import.h"
#include "runtime/mesh/msh_words.h"
#include "runtime/mesh/surface_readers.h"

namespace ergon {
namespace {

// Gmsh's numbers of cells (Gmsh reference manual, MSH file format).
struct MshCell {
  int type;
  const char* name;
  int nodes;
  int dimension;
  std::optional<Element> element = std::nullopt;
  std::vector<size_t> order = {};  // Gmsh's place of each node in VTK's order; empty: the same
};
const MshCell kMshCells[] = {
    {1, "Line 2", 2, 1, Element::edge2},
    {2, "Triangle 3", 3, 2, Element::tri3},
    {3, "Quadrilateral 4", 4, 2, Element::quad4},
    {4, "Tetrahedron 4", 4, 3, Element::tet4},
    {5, "Hexahedron 8", 8, 3, Element::hex8},
    {6, "Prism 6", 6, 3, Element::prism6},
    {7, "Pyramid 5", 5, 3},
    {8, "Line 3", 3, 1, Element::edge3},
    {9, "Triangle 6", 6, 2, Element::tri6},
    {10, "Quadrilateral 9", 9, 2, Element::quad9},
    {11, "Tetrahedron 10", 10, 3, Element::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 9, 8}},
    {12, "Hexahedron 27", 27, 3, Element::hex27, {0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  16, 18,
                                                  19, 17, 10, 12, 14, 15, 22, 23, 21, 24, 20, 25, 26}},
    {13, "Prism 18", 18, 3},
    {14, "Pyramid 14", 14, 3},
    {15, "Point", 1, 0},
    {16, "Quadrilateral 8", 8, 2},
    {17, "Hexahedron 20", 20, 3, Element::hex20, {0,  1, 2,  3,  4,  5,  6,  7,  8,  11,
                                                  13, 9, 16, 18, 19, 17, 10, 12, 14, 15}},
    {18, "Prism 15", 15, 3},
    {19, "Pyramid 13", 13, 3},
    {21, "Triangle 10", 10, 2},
    {23, "Triangle 15", 15, 2},
    {26, "Line 4", 4, 1},
    {27, "Line 5", 5, 1},
    {29, "Tetrahedron 20", 20, 3},
    {30, "Tetrahedron 35", 35, 3}};

class MshReader : MshWords {
 public:
  using MshWords::MshWords;

  Mesh read() {
    read_format();
    while (const auto word = next_word()) {
      if (*word == "$Nodes") {
        version_ < 4 ? read_nodes_2() : read_nodes_4();
        expect("$EndNodes");
      } else if (*word == "$Elements") {
        version_ < 4 ? read_cells_2() : read_cells_4();
        expect("$EndElements");
      } else if (*word == "$PhysicalNames") {
        read_group_names();
        expect("$EndPhysicalNames");
      } else if (*word == "$Entities" && version_ == 4) {
        read_entities();
        expect("$EndEntities");
      } else if (*word == "$ParametricNodes") {
        fail("parametric nodes are read in format 4.1 only; save the mesh in that format");
      } else if ((*word)[0] == '$') {
        skip_section(*word);
      } else {
        fail(fmt::format("expected a section such as $Nodes, found '{}'", *word));
      }
    }
    return mesh();
  }

  std::map<std::string, std::vector<int>> groups() const {
    const MshCell& cell = kept();
    std::map<std::string, std::vector<int>> out;
    const std::vector<std::vector<int>>& groups = groups_.at(cell.type);
    for (size_t i = 0; i < groups.size(); ++i)
      for (const int group : groups[i]) {
        const auto name = names_.find({cell.dimension, group});
        out[name == names_.end() ? std::to_string(group) : name->second].push_back(static_cast<int>(i));
      }
    return out;
  }

 private:
  using Entity = std::pair<int, int>;  // dimension and number

  void read_format() {
    const auto first = next_word();
    if (!first || *first != "$MeshFormat") {
      throw InputError(path_ + ": is not a Gmsh mesh: it does not start with $MeshFormat");
    }
    const std::string version(word("the version"));
    const bool old = version.starts_with("2");
    if (!old && version != "4.1") {
      fail(fmt::format("format {} is not supported; save the mesh in format 4.1 or 2.2", version));
    }
    version_ = old ? 2 : 4;
    const bool binary = whole<int>("the file type", true) != 0;
    if (const long long size = whole<int>("the data size", true); size != 8) {
      fail(fmt::format("the data size is {}; it must be 8", size));
    }
    if (binary) {
      binary_ = true;
      end_line();
      if (binary_number<std::int32_t>("the byte order") != 1) fail("was written in another byte order");
    }
    expect("$EndMeshFormat");
    end_line();
  }

  // Text in binary files too.
  void read_group_names() {
    const long long names = count<int>("the number of physical names", true);
    for (long long i = 0; i < names; ++i) {
      const int dimension = static_cast<int>(whole<int>("the dimension of a physical group", true));
      const int number = static_cast<int>(whole<int>("the number of a physical group", true));
      const size_t open = rest_.find('"'), close = rest_.find('"', open + 1), line = rest_.find('\n');
      if (close == std::string_view::npos || close > line)
        fail(fmt::format("the name of the physical group {} does not stand in quotes", number));
      names_[{dimension, number}] = std::string(rest_.substr(open + 1, close - open - 1));
      rest_.remove_prefix(close + 1);
    }
  }

  // Which physical groups the points, curves, surfaces and volumes of the model belong to.
  void read_entities() {
    end_line();
    std::array<long long, 4> counts{};
    for (long long& entities : counts) entities = count<std::uint64_t>("the number of entities");
    for (int dimension = 0; dimension < 4; ++dimension) {
      for (long long i = 0; i < counts[static_cast<size_t>(dimension)]; ++i) {
        const int entity = static_cast<int>(whole<std::int32_t>("an entity's number"));
        for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) number("a bound of an entity");
        const long long groups = count<std::uint64_t>("the number of an entity's physical groups");
        for (long long k = 0; k < groups; ++k)
          entity_groups_[{dimension, entity}].push_back(std::abs(static_cast<int>(whole<std::int32_t>("a group"))));
        const long long bounds = dimension == 0 ? 0 : count<std::uint64_t>("the number of an entity's bounds");
        for (long long k = 0; k < bounds; ++k) whole<std::int32_t>("a bounding entity");
      }
    }
  }

  Eigen::Vector3d point(long long tag) {
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) point(axis) = number("a coordinate");
    if (!point.allFinite()) {
      fail(fmt::format("node {} is ({}, {}, {}); it must be finite", tag, point.x(), point.y(), point.z()));
    }
    return point;
  }

  void add_node(long long tag) {
    if (!nodes_.emplace(tag, point(tag)).second) fail(fmt::format("node {} is defined twice", tag));
  }

  void read_nodes_2() {
    const long long nodes = count<int>("the number of nodes", true);
    end_line();
    for (long long i = 0; i < nodes; ++i) add_node(whole<std::int32_t>("a node's number"));
  }

  void read_nodes_4() {
    end_line();
    const long long blocks = count<std::uint64_t>("the number of blocks of nodes");
    for (int i = 0; i < 3; ++i) whole<std::uint64_t>("the number or range of nodes");
    for (long long b = 0; b < blocks; ++b) {
      const long long dimension = count<std::int32_t>("a block's dimension");
      whole<std::int32_t>("a block's entity");
      const bool parametric = whole<std::int32_t>("a block's parametric mark") != 0;
      const long long nodes = count<std::uint64_t>("the number of nodes of a block");
      std::vector<long long> tags;
      for (long long i = 0; i < nodes; ++i) tags.push_back(whole<std::uint64_t>("a node's number"));
      for (const long long tag : tags) {
        add_node(tag);
        for (long long i = 0; parametric && i < std::min(dimension, 3LL); ++i) number("a parameter");
      }
    }
  }

  const MshCell& kind(long long type) const {
    for (const MshCell& cell : kMshCells) {
      if (cell.type == type) return cell;
    }
    fail(fmt::format("unknown type of element: {}", type));
  }

  template <class Stored>
  void add_cell(const MshCell& kind, long long tag) {
    std::vector<long long>& cells = cells_[kind.type];
    for (int i = 0; i < kind.nodes; ++i) {
      const long long node = whole<Stored>("a node of an element");
      if (!nodes_.contains(node)) fail(fmt::format("element {} names node {}, which does not exist", tag, node));
      cells.push_back(node);
    }
  }

  void read_cells_2() {
    const long long elements = count<int>("the number of elements", true);
    end_line();
    for (long long done = 0; done < elements;) {
      // In text each element is a block of its own, and its number comes first.
      long long tag = binary_ ? 0 : whole<int>("an element's number");
      const MshCell& cell = kind(whole<std::int32_t>("an element's type"));
      const long long in_block = binary_ ? count<std::int32_t>("the number of elements of a block") : 1;
      const long long tags = count<std::int32_t>("the number of an element's tags");
      if (in_block == 0) fail("a block of elements is empty");
      for (long long i = 0; i < in_block; ++i) {
        if (binary_) tag = whole<std::int32_t>("an element's number");
        std::vector<int> group;  // the first tag, 0 for none
        for (long long k = 0; k < tags; ++k) {
          const int value = static_cast<int>(whole<std::int32_t>("an element's tag"));
          if (k == 0 && value != 0) group.push_back(value);
        }
        groups_[cell.type].push_back(std::move(group));
        add_cell<std::int32_t>(cell, tag);
      }
      done += in_block;
    }
  }

  void read_cells_4() {
    end_line();
    const long long blocks = count<std::uint64_t>("the number of blocks of elements");
    for (int i = 0; i < 3; ++i) whole<std::uint64_t>("the number or range of elements");
    for (long long b = 0; b < blocks; ++b) {
      const int dimension = static_cast<int>(whole<std::int32_t>("a block's dimension"));
      const int entity = static_cast<int>(whole<std::int32_t>("a block's entity"));
      const MshCell& cell = kind(whole<std::int32_t>("an element's type"));
      const long long elements = count<std::uint64_t>("the number of elements of a block");
      const auto groups = entity_groups_.find({dimension, entity});
      for (long long i = 0; i < elements; ++i) {
        groups_[cell.type].push_back(groups == entity_groups_.end() ? std::vector<int>{} : groups->second);
        add_cell<std::uint64_t>(cell, whole<std::uint64_t>("an element's number"));
      }
    }
  }

  // The one kind of cells of the highest dimension.
  const MshCell& kept() const {
    int dimension = 1;
    for (const auto& [type, cells] : cells_) {
      if (!cells.empty()) dimension = std::max(dimension, kind(type).dimension);
    }
    std::vector<const MshCell*> kinds;
    std::vector<std::string> names;
    for (const auto& [type, cells] : cells_) {
      if (cells.empty() || kind(type).dimension != dimension) continue;
      kinds.push_back(&kind(type));
      names.push_back(kind(type).name);
    }
    if (kinds.empty()) throw InputError(path_ + ": holds no cells");
    if (kinds.size() > 1) {
      throw InputError(fmt::format("{}: holds more than one kind of cell: {}; mesh it with one kind", path_,
                                   fmt::join(names, ", ")));
    }
    if (!kinds[0]->element) {
      throw InputError(
          fmt::format("{}: cells of the kind '{}' are not supported; known are Tet4, Tet10, Hex8, "
                      "Hex20, Hex27, Prism6, Tri3, Tri6, Quad4, Quad9, Edge2 and Edge3",
                      path_, names[0]));
    }
    return *kinds[0];
  }

  // Of the kept cells, with their vertices numbered anew.
  Mesh mesh() const {
    const MshCell& kind = kept();
    const std::vector<long long>& tags = cells_.at(kind.type);
    std::vector<long long> used = tags;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    Mesh mesh;
    mesh.element = *kind.element;
    mesh.source = path_;
    mesh.X.resize(3, static_cast<Eigen::Index>(used.size()));
    for (size_t i = 0; i < used.size(); ++i) mesh.X.col(static_cast<Eigen::Index>(i)) = nodes_.at(used[i]);
    for (const long long tag : tags) {
      mesh.cells.push_back(static_cast<int>(std::lower_bound(used.begin(), used.end(), tag) - used.begin()));
    }
    const std::vector<size_t>& order = kind.order;
    std::vector<int> cell(order.size());
    for (size_t first = 0; first < mesh.cells.size() && !order.empty(); first += order.size()) {
      for (size_t i = 0; i < order.size(); ++i) cell[i] = mesh.cells[first + order[i]];
      std::copy(cell.begin(), cell.end(), mesh.cells.begin() + static_cast<ptrdiff_t>(first));
    }
    return mesh;
  }

  int version_ = 0;                                       // 2 or 4
  std::unordered_map<long long, Eigen::Vector3d> nodes_;  // by tag
  std::map<int, std::vector<long long>> cells_;           // node tags by type
  std::map<int, std::vector<std::vector<int>>> groups_;   // of each cell, by type
  std::map<Entity, std::vector<int>> entity_groups_;
  std::map<Entity, std::string> names_;
};

// The file, which the reader does not copy, and its reader.
template <class F>
auto read_msh(const std::string& path, F result) {
  if (!path.ends_with(".msh")) {
    throw InputError(path + ": unknown mesh format; a mesh is read from a .msh file of Gmsh");
  }
  const std::string data = whole_file(path);
  MshReader reader(data, path);
  return result(reader);
}

}  // namespace

Mesh read_mesh(const std::string& path) {
  return read_msh(path, [](MshReader& reader) { return reader.read(); });
}

std::map<std::string, std::vector<int>> read_mesh_groups(const std::string& path) {
  return read_msh(path, [](MshReader& reader) {
    reader.read();
    return reader.groups();
  });
}

}  // namespace ergon
