#include "scenes/catalogue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "runtime/error.h"
#include "symbolic/energy.h"
#include "tests/paths.h"

namespace ergon {
namespace {

namespace fs = std::filesystem;

const std::string shipped = test::source("/energies");

class catalogue : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  std::string write(const std::string& name) {
    fs::create_directories((folder / name).parent_path());
    std::ofstream(folder / name) << "";
    return (folder / name).string();
  }
  fs::path folder = fs::temp_directory_path() / ("ergon_catalogue_" + std::to_string(getpid()));
};

std::string message_of(const auto& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(catalogue, finds_by_name) {
  Catalogue energies({shipped});
  EXPECT_EQ(energies.file_of("spring", "", {}), shipped + "/rods/spring.energy");
  EXPECT_THAT(energies.names(),
              testing::IsSupersetOf({"gravity", "log_barrier:half_space", "log_barrier:point_edge:offset", "inertia",
                                     "stable_neo_hookean"}));
}

TEST_F(catalogue, names_are_those_that_the_files_declare) {
  Catalogue energies({shipped});
  for (const std::string& name : energies.names()) EXPECT_EQ(energies.read_complete(name, "", {}).name, name);
}

TEST_F(catalogue, finds_by_path_relative_to_the_scene) {
  std::string file = write("laws/mine.energy");
  Catalogue energies({shipped});
  EXPECT_EQ(energies.file_of("laws/mine.energy", folder.string(), {}), file);
  EXPECT_EQ(energies.file_of(file, "/elsewhere", {}), file);
  EXPECT_EQ(message_of([&] {
              energies.file_of("laws/his.energy", folder.string(), {"a.toml", 2, 3});
            }),
            "a.toml:2:3: there is no energy file '" + folder.string() +
                "/laws/his.energy' (paths are relative to the scene file)");
  EXPECT_EQ(message_of([&] {
              energies.file_of("laws/mime.energy", folder.string(), {"a.toml", 2, 3});
            }),
            "a.toml:2:3: there is no energy file '" + folder.string() +
                "/laws/mime.energy' (paths are relative to the scene file); did you mean 'mine.energy'?");
  EXPECT_EQ(message_of([&] {
              energies.file_of("mine", (folder / "laws").string(), {"a.toml", 2, 3});
            }),
            "a.toml:2:3: there is no energy 'mine' in " + shipped +
                "; that of the file mine.energy is named with the ending: 'mine.energy'");
}

TEST_F(catalogue, an_earlier_folder_hides_a_later_one) {
  std::string own = write("spring.energy");
  EXPECT_EQ(Catalogue({folder.string(), shipped}).file_of("spring", "", {}), own);
  EXPECT_NE(Catalogue({shipped, folder.string()}).file_of("spring", "", {}), own);
}

TEST_F(catalogue, refuses_one_name_twice_and_folders_that_are_not_there) {
  std::string a = write("a/law.energy"), b = write("b/law.energy");
  EXPECT_EQ(message_of([&] { Catalogue({folder.string()}); }), "two energies are named 'law': " + a + " and " + b);
  EXPECT_EQ(message_of([&] { Catalogue({"/no/such"}); }), "/no/such: there is no such folder of energies");
}

TEST_F(catalogue, composes_barriers_with_distances) {
  const Catalogue energies({shipped});
  std::ofstream(folder / "mine.energy") << "barrier mine\nparam k N/m\nvalue k*gap2\n";
  EXPECT_EQ(energies.read_complete("mine.energy:rope:offset", folder.string(), {}).name, "mine:rope:offset");
  EXPECT_EQ(energies.read("log_barrier", "", {}).kind, Energy::Kind::barrier);
  auto message = [&](const std::string& name) {
    return message_of([&] { energies.read_complete(name, "", {"a.toml", 2, 3}); });
  };
  EXPECT_EQ(
      message("log_barrier"),
      "a.toml:2:3: log_barrier is a barrier over a gap; name the distance with it, as in "
      "log_barrier:point_triangle (known are edge_edge, half_space, point_edge, point_point, point_triangle, rope)");
  EXPECT_EQ(message("rope"), "a.toml:2:3: rope is a distance; name a barrier with it, as in log_barrier:rope");
  EXPECT_EQ(message("spring:rope"),
            "a.toml:2:3: spring is not a barrier; only a law that begins with `barrier` is composed with a distance");
  EXPECT_EQ(message("log_barrier:ropes"),
            "a.toml:2:3: there is no distance 'ropes'; known are edge_edge, half_space, point_edge, point_point, "
            "point_triangle, rope; did you mean 'rope'?");
  EXPECT_EQ(message("log_barrier:rope:thick"),
            "a.toml:2:3: expected LAW:DISTANCE or LAW:DISTANCE:offset, found 'log_barrier:rope:thick'");
}

TEST_F(catalogue, suggests_the_nearest_name) {
  EXPECT_THAT(message_of([&] {
                Catalogue({shipped}).file_of("stable_neohookean", "", {"a.toml", 2, 3});
              }),
              testing::AllOf(testing::StartsWith("a.toml:2:3: there is no energy 'stable_neohookean' in "),
                             testing::EndsWith("; did you mean 'stable_neo_hookean'?")));
}

}  // namespace
}  // namespace ergon
