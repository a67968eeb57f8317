// The way from an energy to a loaded library: cache, damage, and a compiler that is missing or refuses.

#include "codegen/compile.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <unistd.h>

#include "codegen/build.h"
#include "codegen/cache.h"
#include "codegen/hash.h"
#include "tests/paths.h"

namespace ergon {
namespace {

namespace fs = std::filesystem;

const char* const kCases = R"(# A made-up law with two cases.
energy two_cases edge
cite   Hooke 1678. De Potentia Restitutiva.
dof    x0 x1 m
param  k N/m (0, inf) stiffness
case   long  d2 = norm2(x1 - x0)
case   flat  d2 = (x1[0] - x0[0])^2
value  k/2*d2
)";

class CompileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() / ("ergon-compile-test-" + std::to_string(getpid()));
    fs::remove_all(folder);
    options.cache = folder;
  }
  void TearDown() override { fs::remove_all(folder); }
  fs::path library() const {
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.path().extension() == ".so") return entry.path();
    return {};
  }

  fs::path folder;
  CompileOptions options;
  Energy energy = read_energy(test::source("/energies/rods/spring.energy"));
};

TEST_F(CompileTest, SecondTimeComesFromTheCache) {
  EXPECT_FALSE(compile(energy, options).cached);
  CompiledKernel again = compile(energy, options);
  EXPECT_TRUE(again.cached);
  EXPECT_STREQ(again.table->energy, "spring");
  EXPECT_EQ(again.table->points, 2);
  EXPECT_EQ(again.table->q_vectors, 1);
  EXPECT_DOUBLE_EQ(again.table->weights[0], -again.table->weights[1]);
}

TEST_F(CompileTest, OnlyTheLibraryItsSourceAndANoteAreLeft) {
  compile(energy, options);
  std::vector<std::string> extensions;
  for (const auto& entry : fs::directory_iterator(folder)) extensions.push_back(entry.path().extension());
  EXPECT_THAT(extensions, ::testing::UnorderedElementsAre(".so", ".cpp", ".note"));
}

TEST_F(CompileTest, DamagedFileIsMadeAgain) {
  compile(energy, options);
  {
    std::fstream file(library(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(2000);
    file << "damage";
  }
  EXPECT_FALSE(compile(energy, options).cached);
  EXPECT_TRUE(compile(energy, options).cached);
}

TEST_F(CompileTest, HalfWrittenFileIsMadeAgain) {
  compile(energy, options);
  fs::resize_file(library(), fs::file_size(library()) / 2);
  EXPECT_FALSE(compile(energy, options).cached);
  EXPECT_TRUE(compile(energy, options).cached);
}

TEST_F(CompileTest, ReadOnlyCacheIsSearchedFirst) {
  compile(energy, options);
  CompileOptions second;
  second.read_only_caches = {folder};
  second.cache = folder / "other";
  EXPECT_TRUE(compile(energy, second).cached);
  EXPECT_FALSE(fs::exists(folder / "other"));
}

TEST_F(CompileTest, CompilersShareAFolder) {
  std::vector<std::thread> threads;
  std::vector<int> points(4, 0);
  for (size_t i = 0; i < points.size(); ++i)
    threads.emplace_back([&, i] { points[i] = compile(energy, options).table->points; });
  for (std::thread& t : threads) t.join();
  EXPECT_THAT(points, ::testing::Each(2));
  EXPECT_TRUE(compile(energy, options).cached);
}

TEST_F(CompileTest, MissingCompilerSaysWhatToInstall) {
  options.compiler = "no-such-compiler";
  try {
    compile(energy, options);
    FAIL() << "no error";
  } catch (const BuildError& e) {
    EXPECT_STREQ(
        e.what(),
        "no C++ compiler to make a kernel with: 'no-such-compiler': No such file or directory; install one (Debian: "
        "apt-get install g++) or name one in the environment variable ERGON_CXX");
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(CompileTest, CompilerThatFailsIsQuoted) {
  options.compiler = "false";
  try {
    compile(energy, options);
    FAIL() << "no error";
  } catch (const BuildError& e) {
    EXPECT_THAT(e.what(), ::testing::StartsWith("'false' could not compile " + folder.string()));
  }
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(CompileTest, NoWritableFolderIsNamed) {
  options.cache = "/proc/ergon";
  try {
    compile(energy, options);
    FAIL() << "no error";
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(),
                 "no folder to keep kernels in can be written (tried: /proc/ergon); set ERGON_CACHE to one that can");
  }
}

TEST_F(CompileTest, EachCaseIsAKernel) {
  Energy two = parse_energy(kCases, "two_cases.energy");
  options.case_name = "flat";
  CompiledKernel flat = compile(two, options);
  EXPECT_STREQ(flat.table->case_name, "flat");
  EXPECT_TRUE(flat.table->constant_hessian);
  options.case_name = "long";
  EXPECT_STREQ(compile(two, options).table->case_name, "long");
  EXPECT_LT(flat.counts.hessian, generate(two, options).counts.hessian);
}

TEST_F(CompileTest, FrontierFindsTheFewestVectors) {
  Energy hinge = parse_energy(
      "energy fold hinge\ncite Grinspun et al. 2003. Discrete Shells. SCA.\ndof x0 x1 x2 x3 m\nparam k J (0, inf) "
      "stiffness\n"
      "value k*dihedral(x0, x1, x2, x3)^2\n",
      "fold.energy");
  Generated g = generate(hinge, options);
  EXPECT_EQ(g.module.q_vectors, 3);
  for (int k = 0; k < 3; ++k) {
    double sum = 0;
    for (int p = 0; p < 4; ++p) sum += g.module.weights[static_cast<size_t>(4 * k + p)];
    EXPECT_EQ(sum, 0) << "edge vectors do not see translations";
  }
}

TEST_F(CompileTest, StructureOfTheCatalogue) {
  auto structure = [&](const char* file) {
    return generate(read_energy(test::source("/energies/") + file), options).module;
  };
  Module inertia = structure("bodies/inertia.energy"), gravity = structure("bodies/gravity.energy"),
         linear = structure("solids/linear_elasticity.energy"), stable = structure("solids/stable_neo_hookean.energy");
  EXPECT_TRUE(inertia.constant_hessian && inertia.psd_hessian && !inertia.zero_hessian && !inertia.constant_gradient);
  EXPECT_TRUE(gravity.constant_gradient && gravity.zero_hessian);
  EXPECT_TRUE(linear.constant_hessian && !linear.constant_gradient);
  EXPECT_FALSE(stable.constant_hessian || stable.psd_hessian || stable.constant_gradient);
}

TEST_F(CompileTest, EveryPassCanBeLookedAt) {
  std::vector<std::string> passes;
  options.dump = [&](const std::string& pass, const std::string& text) {
    passes.push_back(pass);
    EXPECT_THAT(text, ::testing::HasSubstr("roots %"));
  };
  generate(energy, options);
  EXPECT_THAT(passes, ::testing::ElementsAre("lower", "rest", "frontier", "differentiate", "structure", "principal",
                                             "parts", "schedule", "emit"));
}

TEST(ContentHash, SeesEveryByte) {
  EXPECT_EQ(content_hash("").size(), 32u);
  EXPECT_NE(content_hash("a"), content_hash("b"));
  EXPECT_NE(content_hash(std::string_view("a\0", 2)), content_hash("a"));
}

}  // namespace
}  // namespace ergon
