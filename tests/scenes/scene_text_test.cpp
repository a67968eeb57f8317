#include "scenes/scene_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "scenes/scene_reader.h"
#include "tests/runtime/temporary_folder.h"

namespace ergon {
namespace {

const char* const beam = R"(
[time]
dt = "10 ms"
steps = 3
[[object]]
name = "beam"
mesh = "meshes/beam.msh"
density = 1000
energy = [{ law = "neo_hookean", E = "1 MPa", nu = 0.3 }, { law = "../my.energy" }]
[[object]]
name = "mass"
box = { size = [1, 1, 1], cells = [1, 1, 1] }
element = "tet4"
density = 500
energy = [{ law = "stable_neo_hookean", E = 1e5, nu = 0.3 }]
)";

const Place here{"here", 3, 5};

class SceneTextTest : public testing::Test {
 protected:
  SceneTextTest() {
    std::filesystem::create_directories(folder_.path("scenes"));
    file_ = folder_.file("scenes/beam.toml", beam);
  }
  static void set(SceneText& text, const std::string& change) {
    const auto [path, value] = read_change(change, here);
    text.set(path, *value.get("value"), here);
  }
  std::string error(const std::string& change) const {
    SceneText text(file_);
    try {
      set(text, change);
    } catch (const SourceError& bad) {
      return bad.what();
    }
    return "no error";
  }
  TemporaryFolder folder_;
  std::string file_;
};

// What is added stands nowhere in the text: none of it may be lost.
TEST_F(SceneTextTest, AddsSeveralValuesToOneTable) {
  SceneText text(file_);
  for (const char* change : {"time.integrator=bdf2", "time.tolerance=1e-5", "time.min_dt=1e-6", "solver.tolerance=0.01",
                             "solver.precision=float", "start.seed=7", "start.noise=0.5"})
    set(text, change);
  const Scene scene = text.read();
  EXPECT_EQ(scene.time.integrator, "bdf2");
  EXPECT_EQ(scene.time.tolerance, 1e-5);
  EXPECT_EQ(scene.time.min_dt, 1e-6);
  EXPECT_EQ(scene.solver.tolerance, 0.01);
  EXPECT_EQ(scene.solver.precision, "float");
  EXPECT_EQ(scene.start.seed, 7);
  EXPECT_EQ(scene.start.noise, 0.5);
}

TEST_F(SceneTextTest, ReplacesAndAddsValuesByPath) {
  SceneText text(file_);
  set(text, "time.dt=0.5 ms");
  set(text, "object.beam.energy.0.E=2e6");
  set(text, "object.1.density=700");
  set(text, "object.mass.box.cells=[2, 3, 4]");
  set(text, "solver.tolerance=1e-3");
  const Scene scene = text.read();
  EXPECT_EQ(scene.time.dt, 0.5e-3);
  EXPECT_EQ(scene.objects[0].energies[0].params.at("E").components[0].value, 2e6);
  EXPECT_EQ(scene.objects[1].density, 700);
  EXPECT_EQ(scene.objects[1].box->cells, (std::array{2, 3, 4}));
  EXPECT_EQ(scene.solver.tolerance, 1e-3);
  // Written and read again it is the same scene.
  const Scene again = read_scene_text(text.text(), file_);
  EXPECT_EQ(again.time.dt, 0.5e-3);
  EXPECT_EQ(again.objects[0].energies[0].params.at("E").components[0].value, 2e6);
  EXPECT_EQ(again.objects[1].box->cells, (std::array{2, 3, 4}));
  EXPECT_EQ(again.objects[0].energies[0].law, "neo_hookean");
}

TEST_F(SceneTextTest, KnowsTheFilesThatItNames) {
  SceneText text(file_);
  const std::string mesh = folder_.path("scenes/meshes/beam.msh"), law = folder_.path("my.energy");
  EXPECT_EQ(text.files(), (std::vector{mesh, law}));
  text.rename_files({{mesh, "../inputs/beam.msh"}});
  const Scene scene = text.read();
  EXPECT_EQ(scene.objects[0].mesh, "../inputs/beam.msh");
  EXPECT_EQ(scene.objects[0].energies[1].law, "../my.energy");
}

TEST_F(SceneTextTest, SaysWhereAPathLeadsNowhere) {
  EXPECT_EQ(
      error("object.bean.density=3"),
      "here:3:5: 'object.bean.density': there is no 'bean' here; give a number from 0 to 1 or a name: beam, mass; "
      "did you mean 'beam'?");
  EXPECT_EQ(error("object.2.density=3"),
            "here:3:5: 'object.2.density': there is no '2' here; give a number from 0 to 1 or a name: beam, mass");
  EXPECT_EQ(error("time.dt.x=3"), "here:3:5: 'time.dt.x': there is a value before 'x', not a table");
  EXPECT_EQ(error("object.0=3"), "here:3:5: 'object.0': '0' is not in a table; a path ends at a key");
  EXPECT_EQ(error("time..dt=3"), "here:3:5: 'time..dt' is not a path of keys joined by dots");
  EXPECT_EQ(error("time.dt"), "here:3:5: 'time.dt' is not PATH=VALUE, as time.dt=0.01");
}

TEST_F(SceneTextTest, ValuesAreReadAsAnyOther) {
  SceneText text(file_);
  set(text, "time.dt=-1");
  EXPECT_THROW(text.read(), SourceError);
  SceneText other(file_);
  set(other, "time.dtt=1");
  try {
    other.read();
    FAIL();
  } catch (const SourceError& bad) {
    EXPECT_THAT(bad.what(), testing::HasSubstr("unknown key 'dtt' in [time]; did you mean 'dt'?"));
  }
}

}  // namespace
}  // namespace ergon
