// Reading .obj, .stl and .ply.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "runtime/error.h"
#include "runtime/mesh/mesh_import.h"
#include "tests/paths.h"
#include "tests/runtime/temporary_folder.h"

namespace ergon {
namespace {

constexpr char kTetObj[] =
    "# a tetrahedron\n"
    "o tet\n"
    "v 0 0 0\n"
    "v 1 0 0 1.0\n"
    "v 0 +1 0\n"
    "v 0 0 1e0\n"
    "vn 0 0 1\n"
    "f 1 3 2\n"
    "f 1/1 2/2 4/3\n"
    "f 2//1 3//1 -1\n"
    "f 1 4 3  # last\n";

const std::vector<int> kTetTriangles{0, 2, 1, 0, 1, 3, 1, 2, 3, 0, 3, 2};

std::string with(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

// Bytes of a number, lowest first.
template <class Number>
std::string bytes(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

class mesh_surface : public ::testing::Test {
 protected:
  // The error of reading `content`, without the folder.
  std::string error_of(const std::string& name, const std::string& content) {
    const std::string path = folder_.file(name, content);
    try {
      read_surface(path);
    } catch (const InputError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.substr(0, path.size()), path);
      return name + message.substr(path.size());
    }
    return "no error";
  }
  Mesh read(const std::string& name, const std::string& content) { return read_surface(folder_.file(name, content)); }

  TemporaryFolder folder_;
};

TEST_F(mesh_surface, obj_is_read_with_all_ways_to_name_a_corner) {
  const Mesh mesh = read("tet.obj", kTetObj);
  EXPECT_EQ(mesh.element, Element::tri3);
  EXPECT_EQ(mesh.source, folder_.path("tet.obj"));
  ASSERT_EQ(mesh.vertices(), 4);
  EXPECT_EQ(mesh.cells, kTetTriangles);
  EXPECT_EQ(mesh.X.col(2), Eigen::Vector3d(0, 1, 0));
}

TEST_F(mesh_surface, windows_line_ends_and_a_missing_last_one_do_not_matter) {
  std::string text = kTetObj;
  for (size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2) text.insert(i, "\r");
  text.resize(text.size() - 2);
  EXPECT_EQ(read("tet.OBJ", text).cells, kTetTriangles);
}

TEST_F(mesh_surface, equal_vertices_are_merged_and_unused_ones_left_out) {
  const Mesh mesh = read("two.obj",
                         "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 0 0\nv 1 0 0\nv 0 0 1\n"
                         "v 5 5 5\nv 5 5 5\nf 2 3 4\nf 5 7 6\nf 2 8 9\n");
  EXPECT_EQ(mesh.vertices(), 4);
  EXPECT_EQ(mesh.cells, (std::vector<int>{0, 1, 2, 0, 3, 1}));
}

TEST_F(mesh_surface, a_quadrilateral_is_cut_inside) {
  // Vertex 3 dents the quadrilateral: only the diagonal from it stays inside.
  const Mesh mesh = read("dent.obj", "v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 1 2 3 4\n");
  EXPECT_EQ(mesh.cells, (std::vector<int>{0, 1, 2, 0, 2, 3}));
  const Mesh turned = read("turned.obj", "v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 4 1 2 3\n");
  EXPECT_EQ(turned.cell_count(), 2);
  for (int c = 0; c < 2; ++c) {
    const int* v = &turned.cells[static_cast<size_t>(3 * c)];
    const Eigen::Vector3d a = turned.X.col(v[1]) - turned.X.col(v[0]), b = turned.X.col(v[2]) - turned.X.col(v[0]);
    EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0.1);
  }
}

TEST_F(mesh_surface, obj_errors_name_their_line) {
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "v 0 +1 0", "v 0 nan 0")),
            "a.obj:5: vertex 3: y is 'nan'; it must be finite");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "v 0 +1 0", "v 0 -inf 0")),
            "a.obj:5: vertex 3: y is '-inf'; it must be finite");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "v 0 +1 0", "v 0 1e999 0")),
            "a.obj:5: vertex 3: y is '1e999'; it must be finite");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "v 0 +1 0", "v 0 1,5 0")),
            "a.obj:5: vertex 3: y is '1,5', which is not a number");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "v 0 +1 0", "v 0 1")), "a.obj:5: vertex 3: z is missing");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "f 1 3 2", "f 1 5 2")),
            "a.obj:8: a face names vertex 5, but the file has 4 (counted from 1)");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "f 1 3 2", "f 1 99999999999 2")),
            "a.obj:8: a face names vertex 99999999999, but the file has 4 (counted from 1)");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "f 1 3 2", "f 1 -5 2")),
            "a.obj:8: the face names vertex -5, which does not exist");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "f 1 3 2", "f 0 1 2")),
            "a.obj:8: the face names vertex 0, which does not exist");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "f 1 3 2", "f 1 x 2")),
            "a.obj:8: vertex number 2 of the face is 'x', which is not a whole number");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "f 1 3 2", "f 1 3")),
            "a.obj:8: a face has 2 vertices; export the surface as triangles");
  EXPECT_EQ(error_of("a.obj", with(kTetObj, "o tet", "ob tet")), "a.obj:2: unknown keyword 'ob'");
  EXPECT_EQ(error_of("a.obj", ""), "a.obj: holds no triangles");
  EXPECT_EQ(error_of("a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 1\n"), "a.obj: holds no triangles");
}

TEST_F(mesh_surface, files_that_cannot_be_read_say_why) {
  const auto message = [](const std::string& path) -> std::string {
    try {
      read_surface(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  const std::string missing = folder_.path("missing.obj");
  EXPECT_EQ(message(missing), missing + ": cannot be opened: No such file or directory");
  const std::string folder = folder_.path("folder.obj");
  std::filesystem::create_directory(folder);
  EXPECT_EQ(message(folder), folder + ": cannot be read: Is a directory");
  EXPECT_EQ(message("bunny.off"), "bunny.off: unknown surface format '.off'; known are .obj, .stl and .ply");
}

constexpr char kStl[] =
    "solid one\n"
    " facet normal 0 0 1\n"
    "  outer loop\n"
    "   vertex 0 0 0\n"
    "   vertex 1 0 0\n"
    "   vertex 0 1 0\n"
    "  endloop\n"
    " endfacet\n"
    " facet normal 0 0 1\n"
    "  outer loop\n"
    "   vertex 1 0 0\n"
    "   vertex 1 1 0\n"
    "   vertex 0 1 0\n"
    "  endloop\n"
    " endfacet\n"
    "endsolid one\n";

TEST_F(mesh_surface, text_stl_is_read_and_merged) {
  const Mesh mesh = read("two.stl", kStl);
  EXPECT_EQ(mesh.vertices(), 4);
  EXPECT_EQ(mesh.cells, (std::vector<int>{0, 1, 2, 1, 3, 2}));
}

TEST_F(mesh_surface, text_stl_errors_name_their_line) {
  EXPECT_EQ(error_of("a.stl", with(kStl, "vertex 0 1 0", "vertex 0 inf 0")), "a.stl:6: y is 'inf'; it must be finite");
  EXPECT_EQ(error_of("a.stl", with(kStl, "outer loop", "outer lop")), "a.stl:3: expected 'outer loop'");
  EXPECT_EQ(error_of("a.stl", with(kStl, " facet normal 0 0 1", "faced")), "a.stl:2: expected 'facet', found 'faced'");
  EXPECT_EQ(error_of("a.stl", std::string(kStl).substr(0, 59)), "a.stl:4: the file ends inside a facet");
  EXPECT_EQ(error_of("a.stl", ""), "a.stl: 0 bytes are neither a text nor a binary STL file");
  EXPECT_EQ(error_of("a.stl", "solid nothing\nendsolid\n"), "a.stl: holds no triangles");
}

std::string binary_stl(const std::vector<float>& coordinates) {
  std::string data(80, ' ');
  data.replace(0, 5, "solid");  // as some programs do
  data += bytes(static_cast<std::uint32_t>(coordinates.size() / 9));
  for (size_t i = 0; i < coordinates.size(); ++i) {
    if (i % 9 == 0) data += std::string(12, '\0');
    data += bytes(coordinates[i]);
    if (i % 9 == 8) data += std::string(2, '\0');
  }
  return data;
}

TEST_F(mesh_surface, binary_stl_is_told_from_text_by_its_length) {
  const std::vector<float> coordinates{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.25F};
  const Mesh mesh = read("two.stl", binary_stl(coordinates));
  EXPECT_EQ(mesh.vertices(), 5);
  EXPECT_EQ(mesh.cells, (std::vector<int>{0, 1, 2, 1, 3, 4}));
  EXPECT_EQ(mesh.X.col(4), Eigen::Vector3d(0, 1, 0.25));
}

TEST_F(mesh_surface, binary_stl_errors_name_the_triangle) {
  std::vector<float> coordinates{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, NAN, 0, 0, 1, 0};
  EXPECT_EQ(error_of("a.stl", binary_stl(coordinates)),
            "a.stl: triangle 2: vertex 2 is (1, nan, 0); it must be finite");
  std::string cut = binary_stl(coordinates).substr(0, 180);
  cut.replace(0, 5, "     ");
  EXPECT_EQ(error_of("a.stl", cut), "a.stl: announces 2 triangles, which take 184 bytes, but has only 180");
}

constexpr char kPly[] =
    "ply\n"
    "format ascii 1.0\n"
    "comment two triangles\n"
    "element vertex 4\n"
    "property float x\n"
    "property float y\n"
    "property double z\n"
    "property uchar red\n"
    "element face 2\n"
    "property list uchar int vertex_indices\n"
    "end_header\n"
    "0 0 0 255\n"
    "1 0 0 255\n"
    "0 1 0 255\n"
    "1 1 0.5 255\n"
    "3 0 1 2\n"
    "3 1 3 2\n";

TEST_F(mesh_surface, text_ply_is_read) {
  const Mesh mesh = read("two.ply", kPly);
  EXPECT_EQ(mesh.cells, (std::vector<int>{0, 1, 2, 1, 3, 2}));
  EXPECT_EQ(mesh.X.col(3), Eigen::Vector3d(1, 1, 0.5));
}

TEST_F(mesh_surface, text_ply_errors_name_their_line) {
  EXPECT_EQ(error_of("a.ply", with(kPly, "1 1 0.5", "1 1 nan")), "a.ply:15: vertex 3: z is 'nan'; it must be finite");
  EXPECT_EQ(error_of("a.ply", with(kPly, "3 1 3 2", "3 1 4 2")),
            "a.ply:17: a face names vertex 4, but the file has 4 (counted from 0)");
  EXPECT_EQ(error_of("a.ply", with(kPly, "element face 2", "element face 3")), "a.ply:17: the file ends before face 2");
  EXPECT_EQ(error_of("a.ply", with(kPly, "property double z\n", "")), "a.ply: the vertices have no property 'z'");
  EXPECT_EQ(error_of("a.ply", with(kPly, "vertex_indices", "corners")),
            "a.ply: the faces have no property 'vertex_indices'");
  EXPECT_EQ(error_of("a.ply", with(kPly, "property float x", "property half x")),
            "a.ply:5: unknown number type 'half'");
  EXPECT_EQ(error_of("a.ply", with(kPly, "ply", "off")), "a.ply:1: expected 'ply'");
  EXPECT_EQ(error_of("a.ply", "ply\nformat ascii 1.0\n"), "a.ply:2: the file ends inside the header");
}

std::string binary_ply(bool big_endian) {
  std::string text(kPly);
  text.resize(text.find("end_header\n") + 11);
  text = with(text, "ascii", big_endian ? "binary_big_endian" : "binary_little_endian");
  const auto put = [&](auto number) {
    std::string data = bytes(number);
    if (big_endian) std::reverse(data.begin(), data.end());
    text += data;
  };
  const double points[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5}};
  for (const auto& p : points) {
    put(static_cast<float>(p[0]));
    put(static_cast<float>(p[1]));
    put(p[2]);
    put(static_cast<std::uint8_t>(255));
  }
  const std::int32_t faces[2][3] = {{0, 1, 2}, {1, 3, 2}};
  for (const auto& face : faces) {
    put(static_cast<std::uint8_t>(3));
    for (const std::int32_t corner : face) put(corner);
  }
  return text;
}

TEST_F(mesh_surface, binary_ply_of_both_byte_orders_is_read) {
  for (const bool big_endian : {false, true}) {
    const Mesh mesh = read("two.ply", binary_ply(big_endian));
    EXPECT_EQ(mesh.cells, (std::vector<int>{0, 1, 2, 1, 3, 2}));
    EXPECT_EQ(mesh.X.col(3), Eigen::Vector3d(1, 1, 0.5));
  }
}

TEST_F(mesh_surface, binary_ply_errors_name_the_record) {
  std::string data = binary_ply(false);
  EXPECT_EQ(error_of("a.ply", data.substr(0, data.size() - 1)), "a.ply: the file ends inside face 1");
  data.replace(data.size() - 4, 4, bytes(std::int32_t{-7}));
  EXPECT_EQ(error_of("a.ply", data), "a.ply: face 1: a face names vertex -7, but the file has 4 (counted from 0)");
  data = binary_ply(false);
  const size_t body = data.find("end_header\n") + 11;
  data.replace(body + 17 + 8, 8, bytes(std::nan("")));
  EXPECT_EQ(error_of("a.ply", data), "a.ply: vertex 1: z is nan; it must be finite");
}

TEST_F(mesh_surface, damaged_files_give_an_error_or_a_sound_mesh) {
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.obj", kTetObj},
      {"a.stl", kStl},
      {"b.stl", binary_stl({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.25F})},
      {"a.ply", kPly},
      {"b.ply", binary_ply(false)}};
  std::mt19937 generator(1);
  int errors = 0, meshes = 0;
  for (int trial = 0; trial < 500; ++trial) {
    auto [name, content] = files[static_cast<size_t>(trial) % files.size()];
    for (unsigned changes = generator() % 4; changes > 0; --changes) {
      content[generator() % content.size()] = static_cast<char>(generator() % 256);
    }
    if (generator() % 3 == 0) content.resize(generator() % content.size());
    try {
      const Mesh mesh = read(name, content);
      ++meshes;
      ASSERT_TRUE(mesh.X.allFinite());
      for (const int v : mesh.cells) ASSERT_TRUE(v >= 0 && v < mesh.vertices());
    } catch (const InputError&) {
      ++errors;
    }
  }
  EXPECT_GT(errors, 125);
  EXPECT_GT(meshes, 50);
}

TEST_F(mesh_surface, the_bunny_is_as_its_header_says) {
  const Mesh mesh = read_surface(test::source("/scenes/meshes/bunny.obj"));
  EXPECT_EQ(mesh.vertices(), 1839);
  EXPECT_EQ(mesh.cell_count(), 3674);
  EXPECT_EQ(mesh.X(0, 0), 1.301895);
}

}  // namespace
}  // namespace ergon
