// Every scene in tests/errors/scenes is wrong in one way; NAME.expected holds the whole message. ERGON_WRITE_EXPECTED=1
// writes these files instead.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scenes/builder.h"
#include "scenes/scene_reader.h"
#include "tests/paths.h"

namespace ergon {
namespace {

namespace fs = std::filesystem;

const std::string root = test::source();
const std::string folder = root + "/tests/errors/scenes";

std::vector<std::string> bad_scenes() {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml") out.push_back(entry.path().stem().string());
  std::sort(out.begin(), out.end());
  return out;
}

// What the message says on this machine, without where the sources lie.
std::string without(std::string text, const std::string& part) {
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part)) text.erase(at, part.size());
  return text;
}

std::string message_of(const std::string& name) {
  const KernelSource none = [](const std::vector<KernelRequest>& requests) -> std::vector<Kernel> {
    throw std::logic_error("the kernel of " + requests.front().energy->name +
                           " was asked for before the scene was found to be wrong");
  };
  try {
    const Scene scene = read_scene(folder + "/" + name + ".toml");
    build_scene(scene, Catalogue({root + "/energies"}), none);
  } catch (const SourceError& error) {
    return without(without(error.what(), folder + "/"), root + "/") + "\n";
  }
  return "no error\n";
}

class bad_scene : public testing::TestWithParam<std::string> {};

TEST_P(bad_scene, gets_the_expected_message) {
  const std::string expected_file = folder + "/" + GetParam() + ".expected";
  const std::string message = message_of(GetParam());
  if (std::getenv("ERGON_WRITE_EXPECTED") != nullptr) std::ofstream(expected_file) << message;
  std::ifstream in(expected_file);
  std::ostringstream expected;
  expected << in.rdbuf();
  EXPECT_EQ(message, expected.str());
}

INSTANTIATE_TEST_SUITE_P(scenes, bad_scene, testing::ValuesIn(bad_scenes()),
                         [](const auto& info) { return info.param; });

TEST(bad_scenes, are_many_and_each_has_its_message) {
  EXPECT_GE(bad_scenes().size(), 20u);
  for (const std::string& name : bad_scenes()) EXPECT_NE(message_of(name), "no error\n") << name;
}

}  // namespace
}  // namespace ergon
