// Reading .msh files, written by hand and by Gmsh.

#include <gmock/gmock.h>
#include <gmsh.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "runtime/error.h"
#include "runtime/mesh/mesh_build.h"
#include "runtime/mesh/mesh_import.h"
#include "runtime/mesh/mesh_tools.h"
#include "tests/runtime/mesh_helpers.h"
#include "tests/runtime/temporary_folder.h"

namespace ergon {
namespace {

// A .msh file of version 2.2 with the eight corners of a box and the given elements.
std::string msh(const std::vector<std::string>& elements, const std::string& extra_node = "") {
  std::string text =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(extra_node.empty() ? 9 : 10) + "\n";
  text += "1 7 7 7\n";  // of no element
  const char* corners[] = {"0 0 0", "2 0 0", "2 1 0", "0 1 0", "0 0 1", "2 0 1", "2 1 1", "0 1 1"};
  for (int i = 0; i < 8; ++i) text += std::to_string(10 * (i + 1)) + " " + corners[i] + "\n";
  text += extra_node + "$EndNodes\n$Elements\n" + std::to_string(elements.size()) + "\n";
  for (size_t i = 0; i < elements.size(); ++i) text += std::to_string(i + 1) + " " + elements[i] + "\n";
  return text + "$EndElements\n";
}

TEST(mesh_msh, msh_cells_of_the_highest_dimension_are_read) {
  const TemporaryFolder folder;
  const Mesh hex = read_mesh(folder.file("hex.msh", msh({"2 2 0 1 10 20 30", "5 2 0 1 10 20 30 40 50 60 70 80"})));
  EXPECT_EQ(hex.element, Element::hex8);
  EXPECT_EQ(hex.vertices(), 8);
  check_mesh(hex);
  EXPECT_DOUBLE_EQ(rest_volumes(hex)[0], 2);
  const Mesh tet = read_mesh(folder.file("tet.msh", msh({"4 2 0 1 10 20 40 50", "4 2 0 1 20 30 40 70"})));
  EXPECT_EQ(tet.element, Element::tet4);
  EXPECT_EQ(tet.vertices(), 6);
  EXPECT_EQ(tet.cells, (std::vector<int>{0, 1, 3, 4, 1, 2, 3, 5}));
  const Mesh triangles = read_mesh(folder.file("tri.msh", msh({"2 2 0 1 10 20 30"})));
  EXPECT_EQ(triangles.element, Element::tri3);
  EXPECT_EQ(triangles.cells, (std::vector<int>{0, 1, 2}));
}

TEST(mesh_msh, quadratic_tetrahedra_come_in_the_order_of_vtk) {
  const TemporaryFolder folder;
  // Corners, then the middles of edges 01, 12, 20, 30, 23, 13, as Gmsh orders them.
  const std::string path = folder.file("ten.msh",
                                       "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n"
                                       "1 0 0 0\n2 2 0 0\n3 0 2 0\n4 0 0 2\n5 1 0 0\n6 1 1 0\n7 0 1 0\n8 0 0 1\n"
                                       "9 0 1 1\n10 1 0 1\n$EndNodes\n$Elements\n1\n"
                                       "1 11 2 0 1 1 2 3 4 5 6 7 8 9 10\n$EndElements\n");
  const Mesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.element, Element::tet10);
  check_mesh(mesh);
  Mesh corners = mesh;
  corners.element = Element::tet4;
  corners.cells.resize(4);
  corners.X = mesh.X.leftCols(4).eval();
  const Mesh expected = to_quadratic(corners, Element::tet10);
  for (size_t i = 0; i < 10; ++i) EXPECT_EQ(mesh.X.col(mesh.cells[i]), expected.X.col(expected.cells[i])) << i;
}

TEST(mesh_msh, bad_msh_files_are_told) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& name, const std::string& content) {
    const std::string path = folder.file(name, content);
    const std::string message = message_of([&] { read_mesh(path); });
    return message.starts_with(path) ? name + message.substr(path.size()) : message;
  };
  const std::string missing = folder.path("none.msh");
  EXPECT_EQ(message_of([&] { read_mesh(missing); }), missing + ": cannot be opened: No such file or directory");
  EXPECT_EQ(error_of("a.vtk", "x"), "a.vtk: unknown mesh format; a mesh is read from a .msh file of Gmsh");
  EXPECT_EQ(error_of("a.msh", "Point(1) = {0, 0, 0};\n"),
            "a.msh: is not a Gmsh mesh: it does not start with $MeshFormat");
  EXPECT_EQ(error_of("a.msh", msh({"15 2 0 1 10"})), "a.msh: holds no cells");
  EXPECT_EQ(error_of("a.msh", msh({"4 2 0 1 10 20 40 50", "5 2 0 1 10 20 30 40 50 60 70 80"})),
            "a.msh: holds more than one kind of cell: Tetrahedron 4, Hexahedron 8; mesh it with one kind");
  EXPECT_EQ(
      error_of("a.msh", msh({"7 2 0 1 10 20 30 40 50"})),
      "a.msh: cells of the kind 'Pyramid 5' are not supported; known are Tet4, Tet10, Hex8, Hex20, Hex27, Prism6, "
      "Tri3, Tri6, Quad4, Quad9, Edge2 and Edge3");
  EXPECT_EQ(error_of("a.msh", msh({"4 2 0 1 10 20 40 99"}, "99 0 nan 1\n")),
            "a.msh:15: node 99 is (0, nan, 1); it must be finite");
  EXPECT_EQ(error_of("a.msh", msh({"4 2 0 1 10 20 40 77"})), "a.msh:18: element 1 names node 77, which does not exist");
  EXPECT_EQ(error_of("a.msh", msh({"140 2 0 1 10"})), "a.msh:18: unknown type of element: 140");
  EXPECT_EQ(error_of("a.msh", msh({"4 2 0 1 10 20 40 50"}, "80 0 0 1\n")), "a.msh:15: node 80 is defined twice");
  EXPECT_EQ(error_of("a.msh", msh({"4 2 0 1 10 20 40 5x"})),
            "a.msh:18: a node of an element is '5x', which is not a whole number");
  EXPECT_EQ(error_of("a.msh", "$MeshFormat\n4 0 8\n$EndMeshFormat\n"),
            "a.msh:2: format 4 is not supported; save the mesh in format 4.1 or 2.2");
  EXPECT_EQ(error_of("a.msh", ""), "a.msh: is not a Gmsh mesh: it does not start with $MeshFormat");
  const std::string whole = msh({"4 2 0 1 10 20 40 50"});
  for (size_t length = 60; length + 14 < whole.size(); length += 17) {
    EXPECT_NE(error_of("cut.msh", whole.substr(0, length)), "no error") << length;
  }
}

// Gmsh itself tells where the nodes of its cells are, in their order.
TEST(mesh_msh, cells_of_every_kind_come_in_the_order_of_vtk) {
  const TemporaryFolder folder;
  const std::vector<std::pair<int, Element>> kinds{{1, Element::edge2},  {2, Element::tri3},   {3, Element::quad4},
                                                   {4, Element::tet4},   {5, Element::hex8},   {6, Element::prism6},
                                                   {8, Element::edge3},  {9, Element::tri6},   {10, Element::quad9},
                                                   {11, Element::tet10}, {12, Element::hex27}, {17, Element::hex20}};
  gmsh::initialize(0, nullptr, false);
  for (const auto& [type, element] : kinds) {
    std::string name;
    int dimension = 0, order = 0, nodes = 0, primary = 0;
    std::vector<double> coordinates;
    gmsh::model::mesh::getElementProperties(type, name, dimension, order, nodes, coordinates, primary);
    ASSERT_EQ(nodes, nodes_of(element));
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n" + std::to_string(nodes) + "\n";
    std::string cell = "1 " + std::to_string(type) + " 2 0 1";
    for (int i = 0; i < nodes; ++i) {
      text += std::to_string(i + 1);
      for (int axis = 0; axis < 3; ++axis) {
        text += " " + std::to_string(axis < dimension ? coordinates[static_cast<size_t>(dimension * i + axis)] : 0.0);
      }
      text += "\n";
      cell += " " + std::to_string(i + 1);
    }
    const Mesh mesh = read_mesh(folder.file("one.msh", text + "$EndNodes\n$Elements\n1\n" + cell + "\n$EndElements\n"));
    ASSERT_EQ(mesh.element, element);
    check_mesh(mesh);
    // Gmsh's factors are [-1, 1] where ours are [0, 1], but for triangles and tetrahedra.
    const ReferenceShape shape = shape_of(element);
    const bool simplex = shape == ReferenceShape::triangle || shape == ReferenceShape::tetrahedron;
    for (int i = 0; i < nodes; ++i) {
      Eigen::Vector3d expected = Eigen::Vector3d::Zero();
      for (int axis = 0; axis < dimension; ++axis) {
        const double t = reference_nodes(element)[static_cast<size_t>(i)](axis);
        expected(axis) = simplex || (shape == ReferenceShape::prism && axis < 2) ? t : 2 * t - 1;
      }
      EXPECT_LT((mesh.X.col(mesh.cells[static_cast<size_t>(i)]) - expected).norm(), 1e-6) << name << " node " << i;
    }
  }
  gmsh::finalize();
}

// A ball of radius 1 meshed by Gmsh and saved in a format of its own.
std::string saved_by_gmsh(const TemporaryFolder& folder, const std::string& name, double version, bool binary,
                          int order, bool parametric) {
  const std::string path = folder.path(name);
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::option::setNumber("Mesh.MshFileVersion", version);
  gmsh::option::setNumber("Mesh.Binary", binary);
  gmsh::option::setNumber("Mesh.SaveParametric", parametric);
  gmsh::option::setNumber("Mesh.SaveAll", 1);
  gmsh::option::setNumber("Mesh.MeshSizeMax", 0.5);
  gmsh::model::add("ball");
  gmsh::model::occ::addSphere(0, 0, 0, 1);
  gmsh::model::occ::synchronize();
  gmsh::model::addPhysicalGroup(3, {1}, 7);
  gmsh::model::setPhysicalName(3, 7, "the ball");
  gmsh::model::mesh::generate(3);
  gmsh::model::mesh::setOrder(order);
  gmsh::write(path);
  gmsh::finalize();
  return path;
}

TEST(mesh_msh, every_format_of_gmsh_gives_the_same_mesh) {
  const TemporaryFolder folder;
  for (const int order : {1, 2}) {
    const Mesh reference = read_mesh(saved_by_gmsh(folder, "reference.msh", 2.2, false, order, false));
    check_mesh(reference);
    EXPECT_EQ(reference.element, order == 1 ? Element::tet4 : Element::tet10);
    const auto volumes = rest_volumes(reference);
    EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0), 4.18879, order == 1 ? 0.6 : 0.02);
    for (const double version : {2.2, 4.1}) {
      for (const bool binary : {false, true}) {
        for (const bool parametric : {false, true}) {
          if (parametric && version < 4) continue;
          const Mesh mesh = read_mesh(saved_by_gmsh(folder, "ball.msh", version, binary, order, parametric));
          EXPECT_EQ(mesh.cells, reference.cells) << version << binary << parametric;
          EXPECT_LT((mesh.X - reference.X).cwiseAbs().maxCoeff(), 1e-15) << version << binary << parametric;
        }
      }
    }
  }
}

// Two boxes that share a face: a cell is in a group if its volume is; groups of surfaces are not of cells.
TEST(mesh_msh, physical_groups_of_every_format_hold_their_cells) {
  const TemporaryFolder folder;
  for (const double version : {2.2, 4.1}) {
    for (const bool binary : {false, true}) {
      const std::string path = folder.path("boxes.msh");
      gmsh::initialize(0, nullptr, false);
      gmsh::option::setNumber("General.Terminal", 0);
      gmsh::option::setNumber("Mesh.MshFileVersion", version);
      gmsh::option::setNumber("Mesh.Binary", binary);
      gmsh::option::setNumber("Mesh.MeshSizeMax", 0.4);
      gmsh::model::occ::addBox(0, 0, 0, 1, 1, 1);
      gmsh::model::occ::addBox(1, 0, 0, 2, 1, 1);
      std::vector<std::pair<int, int>> made;
      std::vector<std::vector<std::pair<int, int>>> from;
      gmsh::model::occ::fragment({{3, 1}}, {{3, 2}}, made, from);
      gmsh::model::occ::synchronize();
      gmsh::model::addPhysicalGroup(3, {from[0][0].second}, 7);
      gmsh::model::setPhysicalName(3, 7, "the core");
      gmsh::model::addPhysicalGroup(3, {from[1][0].second}, 9);
      gmsh::model::addPhysicalGroup(2, {1}, 7);
      gmsh::model::setPhysicalName(2, 7, "a face");
      gmsh::model::mesh::generate(3);
      gmsh::write(path);
      gmsh::finalize();

      const Mesh mesh = read_mesh(path);
      const auto volumes = rest_volumes(mesh);
      const auto groups = read_mesh_groups(path);
      ASSERT_EQ(groups.size(), 2u) << version << binary;
      const auto volume = [&](const std::string& name) {
        double sum = 0;
        for (const int cell : groups.at(name)) sum += volumes[static_cast<size_t>(cell)];
        return sum;
      };
      EXPECT_NEAR(volume("the core"), 1, 1e-12) << version << binary;
      EXPECT_NEAR(volume("9"), 2, 1e-12) << version << binary;
    }
  }
  const std::string named = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 7 core\n$EndPhysicalNames\n";
  try {
    read_mesh(folder.file("unquoted.msh", named));
    ADD_FAILURE();
  } catch (const InputError& bad) {
    EXPECT_THAT(bad.what(),
                testing::EndsWith("unquoted.msh:6: the name of the physical group 7 does not stand in quotes"));
  }
}

TEST(mesh_msh, parametric_nodes_of_format_2_are_refused) {
  const TemporaryFolder folder;
  const std::string path = saved_by_gmsh(folder, "ball.msh", 2.2, false, 1, true);
  EXPECT_EQ(message_of([&] { read_mesh(path); }),
            path + ":8: parametric nodes are read in format 4.1 only; save the mesh in that format");
}

TEST(mesh_msh, damaged_files_give_an_error_or_a_sound_mesh) {
  const TemporaryFolder folder;
  std::vector<std::string> wholes{msh({"4 2 0 1 10 20 40 50", "4 2 0 1 20 30 40 70"})};
  for (const bool binary : {false, true}) {
    for (const double version : {2.2, 4.1}) {
      saved_by_gmsh(folder, "ball.msh", version, binary, 1, false);
      wholes.push_back(folder.content("ball.msh"));
    }
  }
  std::mt19937 generator(2);
  int errors = 0, meshes = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::string content = wholes[static_cast<size_t>(trial) % wholes.size()];
    for (unsigned changes = generator() % 4; changes > 0; --changes) {
      content[60 + generator() % (content.size() - 60)] =
          static_cast<char>(generator() % 2 ? generator() : '0' + generator() % 10);
    }
    if (generator() % 4 == 0) content.resize(generator() % content.size());
    const std::string path = folder.file("damaged.msh", content);
    try {
      const Mesh mesh = read_mesh(path);
      ++meshes;
      ASSERT_TRUE(mesh.X.allFinite());
      for (const int v : mesh.cells) ASSERT_TRUE(v >= 0 && v < mesh.vertices());
    } catch (const InputError&) {
      ++errors;
    }
  }
  EXPECT_GT(errors, 100);
  EXPECT_GT(meshes, 50);
}

}  // namespace
}  // namespace ergon
