#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "runtime/contact/make_surface.h"
#include "runtime/mesh/mesh_build.h"
#include "tests/runtime/mesh_helpers.h"

namespace ergon {
namespace {

std::vector<char> all_moving(int vertices) { return std::vector<char>(static_cast<size_t>(vertices), 1); }

std::vector<Element> of_dimension(int dimension) {
  std::vector<Element> elements;
  for (const Element element : all_elements()) {
    if (dimension_of(element) == dimension) elements.push_back(element);
  }
  return elements;
}

CollisionSurface surface_of(const Mesh& mesh) {
  CollisionSurface surface = make_surface({{"it", &mesh, 0, 0}}, all_moving(mesh.vertices()));
  check_surface(surface);
  return surface;
}

class SurfaceOfSolid : public ::testing::TestWithParam<Element> {};
class SurfaceOfMembrane : public ::testing::TestWithParam<Element> {};
INSTANTIATE_TEST_SUITE_P(contact, SurfaceOfSolid, ::testing::ValuesIn(of_dimension(3)),
                         [](const auto& info) { return name_of(info.param); });
INSTANTIATE_TEST_SUITE_P(contact, SurfaceOfMembrane, ::testing::ValuesIn(of_dimension(2)),
                         [](const auto& info) { return name_of(info.param); });

TEST_P(SurfaceOfSolid, IsClosedAndUsesEveryVertexOnIt) {
  const Mesh mesh = box_mesh(GetParam(), {2, 3, 4}, {2, 3, 4});
  const CollisionSurface surface = surface_of(mesh);
  const auto faces = static_cast<int>(surface.triangles.size()), edges = static_cast<int>(surface.edges.size()),
             points = static_cast<int>(surface.points.size());
  EXPECT_EQ(2 * edges, 3 * faces);
  EXPECT_EQ(points - edges + faces, 2);
  int on_boundary = 0;
  for (int v = 0; v < mesh.vertices(); ++v) {
    bool on = false;
    for (int k = 0; k < 3; ++k) on = on || mesh.X(k, v) == 0 || mesh.X(k, v) == 2 + k;
    on_boundary += on;
  }
  EXPECT_EQ(points, on_boundary);
}

TEST_P(SurfaceOfMembrane, UsesEveryVertex) {
  const Mesh mesh = box_mesh(GetParam(), {2, 3, 1}, {2, 3, 1});
  const CollisionSurface surface = surface_of(mesh);
  EXPECT_EQ(static_cast<int>(surface.points.size()), mesh.vertices());
  EXPECT_EQ(static_cast<int>(surface.points.size() + surface.triangles.size()) - static_cast<int>(surface.edges.size()),
            1);
  double area = 0;
  for (const auto& t : surface.triangles) {
    area += (mesh.X.col(t[1]) - mesh.X.col(t[0]))
                .head<2>()
                .reverse()
                .cwiseProduct(Eigen::Vector2d(-1, 1))
                .dot((mesh.X.col(t[2]) - mesh.X.col(t[0])).head<2>()) /
            2;
  }
  EXPECT_NEAR(area, 6, 1e-12);
}

TEST(CollisionSurface, OfLinesAreEdgesCutAtTheirMiddles) {
  for (const Element element : {Element::edge2, Element::edge3}) {
    const Mesh mesh = box_mesh(element, {1, 1, 1}, {5, 1, 1});
    const CollisionSurface surface = surface_of(mesh);
    EXPECT_TRUE(surface.triangles.empty());
    EXPECT_EQ(static_cast<int>(surface.points.size()), mesh.vertices());
    ASSERT_EQ(surface.edges.size(), element == Element::edge2 ? 5u : 10u);
    for (const auto& [a, b] : surface.edges) {
      EXPECT_NEAR((mesh.X.col(a) - mesh.X.col(b)).norm(), element == Element::edge2 ? 0.2 : 0.1, 1e-15);
    }
  }
}

TEST(CollisionSurface, OfSeveralObjectsKeepsThemApart) {
  const Mesh solid = box_mesh(Element::tet4, {1, 1, 1}, {1, 1, 1}),
             cloth = box_mesh(Element::tri3, {1, 1, 1}, {1, 1, 1}),
             rod = box_mesh(Element::edge2, {1, 1, 1}, {2, 1, 1});
  Mesh grains;
  grains.element = Element::point;
  grains.X = Eigen::Matrix3Xd::Random(3, 4);
  grains.cells = {2, 0};
  std::vector<char> moving = all_moving(21);
  moving[3] = 0;
  const CollisionSurface surface = make_surface(
      {{"solid", &solid, 0, 0.1}, {"cloth", &cloth, 9, 0}, {"rod", &rod, 13, 0.02}, {"grains", &grains, 16, 0.3}},
      moving);
  check_surface(surface);
  EXPECT_EQ(surface.points, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15, 16, 18}));
  EXPECT_EQ(surface.object, (std::vector<int>{0, 0, 0, 0, 0, 0, 0, 0, -1, 1, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3, -1}));
  EXPECT_EQ(surface.edges.size(), 18u + 5u + 2u);
  EXPECT_EQ(surface.triangles.size(), 12u + 2u);
  EXPECT_EQ(surface.moving, moving);
  EXPECT_EQ(surface.names, (std::vector<std::string>{"solid", "cloth", "rod", "grains"}));
  EXPECT_EQ(surface.offset(0, 2), 0.1 + 0.02);
  EXPECT_EQ(surface.meet, std::vector<std::vector<char>>(4, std::vector<char>(4, 1)));
  EXPECT_TRUE(std::is_sorted(surface.edges.begin(), surface.edges.end()));
}

TEST(CollisionSurface, TakesATriangleOnce) {
  Mesh mesh = box_mesh(Element::tri3, {1, 1, 1}, {1, 1, 1});
  mesh.cells.insert(mesh.cells.end(), {mesh.cells[2], mesh.cells[1], mesh.cells[0]});
  EXPECT_EQ(surface_of(mesh).triangles.size(), 2u);
}

TEST(CollisionSurface, NamesWhatIsWrongWithAnObject) {
  const Mesh mesh = box_mesh(Element::tri3, {1, 1, 1}, {1, 1, 1});
  Mesh beyond = mesh, folded = mesh, empty = mesh;
  beyond.cells[4] = 7;
  folded.cells[4] = folded.cells[3];
  empty.cells.clear();
  const auto message = [](const std::vector<CollisionObject>& objects) {
    return message_of([&] { make_surface(objects, all_moving(6)); });
  };
  EXPECT_EQ(message({{"", &mesh, 0, 0}}), "collision object 1 has no name");
  EXPECT_EQ(message({{"a", &mesh, 0, 0}, {"a", &mesh, 4, 0}}),
            "two collision objects are named 'a'; give each its own name");
  EXPECT_EQ(message({{"a", &mesh, 0, -0.5}}), "a: the contact radius is -0.5 m; it must be finite and at least 0");
  EXPECT_EQ(message({{"a", &mesh, 3, 0}}), "a: its vertices are 3 to 6 of a system of 6");
  EXPECT_EQ(message({{"a", &mesh, 0, 0}, {"b", &mesh, 2, 0}}), "vertex 2 belongs to both a and b");
  EXPECT_EQ(message({{"a", &beyond, 0, 0}}), "a: cell 1 names vertex 7; there are 4");
  EXPECT_EQ(message({{"a", &folded, 0, 0}}), "a: cell 1 names vertex " + std::to_string(folded.cells[3]) + " twice");
  EXPECT_EQ(message({{"a", &empty, 0, 0}}), "a: no cells to make a collision surface of");
}

TEST(CollisionSurface, NamesWhatIsWrongWithOneMadeByHand) {
  const Mesh mesh = box_mesh(Element::tri3, {1, 1, 1}, {1, 1, 1});
  const CollisionSurface good = make_surface({{"a", &mesh, 0, 0}}, all_moving(4));
  const auto message = [&](const auto& change) {
    CollisionSurface surface = good;
    change(surface);
    return message_of([&] { check_surface(surface); });
  };
  EXPECT_EQ(message([](auto&) {}), "no error");
  EXPECT_EQ(message([](auto& s) { s.moving.pop_back(); }), "4 vertices have an object, 3 tell whether they move");
  EXPECT_EQ(message([](auto& s) { s.names.clear(); }), "1 objects have a radius, 0 a name and 1 a row of meet");
  EXPECT_EQ(message([](auto& s) { s.radius[0] = std::numeric_limits<double>::infinity(); }),
            "a: the contact radius is inf m; it must be finite and at least 0");
  EXPECT_EQ(message([](auto& s) { s.meet[0].clear(); }), "a: its row of meet has 0 entries for 1 objects");
  EXPECT_EQ(message([](auto& s) { s.points.push_back(2); }), "a point of the collision surface stands in it twice");
  EXPECT_EQ(message([](auto& s) { s.object[1] = -1; }), "point 1 of the collision surface belongs to no object");
  EXPECT_EQ(message([](auto& s) { s.edges.push_back({0, 9}); }), "edge 0-9: its ends are not points");
  EXPECT_EQ(message([](auto& s) { s.edges.push_back({3, 3}); }), "edge 3-3 does not join two points of an object");
  EXPECT_EQ(message([](auto& s) {
              s.edges.push_back({s.edges[0][1], s.edges[0][0]});
            }),
            "edge 1-0 stands in the surface twice");
  EXPECT_EQ(message([](auto& s) { s.edges.erase(s.edges.begin()); }).substr(0, 9), "triangle ");
  EXPECT_EQ(message([](auto& s) { s.triangles.push_back(s.triangles[0]); }).substr(0, 9), "triangle ");
  const CollisionSurface two = make_surface({{"a", &mesh, 0, 0}, {"b", &mesh, 4, 0}}, all_moving(8));
  CollisionSurface one_way = two;
  one_way.meet[0][1] = 0;
  EXPECT_EQ(message_of([&] { check_surface(one_way); }), "whether a and b meet is said in two ways");
}

}  // namespace
}  // namespace ergon
