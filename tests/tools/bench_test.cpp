#include <gmock/gmock.h>

#include "tests/symbolic/energy_files.h"
#include "tests/tools/command.h"
#include "tests/tools/json_lines.h"

namespace ergon {
namespace {

using Json = nlohmann::ordered_json;
using testing::ElementsAre;

class Bench : public CommandTest {
 protected:
  std::vector<Json> rows(const std::string& arguments) {
    const Answer answer = ergon("bench " + arguments + " --json");
    EXPECT_EQ(answer.code, 0) << answer.err;
    return json_lines(answer.out);
  }
  static std::vector<std::string> fields(const Json& row) {
    std::vector<std::string> names;
    for (const auto& item : row.items()) names.push_back(item.key());
    return names;
  }
};

TEST_F(Bench, KernelsGiveTheirFieldsForEachEntry) {
  const std::vector<Json> all = rows("kernels --energy stable_neo_hookean --cells 3 --project abs");
  ASSERT_EQ(all.size(), 3u);
  for (const Json& row : all) {
    EXPECT_THAT(fields(row),
                ElementsAre("energy", "element", "entry", "projection", "lanes", "precision", "threads", "elements",
                            "ns_per_element", "ns_per_point", "state", "indefinite", "assembled", "operations"));
    EXPECT_EQ(row["energy"], "stable_neo_hookean");
    EXPECT_EQ(row["element"], "Tet4");
    EXPECT_EQ(row["elements"], 6 * 27);
    EXPECT_EQ(row["threads"], 1);
    EXPECT_GT(row["ns_per_element"], 0);
    EXPECT_EQ(row["ns_per_element"], row["ns_per_point"]);
    EXPECT_GT(row["operations"], 0);
  }
  EXPECT_EQ(all[0]["entry"], "value");
  EXPECT_EQ(all[1]["entry"], "gradient");
  EXPECT_EQ(all[2]["entry"], "hessian");
  EXPECT_EQ(all[1]["projection"], "none");
  EXPECT_EQ(all[2]["projection"], "abs");
}

TEST_F(Bench, KernelsAreMeasuredWhereHessiansAreDefiniteAndWhereNot) {
  const auto share = [&](const std::string& state) {
    return rows("kernels --energy fibre_reinforced --entry hessian --cells 4 --state " + state)[0]["indefinite"]
        .get<double>();
  };
  EXPECT_EQ(share("definite"), 0);
  EXPECT_EQ(share("indefinite"), 1);
  EXPECT_EQ(ergon("bench kernels --energy spring --cells 1 --state calm").err,
            "ergon: error: --state: 'calm' is none of rest, noise, definite, indefinite\n");
}

TEST_F(Bench, KernelsTakeAQuadrature) {
  const std::vector<Json> all =
      rows("kernels --energy neo_hookean --element tet4 --entry value --cells 2 --quadrature 2");
  EXPECT_NEAR(all[0]["ns_per_element"].get<double>() / all[0]["ns_per_point"].get<double>(), 4, 1e-9);
  EXPECT_EQ(ergon("bench kernels --energy spring --quadrature 2").err,
            "ergon: error: --quadrature: spring is a stencil energy, which is not integrated\n");
  EXPECT_EQ(ergon("bench kernels --energy neo_hookean --quadrature 12").err,
            "ergon: error: --quadrature: 0 to 11, not 12\n");
}

TEST_F(Bench, KernelsKnowElementsAndStencils) {
  const std::vector<Json> hex = rows("kernels --energy neo_hookean --element hex8 --entry gradient --cells 2");
  ASSERT_EQ(hex.size(), 1u);
  EXPECT_EQ(hex[0]["element"], "Hex8");
  EXPECT_EQ(hex[0]["elements"], 8);
  EXPECT_NEAR(hex[0]["ns_per_element"].get<double>() / hex[0]["ns_per_point"].get<double>(), 8, 1e-9);
  const std::vector<Json> edges = rows("kernels --energy spring --entry value --cells 1 --set k=3");
  ASSERT_EQ(edges.size(), 1u);
  EXPECT_EQ(edges[0]["element"], "edge");
  EXPECT_EQ(edges[0]["elements"], 19);
}

TEST_F(Bench, KernelsOfFewerLanesThanTheMachineHas) {
  const std::vector<Json> two = rows("kernels --energy spring --cells 1 --lanes 2");
  ASSERT_EQ(two.size(), 3u);
  for (const Json& row : two) EXPECT_EQ(row["lanes"], 2);
  EXPECT_THAT(ergon("bench kernels --energy spring --lanes 3").err,
              testing::MatchesRegex("ergon: error: --lanes: this machine has 1, 2[, 0-9]*, not 3\n"));
}

TEST_F(Bench, KernelsNameWhatIsWrong) {
  const Answer answer = ergon("bench kernels --energy neo_hookean --element tri3");
  EXPECT_EQ(answer.code, 2);
  EXPECT_EQ(answer.err, "ergon: error: neo_hookean is a density of a solid; Tri3 elements have dimension 2, not 3\n");
  EXPECT_EQ(ergon("bench kernels --entry hesian").err,
            "ergon: error: --entry: 'hesian' is none of value, gradient, hessian; did you mean 'hessian'?\n");
  EXPECT_EQ(ergon("bench kernels --energy spring --cells 0").err,
            "ergon: error: 0 cells per edge; at least 1 is needed\n");
}

TEST_F(Bench, EveryEnergyOfTheCatalogueCanBeMeasured) {
  const std::vector<Json> all = rows("kernels --entry hessian --cells 1");
  std::set<std::string> energies;
  for (const Json& row : all) energies.insert(row["energy"].get<std::string>());
  for (const std::string& name : test::catalogue_names()) {
    const auto found = energies.lower_bound(name);
    EXPECT_TRUE(found != energies.end() && found->starts_with(name)) << name;
  }
}

TEST_F(Bench, CompileTellsColdAndCached) {
  const std::vector<Json> all = rows("compile --energy stable_neo_hookean");
  ASSERT_EQ(all.size(), 2u);
  for (const Json& row : all) {
    EXPECT_THAT(fields(row), ElementsAre("energy", "element", "read_s", "differentiate_s", "emit_s", "generate_s",
                                         "compile_s", "load_s", "total_s", "source_bytes", "cached"));
    EXPECT_GT(row["source_bytes"], 1000);
    EXPECT_GE(row["total_s"].get<double>(), row["compile_s"].get<double>());
  }
  EXPECT_EQ(all[0]["cached"], false);
  EXPECT_EQ(all[1]["cached"], true);
  EXPECT_GT(all[0]["compile_s"], 0);
  EXPECT_EQ(all[1]["compile_s"], 0);
}

TEST_F(Bench, CompileTellsTheSlowest) {
  const std::vector<Json> all = rows("compile --energy gravity --energy spring --all");
  ASSERT_EQ(all.size(), 6u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(all[4 + i]["energy"], "slowest");
    for (const char* field : {"generate_s", "compile_s", "total_s", "source_bytes"})
      EXPECT_GE(all[4 + i][field], std::max(all[i][field], all[2 + i][field])) << field;
  }
}

TEST_F(Bench, ContactTellsWhatEachPartCosts) {
  const std::vector<Json> all = rows("contact --cells 8");
  std::vector<std::string> parts;
  for (const Json& row : all) {
    EXPECT_THAT(fields(row), ElementsAre("part", "of", "count", "threads", "ms", "ns_each", "allocations"));
    EXPECT_GT(row["count"], 100) << row;
    EXPECT_GT(row["ms"], 0) << row;
    EXPECT_NEAR(row["ns_each"].get<double>() * row["count"].get<double>(), 1e6 * row["ms"].get<double>(), 1e-6) << row;
    parts.push_back(row["part"]);
    // The lists of pairs and stencils ask for no memory once they have run.
    if (parts.back() == "candidates updated" || parts.back() == "candidates kept" || parts.back() == "active set") {
      EXPECT_EQ(row["allocations"], 0) << row;
    }
  }
  EXPECT_THAT(parts, ElementsAre("candidates from nothing", "candidates updated", "candidates kept", "active set",
                                 "stencil lists", "barrier value", "barrier gradient", "barrier Hessian", "step bound",
                                 "Newton iteration"));
  EXPECT_EQ(ergon("bench contact --cells 0").err, "ergon: error: 0 cells per edge; at least 1 is needed\n");
}

TEST_F(Bench, SceneTellsTimeByPartIterationsAndMemory) {
  write("s.toml",
        "[time]\ndt = 0.01\nsteps = 3\n[[object]]\nname = \"b\"\nbox = { size = [0.1, 0.1, 0.1], cells = [1, 1, 1] }\n"
        "density = 1000\n[[object.energy]]\nlaw = \"stable_neo_hookean\"\nE = 1e5\nnu = 0.3\n");
  const std::vector<Json> all = rows("scene s.toml");
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0]["steps"], 3);
  EXPECT_GT(all[0]["newton_iterations"], 0);
  EXPECT_EQ(all[0]["linear_iterations"], 0);
  EXPECT_GT(all[0]["peak_memory"], 1000000);
  for (const char* part :
       {"mesh", "kernels", "evaluate", "factor", "solve", "line_search", "contact", "output", "total"}) {
    EXPECT_TRUE(all[0]["seconds"].contains(part)) << part;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_F(Bench, CcdMissesNothingByEitherMethod) {
  const std::vector<Json> all = rows("ccd --queries 4000");
  ASSERT_EQ(all.size(), 8u);
  for (const Json& row : all) {
    EXPECT_THAT(fields(row), ElementsAre("set", "method", "primitives", "queries", "median_ns", "mean_ns", "p99_ns",
                                         "false_positives", "without_step", "missed"));
    EXPECT_EQ(row["missed"], 0) << row;
    EXPECT_EQ(row["queries"], row["method"] == "additive" ? 1000 : 50);
    EXPECT_GT(row["median_ns"], 0);
    if (row["set"] == "near_contact") {
      EXPECT_EQ(row["without_step"], 0) << row;
      EXPECT_LT(row["false_positives"], row["method"] == "additive" ? 0.03 : 0.1) << row;
    }
  }
  EXPECT_EQ(ergon("bench ccd --queries 3").err, "ergon: error: 3 queries; at least 100 are needed\n");
  EXPECT_EQ(ergon("bench ccd --kept 1").err, "ergon: error: --kept 1: it is a fraction above 0 and below 1\n");
}

}  // namespace
}  // namespace ergon
