// Params from stress: those of a known law come back, rubber is followed as well as its laws can, and what data does
// not tell is named.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "runtime/error.h"
#include "symbolic/diagnostic.h"
#include "tests/paths.h"
#include "tests/symbolic/energy_files.h"
#include "tests/tools/command.h"
#include "tests/tools/xml.h"
#include "tools/fit.h"
#include "tools/law_point.h"
#include "tools/load_path.h"

namespace ergon {
namespace {

using testing::HasSubstr;
using Data = std::map<std::string, std::vector<double>>;

std::vector<StressPoint> made_points(const Energy& energy, const Data& data, const std::vector<std::string>& modes) {
  const std::vector<double> stretches = {0.7, 0.9, 1.1, 1.4, 1.8, 2.3, 2.9};
  std::vector<StressPoint> points;
  for (const LoadPath& path : load_paths(energy.geometry)) {
    if (std::find(modes.begin(), modes.end(), path.name) == modes.end()) continue;
    const auto states = along(LawPoint(energy, "", data), path, stretches);
    for (size_t i = 0; i < stretches.size(); ++i)
      if (states[i]) points.push_back({path.name, stretches[i], states[i]->stress});
  }
  return points;
}

void expect_found_again(const std::string& law, const Data& data, const std::string& known) {
  const Energy& energy = test::shipped(law);
  const std::vector<StressPoint> points =
      made_points(energy, data, {"uniaxial", "equibiaxial", "simple_shear", "volumetric"});
  ASSERT_GE(points.size(), 20u) << law;
  const Fit fit = fit_params(energy, points, known.empty() ? Data{} : Data{{known, data.at(known)}});
  EXPECT_TRUE(fit.converged) << law;
  EXPECT_LT(fit.relative, 1e-9) << law;
  for (const FittedParam& param : fit.params) {
    const double truth = data.at(param.name)[0];
    EXPECT_NEAR(param.value, truth, 1e-6 * std::fabs(truth)) << law << " " << param.name;
    EXPECT_TRUE(param.determined) << law << " " << param.name;
  }
  EXPECT_LT(derivative_error(energy, points, data), 1e-6) << law;
}

TEST(SlowFit, FindsTheParamsOfAKnownLawAgain) {
  expect_found_again("mooney_rivlin", {{"C10", {3e5}}, {"C01", {4e4}}, {"K", {2e7}}}, "");
  expect_found_again("yeoh", {{"C1", {2e5}}, {"C2", {-3e3}}, {"C3", {1e2}}, {"K", {1e7}}}, "");
  expect_found_again("gent", {{"mu", {4e5}}, {"Jm", {60}}, {"K", {1e8}}}, "K");
  expect_found_again("stable_neo_hookean", {{"E", {1e6}}, {"nu", {0.4}}}, "");
  expect_found_again("fung", {{"mu", {1e4}}, {"b", {0.3}}, {"K", {1e6}}}, "");
}

TEST(SlowFit, NamesWhatTheDataDoesNotDetermine) {
  const Energy& energy = test::shipped("mooney_rivlin");
  const Data data = {{"C10", {3e5}}, {"C01", {4e4}}, {"K", {1e10}}};
  auto open = [&](const std::vector<std::string>& modes, const Data& given) {
    std::vector<std::string> names;
    for (const FittedParam& param : fit_params(energy, made_points(energy, data, modes), given).params)
      if (!param.determined) names.push_back(param.name);
    return names;
  };
  // In shear both constants do the same.
  EXPECT_THAT(open({"pure_shear", "simple_shear"}, {{"K", {1e10}}}), testing::ElementsAre("C10", "C01"));
  EXPECT_THAT(open({"uniaxial", "equibiaxial"}, {{"K", {1e10}}}), testing::IsEmpty());
  EXPECT_THAT(open({"uniaxial", "equibiaxial"}, {}), testing::Contains("K"));
}

class FitCommand : public CommandTest {
 protected:
  const std::string treloar = "'" + test::source("/tests/tools/data/treloar.csv") + "'";

  nlohmann::json json(const std::string& arguments) {
    const Answer answer = ergon("fit " + arguments + " --json");
    EXPECT_EQ(answer.code, 0) << answer.err << answer.out;
    return nlohmann::json::parse(answer.out);
  }
  void expect_refused(const std::string& arguments, const std::string& message) {
    const Answer answer = ergon("fit " + arguments);
    EXPECT_EQ(answer.code, 2) << arguments;
    EXPECT_EQ(answer.err, "ergon: error: " + message + "\n");
  }
};

class SlowFitCommand : public FitCommand {};

TEST_F(SlowFitCommand, FollowsTreloarsRubber) {
  // Root mean square of the stress over all three tests, of up to 6.3 MPa.
  const nlohmann::json mooney = json("mooney_rivlin " + treloar + " --set K=1GPa");
  EXPECT_EQ(mooney["points"], 53);
  const nlohmann::json yeoh = json("yeoh " + treloar + " --set K=1GPa");
  EXPECT_LT(yeoh["rms"], 0.15e6);
  EXPECT_LT(mooney["rms"], 0.8e6);
  EXPECT_LT(yeoh["rms"], 0.5 * mooney["rms"].get<double>());
}

// A table whose values are params follows rubber better than any law of the catalogue over the first invariant.
TEST_F(SlowFitCommand, FindsTheValuesOfATable) {
  write("table.energy",
        "density  table  solid\nparam    W1 W2 W3 W4 W5 W6   Pa\nparam    K   Pa   (0, inf)\nlet      J = det(F)\n"
        "require  J > 0\nlet      I = norm2(F)*J^(-2/3) - 3\n"
        "value    spline(I, [0, 1, 10, 30, 45, 52, 56], [0, W1, W2, W3, W4, W5, W6]) + K/2*(J - 1)^2\n");
  const nlohmann::json table = json("table.energy " + treloar + " --set K=1GPa");
  EXPECT_LT(table["rms"], 0.13e6);
  EXPECT_LT(json("data_driven " + treloar + " --set K=1GPa")["rms"], 0.14e6);
}

TEST_F(FitCommand, PrintsWhatASceneTakes) {
  write("rubber.csv",
        "# made up\nstretch,mode,stress (kPa)\n1.5,uniaxial,100\n2, uniaxial , 150 # later\n3,uniaxial,220\n");
  const Answer answer = ergon("fit isochoric_neo_hookean rubber.csv --set K=10MPa --plot fit.svg");
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out, testing::StartsWith("isochoric_neo_hookean: 3 points of rubber.csv\n  mu "));
  EXPECT_THAT(answer.out, HasSubstr("\n[[object.energy]]\nlaw = \"isochoric_neo_hookean\"\nmu = "));
  EXPECT_THAT(answer.out, HasSubstr("\nK = 10000000\n"));
  const std::string svg = read("fit.svg");
  EXPECT_EQ(test::fault_of_xml(svg), "");
  EXPECT_THAT(svg, HasSubstr(">uniaxial, measured<"));
}

TEST_F(FitCommand, ReadsTheCurvesThatArePlotted) {
  ASSERT_EQ(ergon("plot mooney_rivlin --set C10=0.3MPa --set C01=40kPa --set K=20MPa --csv curve.csv").code, 0);
  const nlohmann::json fit = json("mooney_rivlin curve.csv");
  EXPECT_NEAR(fit["params"]["C10"], 3e5, 0.3);
  EXPECT_NEAR(fit["params"]["C01"], 4e4, 0.04);
  EXPECT_NEAR(fit["params"]["K"], 2e7, 20);
}

TEST_F(FitCommand, NamesWhatIsWrongInTheData) {
  auto refused = [&](const std::string& text, const std::string& message) {
    write("d.csv", text);
    expect_refused("neo_hookean d.csv", message);
  };
  expect_refused("neo_hookean none.csv", "none.csv: cannot open the file of measured stress");
  refused("stretch,stress (MPa)\n", "d.csv: holds no measured stress");
  refused("stretch,stress\n1,2\n", "d.csv:1:1: the column 'stress' needs its unit, as `stress (Pa)`");
  refused("stretch,stress (mm)\n1,2\n", "d.csv:1:1: the stress must be in Pa, found mm");
  refused("strain,stress (Pa)\n1,2\n",
          "d.csv:1:1: the first line names the columns, as `mode,stretch,stress (MPa)`; there is none named 'stretch'");
  refused("stretch,stress (Pa)\n1,2,3\n", "d.csv:2:1: expected 2 values, found 3");
  refused("stretch,stress (Pa)\n1,two\n", "d.csv:2:1: expected a number, found 'two'");
  refused("stretch,stress (Pa)\n-0.1,2\n",
          "d.csv:2:1: a stretch is a length over the length at rest, above 0; found -0.1");
  refused("mode,stretch,stress (Pa)\nbiaxial,1.1,2\n",
          "d.csv:2:1: 'biaxial' is none of uniaxial, equibiaxial, pure_shear, simple_shear, volumetric; did you mean "
          "'uniaxial'?");
  refused("stretch,stress (Pa)\n1.1,2\n", "1 points of stress do not determine 2 params");
  write("d.csv", "stretch,stress (Pa)\n1.1,2\n");
  expect_refused("neo_hookean d.csv --set E=1 --set nu=0.3", "neo_hookean has no param left to find");
  expect_refused("spring d.csv", "spring is an energy over edge; stress is measured of densities");
}

}  // namespace
}  // namespace ergon
