// tools/checks.sh on small trees: each check finds what it is there for.

#include <gmock/gmock.h>

#include "tests/paths.h"
#include "tests/tools/command.h"

namespace ergon {
namespace {

using testing::HasSubstr;

class Checks : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    std::filesystem::copy(test::source("/.clang-format"), folder / ".clang-format");
    write("runtime/good.h", "#pragma once\n#include <vector>\n\n#include \"runtime/other.h\"\n");
    write("symbolic/good.cpp", "#include \"symbolic/good.h\"\n");
    write("codegen/good.cpp", "#include \"runtime/kernel.h\"\n#include \"symbolic/energy.h\"\n");
    write("tools/good.sh", "#!/bin/bash\necho good\n");
  }
  Answer checks() { return shell("ERGON_TREE=\"$PWD\" '" + test::source("/tools/checks.sh") + "'"); }
  void expect_found(const std::string& check, const std::string& message) {
    const Answer answer = checks();
    EXPECT_EQ(answer.code, 1);
    EXPECT_THAT(answer.out, HasSubstr("failed: " + check + "\n"));
    EXPECT_THAT(answer.out + answer.err, HasSubstr(message));
  }
};

TEST_F(Checks, AGoodTreePasses) {
  const Answer answer = checks();
  EXPECT_EQ(answer.code, 0) << answer.out << answer.err;
  EXPECT_EQ(answer.out,
            "passed: format\npassed: include directions\npassed: file lengths\npassed: type names\n"
            "passed: law names\npassed: shell scripts\npassed: host paths\n");
}

TEST_F(Checks, RuntimeKnowsNothingOfTheCompiler) {
  write("runtime/bad.cpp", "#include \"codegen/compile.h\"\n");
  expect_found("include directions", "runtime/bad.cpp:1: runtime may not include \"codegen/compile.h\"");
  write("runtime/bad.cpp", "\n#include <ginac/ginac.h>\n");
  expect_found("include directions", "runtime/bad.cpp:2: runtime does not know GiNaC");
}

TEST_F(Checks, CodegenSeesOfTheRuntimeOnlyTheKernelStruct) {
  write("codegen/bad.cpp", "#include \"runtime/system.h\"\n");
  expect_found("include directions", "codegen/bad.cpp:1: codegen may not include \"runtime/system.h\"");
}

TEST_F(Checks, IncludesAreWrittenFromTheRoot) {
  write("symbolic/bad.cpp", "#include \"energy.h\"\n");
  expect_found("include directions", "symbolic/bad.cpp:1: \"energy.h\" is not written from the root of the repository");
}

TEST_F(Checks, TwoTypesOfOneNameAreOneToTheLinker) {
  const std::string type = "namespace ergon {\n\nstruct Twice {\n  int x;\n};\n\n}  // namespace ergon\n";
  const std::string hidden =
      "namespace ergon {\nnamespace {\n\nclass Twice {};\n\n}  // namespace\n}  // namespace ergon\n";
  write("runtime/a.cpp", type);
  write("symbolic/b.cpp", hidden);
  write("symbolic/c.cpp", "namespace ergon {\n\nstruct Twice;\n\n}  // namespace ergon\n");
  write("symbolic/d.cpp", "namespace ergon::other {\n\nstruct Twice {};\n\n}  // namespace ergon::other\n");
  EXPECT_EQ(checks().code, 0) << checks().out;
  write("tests/runtime/e.cpp", type);
  expect_found("type names", "tests/runtime/e.cpp:3: ergon::Twice is also the name of a type in runtime/a.cpp:3");
  std::filesystem::remove(folder / "runtime/a.cpp");
  write("tests/scenes/f.cpp", type);
  EXPECT_EQ(checks().code, 0) << checks().out;
  write("tests/scenes/g.h", "#pragma once\nnamespace ergon {\n\nenum class Twice { a };\n\n}  // namespace ergon\n");
  expect_found("type names", "tests/scenes/g.h:4: ergon::Twice is also the name of a type in tests/scenes/f.cpp:3");
}

TEST_F(Checks, NoLawHasCodeOfItsOwn) {
  for (const char* law : {"solids/my_rubber", "loads/pressure", "bodies/gravity", "contact/distances/rope"})
    write(std::string("energies/") + law + ".energy", "# A law.\n");
  write("scenes/a.cpp",
        "// \"my_rubber\" is a law.\nconst char* a = \"that of pressure; a rope\";\nconst char* b = \"rope\";\n");
  EXPECT_EQ(checks().code, 0) << checks().out;
  write("scenes/a.cpp", "int x;\nbool a = name == \"pressure\";\n");
  expect_found("law names",
               "scenes/a.cpp:2: \"pressure\" is a law of the catalogue, which needs no code of its own; what is "
               "particular to it belongs into its file, or into a word of the language\n");
  write("scenes/a.cpp", "bool a = name == \"pressure:point_point\";\n");
  expect_found("law names", "scenes/a.cpp:1: \"pressure\" is a law");
  write("scenes/a.cpp", "const char* a = \"as my_rubber does\";\n");
  expect_found("law names", "scenes/a.cpp:1: \"my_rubber\" is a law");
  std::filesystem::remove(folder / "scenes/a.cpp");
  write("scenes/builder.cpp", "const char* a = \"gravity\";\n");
  EXPECT_EQ(checks().code, 0) << checks().out;
  write("scenes/builder.cpp", "\n");
  expect_found(
      "law names",
      "scenes/builder.cpp: does not name the law \"gravity\" any more; take it off the list in tools/checks.sh\n");
}

TEST_F(Checks, FormatAndLengthAreKept) {
  write("tests/bad.cpp", "int   x;\n");
  expect_found("format", "tests/bad.cpp:1:4");
  std::string lines;
  for (int i = 0; i < 400; ++i) lines += "//\n";
  write("tests/bad.cpp", lines);
  EXPECT_EQ(checks().code, 0);
  write("tests/bad.cpp", lines + "//\n");
  expect_found("file lengths", "tests/bad.cpp: more than 400 lines");
}

TEST_F(Checks, ScriptsAndPathsAreLookedAt) {
  write("tools/bad.sh", "#!/bin/bash\nif true\n");
  expect_found("shell scripts", "tools/bad.sh: line 3");
  std::filesystem::remove(folder / "tools/bad.sh");
  write("energies/bad.energy", std::string("# see /ho") + "me/somebody/notes\n");
  expect_found("host paths", "energies/bad.energy:1:");
}

TEST_F(Checks, UnknownArgumentsAreRefused) {
  const Answer checks = shell(test::source("/tools/checks.sh") + " --tidi");
  EXPECT_EQ(checks.code, 1);
  EXPECT_EQ(checks.err, "ergon: error: unknown argument '--tidi'; usage: tools/checks.sh [--tidy]\n");
  const Answer test = shell(test::source("/tools/test") + " --fats");
  EXPECT_EQ(test.code, 1);
  EXPECT_EQ(test.err, "ergon: error: unknown argument '--fats'; usage: tools/test [--fast]\n");
}

TEST_F(Checks, NothingThatTheProjectNeedsIsMissing) {
  // The tests run where tools/setup.sh has been: its own look-up then finds nothing to install.
  const Answer answer = shell("bash -c \"source '" + test::source("/tools/setup.sh") + "' && missing_packages\"");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_EQ(answer.out, "");
}

}  // namespace
}  // namespace ergon
