// Finding a kernel without generating it: what the key sees, and notes that are damaged, foreign or out of date.

#include "codegen/front_key.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <thread>

#include <unistd.h>

#include "codegen/cache.h"
#include "codegen/compile.h"
#include "tests/paths.h"

namespace ergon {
namespace {

namespace fs = std::filesystem;

const char* const kLaw = R"(energy two_cases edge
cite   Hooke 1678. De Potentia Restitutiva.
dof    x0 x1 m
param  k N/m (0, inf) stiffness
case   long  d2 = norm2(x1 - x0)
case   flat  d2 = (x1[0] - x0[0])^2
value  k/2*d2
)";

TEST(FrontKey, SeesAllThatDeterminesTheSource) {
  const Energy law = parse_energy(kLaw, "two_cases.energy");
  std::set<std::string> keys = {
      front_key(law, {"long", 4, true, "g++"}),     front_key(law, {"flat", 4, true, "g++"}),
      front_key(law, {"long", 8, true, "g++"}),     front_key(law, {"long", 4, false, "g++"}),
      front_key(law, {"long", 4, true, "clang++"}), front_key(law, {"long", 4, true, "g++"}, "another program")};
  Energy commented = parse_energy(std::string("# a spring\n") + kLaw, "two_cases.energy");
  keys.insert(front_key(commented, {"long", 4, true, "g++"}));
  // An energy that a program changed after it was read has the text of the other.
  Energy halved = law;
  halved.value = halved.value->arguments[0];
  keys.insert(front_key(halved, {"long", 4, true, "g++"}));
  Energy bounded = law;
  bounded.symbols[2].range.upper = 1;
  keys.insert(front_key(bounded, {"long", 4, true, "g++"}));
  EXPECT_EQ(keys.size(), 9u);
  // Where the file lies does not matter.
  EXPECT_TRUE(keys.contains(front_key(parse_energy(kLaw, "elsewhere.energy"), {"long", 4, true, "g++"})));
}

TEST(FrontKey, NamesTheLibrariesThatTheProgramIsMadeOf) {
  FILE* hashes = popen(("cd '" + test::built() + "' && sha256sum libergon_codegen.a libergon_symbolic.a").c_str(), "r");
  ASSERT_NE(hashes, nullptr);
  std::array<char, 512> text{};
  const size_t size = std::fread(text.data(), 1, text.size(), hashes);
  EXPECT_EQ(pclose(hashes), 0);
  const std::string program = kProgramIdentity;
  ASSERT_EQ(program.size(), 129u);
  const std::string found(text.data(), size);
  EXPECT_THAT(found, ::testing::HasSubstr(program.substr(0, 64) + "  libergon_codegen.a"));
  EXPECT_THAT(found, ::testing::HasSubstr(program.substr(65) + "  libergon_symbolic.a"));
}

TEST(FrontKey, NoteReadsBackAsItWasWritten) {
  KernelNote note{"spring-w4-0123", 4321, {1, 2, 3, 4, 5, 6, 7, 8, 9, 10}};
  const std::string text = to_text(note, "front");
  const auto read = note_from(text, "front");
  ASSERT_TRUE(read);
  EXPECT_EQ(to_text(*read, "front"), text);
  EXPECT_FALSE(note_from(text, "other"));
  EXPECT_FALSE(note_from(text.substr(0, text.size() - 4), "front"));
}

class FoundByNote : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("ergon-front-key-test-" + std::to_string(getpid()));
    fs::remove_all(folder);
    options.cache = folder;
  }
  void TearDown() override { fs::remove_all(folder); }
  fs::path file(const std::string& extension) const {
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == extension) return entry.path();
    return {};
  }
  // Whether the passes ran; a kernel is there in either case.
  bool generated() {
    const CompiledKernel kernel = compile(energy, options);
    EXPECT_STREQ(kernel.table->energy, "spring");
    EXPECT_EQ(kernel.counts.hessian, kernel.table->operations_hessian);
    EXPECT_GT(kernel.source_bytes, 1000u);
    return kernel.times.lower > 0;
  }
  static void overwrite(const fs::path& file, std::streamoff at, const std::string& with) {
    std::fstream out(file, std::ios::in | std::ios::out | std::ios::binary);
    out.seekp(at);
    out << with;
  }

  fs::path folder;
  CompileOptions options;
  Energy energy = read_energy(test::source("/energies/rods/spring.energy"));
};

TEST_F(FoundByNote, FromTheSecondTimeOn) {
  EXPECT_TRUE(generated());
  EXPECT_FALSE(generated());
  options.lanes = 2;
  EXPECT_TRUE(generated());
}

TEST_F(FoundByNote, DamagedNoteIsMadeAgain) {
  EXPECT_TRUE(generated());
  overwrite(file(".note"), 3, "x");
  EXPECT_TRUE(generated());
  EXPECT_FALSE(generated());
  fs::resize_file(file(".note"), fs::file_size(file(".note")) / 2);
  EXPECT_TRUE(generated());
  EXPECT_FALSE(generated());
}

TEST_F(FoundByNote, NoteOfAnotherKernelIsNotBelieved) {
  EXPECT_TRUE(generated());
  const fs::path own = file(".note");
  KernelCache({folder}).keep_note(own.stem(), to_text({"wrong-w1-0", 1, {}}, "another front key"));
  EXPECT_TRUE(generated());
  EXPECT_FALSE(generated());
}

TEST_F(FoundByNote, NoteOfALibraryThatIsGoneOrDamagedIsOutOfDate) {
  EXPECT_TRUE(generated());
  fs::remove(file(".so"));
  EXPECT_TRUE(generated());
  EXPECT_FALSE(generated());
  overwrite(file(".so"), 2000, "damage");
  EXPECT_TRUE(generated());
  EXPECT_FALSE(generated());
}

TEST_F(FoundByNote, FolderThatCannotBeWrittenServesToo) {
  EXPECT_TRUE(generated());
  options.read_only_caches = {folder};
  options.cache = "/proc/ergon";
  EXPECT_FALSE(generated());
  fs::remove(file(".note"));
  EXPECT_TRUE(generated()) << "found by the key of its source";
  EXPECT_FALSE(fs::exists(options.cache));
}

TEST_F(FoundByNote, ProcessesShareAFolder) {
  std::vector<std::thread> threads;
  std::vector<int> points(8, 0);
  for (size_t i = 0; i < points.size(); ++i) {
    threads.emplace_back([&, i] {
      for (int k = 0; k < 3; ++k) points[i] = compile(energy, options).table->points;
    });
  }
  for (std::thread& t : threads) t.join();
  EXPECT_THAT(points, ::testing::Each(2));
  EXPECT_FALSE(generated());
  for (const auto& entry : fs::directory_iterator(folder))
    EXPECT_THAT(entry.path().extension(), ::testing::AnyOf(".so", ".cpp", ".note")) << "nothing half-written is left";
}

}  // namespace
}  // namespace ergon
