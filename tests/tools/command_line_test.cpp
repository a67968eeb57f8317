#include <gmock/gmock.h>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/paths.h"
#include "tests/tools/command.h"

namespace ergon {
namespace {

using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

class CommandLine : public CommandTest {
 protected:
  void expect(const std::string& arguments, int code, const std::string& message) {
    const Answer answer = ergon(arguments);
    EXPECT_EQ(answer.code, code) << arguments;
    EXPECT_EQ(answer.out, "") << arguments;
    EXPECT_EQ(answer.err, message.empty() ? "" : "ergon: error: " + message + "\n") << arguments;
  }
};
class SlowCommandLine : public CommandLine {};

TEST_F(CommandLine, TellsItsVersionAndHelps) {
  const Answer version = ergon("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, MatchesRegex("ergon [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  const Answer help = ergon("--help");
  EXPECT_EQ(help.code, 0);
  for (const char* command :
       {"run", "batch", "new", "check", "show", "plot", "fit", "compile", "cost", "eval", "bench"}) {
    EXPECT_THAT(help.out, HasSubstr(std::string("\n  ") + command));
    const Answer one = ergon(std::string(command) + " --help");
    EXPECT_EQ(one.code, 0) << command;
    EXPECT_THAT(one.out, HasSubstr("Usage: ergon " + std::string(command)));
  }
}

TEST_F(CommandLine, NamesWhatWasMisspelt) {
  expect("", 2,
         "'ergon' needs a command: run, batch, new, check, show, plot, fit, compile, cost, eval, bench, accuracy, "
         "stress, verify");
  expect("chek x", 2, "unknown command 'ergon chek'; did you mean 'check'?");
  expect("bench kernel", 2, "unknown command 'ergon bench kernel'; did you mean 'kernels'?");
  expect("bench", 2, "'ergon bench' needs a command: kernels, compile, contact, ccd, scene, accuracy, stopping");
  expect("run --thread 2 x.toml", 2, "unknown option '--thread' of 'ergon run'; did you mean '--threads'?");
  expect("check a.energy b.energy", 2, "'ergon check' does not expect 'b.energy'; see 'ergon check --help'");
  expect("run", 2, "scene is required; see 'ergon run --help'");
  expect("run x.toml --threads many", 2, "Could not convert: --threads = many; see 'ergon run --help'");
  expect("run x.toml --threads 0", 2, "--threads: 0 is below 1");
}

TEST_F(CommandLine, NamesTheEnergyThatIsNotThere) {
  expect("check nothing.energy", 2, "nothing.energy: cannot open the energy file");
  const Answer answer = ergon("show stable_neohookean");
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, testing::EndsWith("did you mean 'stable_neo_hookean'?\n"));
}

TEST_F(CommandLine, PointsIntoAnEnergyThatIsWrong) {
  write("bad.energy", "density bad solid\nparam E Pa (0, inf)\nvalue E*tr(G)\n");
  const Answer answer = ergon("check bad.energy");
  EXPECT_EQ(answer.code, 2);
  EXPECT_THAT(answer.err, StartsWith("ergon: error: bad.energy:3:12: "));
}

TEST_F(CommandLine, AnUnsoundEnergyFails) {
  write("tied.energy",
        "# Not the same after a rotation.\ndensity tied solid\nparam mu Pa (0, inf)\nvalue mu*(F[0,0] - 1)^2\n");
  const Answer answer = ergon("check tied.energy");
  EXPECT_EQ(answer.code, 1);
  EXPECT_EQ(answer.err, "");
  EXPECT_THAT(answer.out, HasSubstr("\n  error    rigid motion "));
  EXPECT_THAT(answer.out, HasSubstr("\nnot sound: "));
  EXPECT_EQ(ergon("check stable_neo_hookean").code, 0);
}

TEST_F(CommandLine, ShowsFormulaSymbolsAndCost) {
  const Answer answer = ergon("show stable_neo_hookean");
  EXPECT_EQ(answer.code, 0);
  EXPECT_THAT(answer.out, StartsWith("stable_neo_hookean: density of a solid, in Pa\n"));
  EXPECT_THAT(answer.out, HasSubstr("value mu/2*(tr(F'*F) - 3) - mu*(det(F) - 1) + la/2*(det(F) - 1)^2"));
  EXPECT_THAT(answer.out, HasSubstr("nu    param  scalar      1     (-1, 0.5)  Poisson's ratio"));
  EXPECT_THAT(answer.out, HasSubstr("cost, operations per point of quadrature: value "));
  EXPECT_THAT(answer.out, HasSubstr("stable_neo_hookean.energy --source)\n"));
  EXPECT_THAT(answer.out, HasSubstr("static void hessian_entry("));
  EXPECT_THAT(answer.out, Not(HasSubstr("ErgonInput")));
  EXPECT_THAT(ergon("show stable_neo_hookean --latex").out, HasSubstr("\\det"));
  EXPECT_THAT(ergon("show stable_neo_hookean --source").out, HasSubstr("ergon_kernel"));
  expect("show stable_neo_hookean --case face", 2, "--case: stable_neo_hookean has no cases");
}

TEST_F(CommandLine, TheCostIsThatOfTheEmittedFile) {
  const Answer answer = ergon("cost stable_neo_hookean");
  EXPECT_EQ(answer.code, 0) << answer.err;
  const std::string source = ergon("show stable_neo_hookean --source").out;
  int lines = 0;
  std::istringstream text(answer.out);
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with("per element")) break;
    if (!line.starts_with("  ")) continue;
    ++lines;
    EXPECT_THAT(source, HasSubstr("// " + line + "\n"));
  }
  EXPECT_EQ(lines, 8);  // titles and seven entry points
  EXPECT_THAT(answer.out, HasSubstr("\nTet4 "));
  EXPECT_THAT(answer.out, HasSubstr("\nHex8 "));
  EXPECT_THAT(answer.out, Not(HasSubstr("Tri3")));

  std::istringstream json(ergon("cost spring --json").out);
  std::vector<nlohmann::json> rows;
  for (std::string line; std::getline(json, line);) rows.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(rows.size(), 8u);
  EXPECT_EQ(rows[3]["entry"], "value");
  EXPECT_EQ(rows[3]["bytes_in"], 32);  // the difference of two points, and the rest length
  EXPECT_EQ(rows[3]["bytes_uniform"], 8);
  EXPECT_EQ(rows[5]["bytes_out"], 8 * (1 + 3 + 6));
  EXPECT_EQ(rows[6]["entry"], "projected");
  EXPECT_EQ(rows[7]["element"], "edge");
  EXPECT_EQ(rows[7]["matrix_bytes"], 3 * 72);
  // What is evaluated is the projected Hessian, and of an isotropic density the gradient and the principal blocks.
  EXPECT_EQ(rows[7]["operations"], rows[6]["operations"]);
  std::map<std::string, nlohmann::json> solid;
  std::istringstream of_solid(ergon("cost stable_neo_hookean --json").out);
  for (std::string line; std::getline(of_solid, line);) {
    const nlohmann::json row = nlohmann::json::parse(line);
    solid[row.value("entry", row.value("element", ""))] = row;
  }
  EXPECT_EQ(solid["Tet4"]["operations"],
            solid["gradient"]["operations"].get<int>() + solid["principal"]["operations"].get<int>());
}

TEST_F(CommandLine, ShowsTheSameSourceInTwoProcesses) {
  const std::string source = ergon("show neo_hookean --source").out;
  EXPECT_GT(source.size(), 1000u);
  EXPECT_EQ(source, ergon("show neo_hookean --source").out);
}

TEST_F(CommandLine, CompilesOnceAndDumpsPasses) {
  write("my.energy", "# A spring to the origin.\nenergy my point\ndof x m\nparam k N/m (0, inf)\nvalue k/2*norm2(x)\n");
  const Answer first = ergon("compile my.energy");
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, MatchesRegex("my: [1248] lanes; operations: value [0-9]+, gradient [0-9]+, hessian [0-9]+ "
                                      "\\([0-9]+ divisions\\); compiled in [0-9.]+ s\n"));
  EXPECT_THAT(ergon("compile my.energy").out, HasSubstr("; cached, checked in "));
  EXPECT_GT(ergon("compile my.energy --dump differentiate").out.size(), 20u);
  expect(
      "compile my.energy --dump diferentiate", 2,
      "--dump: 'diferentiate' is none of lower, rest, frontier, differentiate, structure, principal, parts, schedule, "
      "emit; did you mean 'differentiate'?");
  expect("compile", 2, "'ergon compile' needs an energy, or --catalogue FOLDER");
}

TEST_F(SlowCommandLine, TheCatalogueIsCompiledOnceForAllWidths) {
  const Answer first = ergon("compile --catalogue kernels");
  EXPECT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, MatchesRegex("kernels: [0-9]+ kernels compiled, 0 already there\n"));
  const Answer second = ergon("compile --catalogue kernels");
  EXPECT_THAT(second.out, MatchesRegex("kernels: 0 kernels compiled, [0-9]+ already there\n"));
}

TEST_F(CommandLine, TheProgramBringsTheCataloguesKernels) {
  // No compiler, an empty cache: the kernels compiled with the program are found beside it.
  const Answer answer = shell("PATH=/nowhere " + test::built("/ergon") + " compile stable_neo_hookean");
  EXPECT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("; cached, checked in "));
}

TEST_F(CommandLine, AMissingCompilerIsNamedWithItsRemedy) {
  write("my.energy", "# A spring to the origin.\nenergy my point\ndof x m\nparam k N/m (0, inf)\nvalue k/2*norm2(x)\n");
  const Answer answer = shell("ERGON_CXX=/nowhere/g++ " + test::built("/ergon") + " compile my.energy");
  EXPECT_EQ(answer.code, 1);
  EXPECT_EQ(answer.err,
            "ergon: error: no C++ compiler to make a kernel with: '/nowhere/g++': No such file or directory; install "
            "one (Debian: apt-get install g++) or name one in the environment variable ERGON_CXX\n");
}

TEST_F(CommandLine, AStandardOutputThatIsFullFails) {
  const Answer answer = shell(test::built("/ergon") + " show stable_neo_hookean >/dev/full");
  EXPECT_EQ(answer.code, 1);
  EXPECT_EQ(answer.err, "ergon: error: the standard output could not be written\n");
}

}  // namespace
}  // namespace ergon
