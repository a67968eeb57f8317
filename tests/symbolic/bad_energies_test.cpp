// Every file in tests/errors/energies is refused with exactly the message in the .expected file beside it.
#include <gtest/gtest.h>

#include "symbolic/energy.h"
#include "tests/symbolic/energy_files.h"

namespace ergon {
namespace {

class BadEnergy : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(BadEnergy, IsRefusedWithTheExpectedMessage) {
  std::filesystem::path expected = GetParam();
  expected.replace_extension(".expected");
  ASSERT_TRUE(std::filesystem::exists(expected));
  std::string message = "no error";
  try {
    parse_energy(test::contents(GetParam()), GetParam().filename().string());
  } catch (const SourceError& error) {
    message = error.what();
  }
  EXPECT_EQ(message + "\n", test::contents(expected));
}

INSTANTIATE_TEST_SUITE_P(Files, BadEnergy, testing::ValuesIn(test::energy_files("tests/errors/energies")),
                         [](const auto& info) { return info.param.stem().string(); });

TEST(BadEnergies, CoverManyMistakes) { EXPECT_GE(test::energy_files("tests/errors/energies").size(), 70u); }

TEST(BadEnergies, MissingFileNamesIt) {
  try {
    read_energy("/no/such/file.energy");
    FAIL();
  } catch (const SourceError& error) {
    EXPECT_STREQ(error.what(), "/no/such/file.energy: cannot open the energy file");
  }
}

TEST(BadEnergies, EmptyFilesAndFoldersAreNoEnergies) {
  auto message = [](const std::string& file) -> std::string {
    try {
      read_energy(file);
    } catch (const SourceError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message("/dev/null"),
            "/dev/null: expected `density NAME GEOMETRY`, `energy NAME STENCIL`, `barrier NAME` or `distance NAME "
            "STENCIL`, found an empty file");
  EXPECT_EQ(message("/"), "/: cannot read the energy file");
}

// Whatever is cut off or changed in a sound file, the answer is an energy or an error with a place.
TEST(BadEnergies, CutAndChangedFilesAreReadOrRefused) {
  int refused = 0, read = 0;
  auto attempt = [&](const std::string& text) {
    try {
      parse_energy(text, "changed.energy");
      ++read;
    } catch (const SourceError&) {
      ++refused;
    }
  };
  const std::string signs = "()[]'^*/+-,;=<>#.\n \t0aF\xC3";
  for (const auto& file : test::energy_files("energies")) {
    const std::string text = test::contents(file);
    for (size_t length = 0; length < text.size(); length += 3) attempt(text.substr(0, length));
    for (size_t at = 0; at < text.size(); at += 2) {
      std::string changed = text;
      changed[at] = signs[(at * 7 + text.size()) % signs.size()];
      attempt(changed);
    }
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(read, 100);
}

}  // namespace
}  // namespace ergon
