// Several kernels at once: the same as one after the other, and every failure told in the order of the jobs.

#include "codegen/compile_all.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "codegen/build.h"

namespace ergon {
namespace {

namespace fs = std::filesystem;

class CompileAll : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder);
    for (const char* text : {"energy a point\ndof x m\nparam k N/m\nvalue k*norm2(x)\n",
                             "energy b point\ndof x m\nparam k N/m\nvalue 2*k*norm2(x)\n",
                             "energy c point\ndof x m\nparam k N/m\nvalue 3*k*norm2(x)\n"})
      energies.push_back(parse_energy(text, "text.energy"));
    options.cache = folder;
  }
  void TearDown() override { fs::remove_all(folder); }
  std::vector<CompileJob> jobs() const {
    std::vector<CompileJob> all;
    for (const Energy& energy : energies) all.push_back({&energy, options});
    return all;
  }

  fs::path folder = fs::temp_directory_path() / ("ergon-compile-all-test-" + std::to_string(getpid()));
  std::vector<Energy> energies;
  CompileOptions options;
};

TEST_F(CompileAll, KernelsComeInTheOrderOfTheJobs) {
  for (const bool cached : {false, true}) {
    const auto kernels = kernels_of(compile_all(jobs(), 3));
    ASSERT_EQ(kernels.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(kernels[i].table->energy, energies[i].name);
      EXPECT_EQ(kernels[i].cached, cached);
      EXPECT_EQ(kernels[i].source_bytes, generate(energies[i], options).source.size());
    }
  }
  EXPECT_TRUE(compile_all({}).empty());
}

TEST_F(CompileAll, OneFailureIsThrownAsItWas) {
  std::vector<CompileJob> all = jobs();
  all[1].options.compiler = "no-such-compiler";
  const auto outcomes = compile_all(all, 2);
  EXPECT_EQ(outcomes[0].message, "");
  EXPECT_EQ(outcomes[2].message, "");
  EXPECT_STREQ(outcomes[2].kernel.table->energy, "c");
  try {
    kernels_of(outcomes);
    FAIL() << "no error";
  } catch (const BuildError& error) {
    EXPECT_EQ(error.what(), outcomes[1].message);
    EXPECT_THAT(error.what(), ::testing::StartsWith("no C++ compiler to make a kernel with: 'no-such-compiler': "));
  }
}

TEST_F(CompileAll, NoFailureIsLost) {
  std::vector<CompileJob> all = jobs();
  all[0].options.compiler = "false";
  all[1].options.case_name = "no_such_case";
  all[2].options.cache = "/proc/ergon";
  for (const int workers : {1, 3}) {
    try {
      kernels_of(compile_all(all, workers));
      FAIL() << "no error";
    } catch (const BuildError& error) {
      EXPECT_THAT(error.what(), ::testing::MatchesRegex(
                                    "3 of 3 kernels could not be compiled:\n'false' could not compile [^\n]*/a-w1-"
                                    "[^\n]*\n'b' has no case 'no_such_case'\nno folder to keep kernels in can be "
                                    "written \\(tried: /proc/ergon\\); set ERGON_CACHE to one that can"));
    }
  }
}

TEST_F(CompileAll, AnotherCompilerMakesNewKernels) {
  // The same program in another place is another compiler; one that is gone leaves what it made to be used.
  fs::create_directories(folder);
  const fs::path compiler = folder / "c++";
  auto install = [&](const std::string& comment) {
    std::ofstream(compiler) << "#!/bin/sh\n# " << comment << "\nexec g++ \"$@\"\n";
    fs::permissions(compiler, fs::perms::owner_all);
  };
  install("first");
  options.compiler = compiler;
  EXPECT_FALSE(compile(energies[0], options).cached);
  EXPECT_TRUE(compile(energies[0], options).cached);
  const std::string before = compiler_identity(compiler);
  install("upgraded");
  EXPECT_NE(compiler_identity(compiler), before);
  EXPECT_FALSE(compile(energies[0], options).cached);
  EXPECT_TRUE(compile(energies[0], options).cached);
  fs::remove(compiler);
  EXPECT_EQ(compiler_identity(compiler), "");
  EXPECT_TRUE(compile(energies[0], options).cached);
}

TEST_F(CompileAll, KernelsThatCameWithTheProgramServeEveryCompiler) {
  compile(energies[0], options);
  fs::path library;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".so") library = entry.path();
  std::string name = library.filename();
  name.replace(name.rfind('-'), std::string::npos, "-00000000.so");
  fs::rename(library, folder / name);
  CompileOptions shipped = options;
  shipped.read_only_caches = {folder};
  shipped.cache = folder / "own";
  EXPECT_TRUE(compile(energies[0], shipped).cached);
  EXPECT_FALSE(compile(energies[0], options).cached);
}

TEST(CompilerIdentity, IsOfTheProgramThatWouldRun) {
  EXPECT_EQ(compiler_identity("g++").size(), 8u);
  EXPECT_EQ(compiler_identity("g++"), compiler_identity("g++"));
  EXPECT_EQ(compiler_identity("no-such-compiler"), "");
  EXPECT_EQ(compiler_identity("/no/such/compiler"), "");
}

}  // namespace
}  // namespace ergon
