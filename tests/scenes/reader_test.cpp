#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>

#include "scenes/scene_reader.h"
#include "tests/paths.h"

namespace ergon {
namespace {

const std::string minimal = R"(
[time]
dt = 0.01
steps = 3
[[object]]
name = "block"
box = { size = [1, 1, 1], cells = [1, 2, 3] }
element = "tet4"
density = 1000
energy = [{ law = "stable_neo_hookean", E = "0.5 MPa", nu = 0.4 }]
)";

TEST(reader, fills_in_defaults) {
  Scene scene = read_scene_text(minimal, "a.toml");
  EXPECT_EQ(scene.gravity, (Vector3{0, 0, -9.81}));
  EXPECT_EQ(scene.time.dt, 0.01);
  EXPECT_EQ(scene.time.steps, 3);
  EXPECT_FALSE(scene.time.end.has_value());
  EXPECT_TRUE(scene.grounds.empty());
  ASSERT_EQ(scene.objects.size(), 1u);
  const SceneObject& block = scene.objects[0];
  EXPECT_EQ(block.name, "block");
  EXPECT_EQ(block.box->cells, (std::array<int, 3>{1, 2, 3}));
  EXPECT_EQ(block.element, "tet4");
  EXPECT_EQ(block.scale, 1);
  EXPECT_TRUE(block.fixed.empty());
}

TEST(reader, keeps_params_as_written_with_unit_and_place) {
  Scene scene = read_scene_text(minimal, "a.toml");
  const ParamValue& E = scene.objects[0].energies[0].params.at("E");
  ASSERT_EQ(E.components.size(), 1u);
  EXPECT_DOUBLE_EQ(E.components[0].value, 5e5);
  EXPECT_EQ(to_string(*E.components[0].unit), "Pa");
  EXPECT_EQ(E.components[0].text, "0.5 MPa");
  EXPECT_EQ(to_string(E.key_place), "a.toml:10:41");
  EXPECT_FALSE(scene.objects[0].energies[0].params.at("nu").components[0].unit.has_value());
}

TEST(reader, brings_units_to_SI) {
  Scene scene = read_scene_text(R"(
gravity = ["0 m/s^2", 0, "-981 cm/s^2"]
[time]
dt = "10 ms"
end = "2 s"
[[object]]
name = "block"
box = { size = ["10 cm", "1mm", 1e-1], cells = [1, 1, 1] }
element = "tet4"
rotate = ["90 deg", 0, 0]
density = "1 g/cm^3"
velocity = ["36 km/h", 0, 0]
energy = [{ law = "a", R = [[1, 2, 3], [4, 5, "6 mm"]] }]
fixed = [{ max = ["1 mm", inf, inf] }]
[[ground]]
normal = [0, 1, 0]
mu = 0.5
stiffness = "2 kN/m"
)",
                                "a.toml");
  EXPECT_DOUBLE_EQ(scene.gravity[2], -9.81);
  EXPECT_DOUBLE_EQ(scene.time.dt, 0.01);
  EXPECT_DOUBLE_EQ(*scene.time.end, 2);
  const SceneObject& block = scene.objects[0];
  EXPECT_DOUBLE_EQ(block.box->size[0], 0.1);
  EXPECT_DOUBLE_EQ(block.box->size[1], 0.001);
  EXPECT_DOUBLE_EQ(block.rotate[0], std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(block.density, 1000);
  EXPECT_DOUBLE_EQ(block.velocity[0], 10);
  EXPECT_EQ(block.fixed[0].min[0], -INFINITY);
  EXPECT_DOUBLE_EQ(block.fixed[0].max[0], 0.001);
  std::vector<double> by_columns;
  for (const WrittenNumber& q : block.energies[0].params.at("R").components) by_columns.push_back(q.value);
  EXPECT_THAT(by_columns, testing::ElementsAre(1, 4, 2, 5, 3, testing::DoubleEq(6e-3)));
  EXPECT_DOUBLE_EQ(*scene.grounds[0].stiffness, 2000);
}

TEST(reader, reports_the_first_mistake_in_the_text) {
  try {
    read_scene_text("[time]\ndt = 1\nzz = 1\naa = 1\n", "a.toml");
    FAIL() << "no error";
  } catch (const SourceError& error) {
    EXPECT_STREQ(error.what(), "a.toml:3:1: unknown key 'zz' in [time]");
  }
}

TEST(reader, says_that_a_file_cannot_be_read) {
  try {
    read_scene("/no/such/scene.toml");
    FAIL() << "no error";
  } catch (const SourceError& error) {
    EXPECT_STREQ(error.what(), "/no/such/scene.toml: cannot read this scene file: No such file or directory");
  }
  EXPECT_THROW(read_scene(test::source("/scenes")), SourceError);
}

TEST(reference, is_what_the_reader_reads) {
  const std::string path = test::source("/scenes/README.md");
  if (std::getenv("ERGON_WRITE_EXPECTED") != nullptr) std::ofstream(path) << scene_reference_markdown();
  std::ifstream in(path);
  std::ostringstream file;
  file << in.rdbuf();
  EXPECT_EQ(file.str(), scene_reference_markdown()) << "ERGON_WRITE_EXPECTED=1 writes it again";
}

}  // namespace
}  // namespace ergon
