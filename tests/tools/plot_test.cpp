// Curves of laws against closed forms, and what is drawn of them.

#include <gmock/gmock.h>

#include <cmath>

#include "runtime/error.h"
#include "symbolic/stretches.h"
#include "tests/symbolic/energy_files.h"
#include "tests/tools/command.h"
#include "tests/tools/xml.h"
#include "tools/law_point.h"
#include "tools/load_path.h"
#include "tools/response.h"
#include "tools/svg.h"

namespace ergon {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const LoadPath& load_path(const std::string& geometry, const std::string& name) {
  for (const LoadPath& path : load_paths(geometry))
    if (path.name == name) return path;
  throw std::invalid_argument(name);
}

using Values = std::map<std::string, std::vector<double>>;

double stress_at(const std::string& law, const Values& data, const std::string& mode, double stretch) {
  const Energy& energy = test::shipped(law);
  const auto found = along(LawPoint(energy, "", data), load_path(energy.geometry, mode), {stretch});
  return found[0] ? found[0]->stress : std::nan("");
}

// Rivlin 1948. Large Elastic Deformations of Isotropic Materials. IV. Phil. Trans. A 241: incompressible; here nearly.
TEST(LoadPath, RubberFollowsItsClosedFormsInTheIncompressibleLimit) {
  const Values neo = {{"mu", {2}}, {"K", {1e9}}}, mooney = {{"C10", {0.7}}, {"C01", {0.3}}, {"K", {1e9}}};
  for (const double l : {0.5, 0.8, 1.0, 1.5, 3.0, 4.0}) {
    const double uniaxial = l - std::pow(l, -2), equibiaxial = l - std::pow(l, -5), pure = l - std::pow(l, -3);
    auto expect = [&](const char* law, const Values& data, const char* mode, double closed) {
      EXPECT_NEAR(stress_at(law, data, mode, l), closed, 1e-6 * (1 + std::fabs(closed)))
          << law << " " << mode << " " << l;
    };
    expect("isochoric_neo_hookean", neo, "uniaxial", 2 * uniaxial);
    expect("isochoric_neo_hookean", neo, "equibiaxial", 2 * equibiaxial);
    expect("isochoric_neo_hookean", neo, "pure_shear", 2 * pure);
    expect("isochoric_neo_hookean", neo, "simple_shear", 2 * l);
    expect("mooney_rivlin", mooney, "uniaxial", 2 * (0.7 + 0.3 / l) * uniaxial);
    expect("mooney_rivlin", mooney, "equibiaxial", 2 * (0.7 + 0.3 * l * l) * equibiaxial);
    expect("mooney_rivlin", mooney, "pure_shear", 2 * pure);
    expect("mooney_rivlin", mooney, "simple_shear", 2 * l);
  }
  for (const double l : {0.9, 1.2})
    EXPECT_NEAR(stress_at("mooney_rivlin", {{"C10", {0.7}}, {"C01", {0.3}}, {"K", {5}}}, "volumetric", l),
                5 * (l * l * l - 1) * l * l, 1e-12);
}

TEST(LoadPath, FreeStretchesLeaveNoStressAcross) {
  // Fibres at an angle turn and shear a body that is pulled along one axis alone.
  const Energy& energy = test::shipped("fibre_reinforced");
  const LawPoint law(energy, "", {{"mu", {1}}, {"la", {5}}, {"k1", {2}}, {"k2", {0.5}}, {"a", {1, 1, 0.5}}});
  const LoadPath& uniaxial = load_path("solid", "uniaxial");
  const auto found = along(law, uniaxial, {1.3});
  ASSERT_TRUE(found[0]);
  const Eigen::VectorXd stress = law.at(found[0]->F).gradient;
  EXPECT_GT(stress[0], 0.5);
  EXPECT_LT(stress.tail(8).norm(), 1e-9);
  EXPECT_GT(std::fabs(found[0]->F[3]), 0.01);  // it has sheared
}

TEST(LoadPath, SlopesAreThoseOfTheCurve) {
  const Energy& energy = test::shipped("yeoh");
  const Values data = {{"C1", {1}}, {"C2", {-0.1}}, {"C3", {0.02}}, {"K", {30}}};
  const double h = 1e-5;
  for (const LoadPath& path : load_paths("solid")) {
    const double s = path.rest == 0 ? 0.7 : 1.4;
    auto stress = [&](const Values& at, double stretch) {
      return along(LawPoint(energy, "", at), path, {stretch})[0]->stress;
    };
    const auto state = along(LawPoint(energy, "", data), path, {s}, true)[0];
    ASSERT_TRUE(state) << path.name;
    EXPECT_NEAR(state->slope, (stress(data, s + h) - stress(data, s - h)) / (2 * h), 1e-6 * std::fabs(state->slope))
        << path.name;
    Eigen::Index k = 9;
    for (const char* name : {"C1", "C2", "C3", "K"}) {
      Values up = data, down = data;
      up[name][0] += h;
      down[name][0] -= h;
      EXPECT_NEAR(state->by_data[k++], (stress(up, s) - stress(down, s)) / (2 * h), 1e-6) << path.name << " " << name;
    }
  }
}

TEST(LoadPath, EndsWhereTheLawDoes) {
  // I reaches Jm = 2 at a stretch of 2.15.
  const Energy& energy = test::shipped("gent");
  const LawPoint law(energy, "", {{"mu", {1}}, {"Jm", {2}}, {"K", {1e3}}});
  const auto found = along(law, load_path("solid", "uniaxial"), {3, 1, 0.8, 2, 2.3});
  EXPECT_FALSE(found[0]);
  EXPECT_NEAR(found[1]->stress, 0, 1e-12);
  EXPECT_LT(found[2]->stress, 0);
  EXPECT_GT(found[3]->stress, 2);
  EXPECT_FALSE(found[4]);
}

TEST(Response, StencilsShowForceAndEnergyAlongTheirMotion) {
  ResponseOptions options;
  options.given = {{"k", {3}}};
  options.samples = 3;
  options.low = 1;
  options.high = 2;
  const Response spring = response_of(test::shipped("spring"), options);
  ASSERT_EQ(spring.curves.size(), 1u);
  EXPECT_EQ(spring.force_unit, "N");
  EXPECT_THAT(spring.curves[0].x, ElementsAre(1, 1.5, 2));
  EXPECT_THAT(spring.curves[0].force, ElementsAre(0, 1.5, 3));
  EXPECT_THAT(spring.curves[0].energy, ElementsAre(0, 0.375, 1.5));

  options.low = -1;
  options.high = 1;
  const Response hinge = response_of(test::shipped("discrete_shell_hinge"), options);
  EXPECT_EQ(hinge.force_unit, "N*m");
  // 3 k |E|^2/(A2 + A3) bend^2 with |E| = 1 and areas 1/2.
  EXPECT_NEAR(hinge.curves[0].force[2], 6 * 3, 1e-12);
  EXPECT_NEAR(hinge.curves[0].force[0], -18, 1e-12);
  EXPECT_NEAR(hinge.curves[0].energy[2], 9, 1e-12);

  options.low = 0.25;
  options.high = 1.25;
  options.given = {{"dhat", {1}}, {"kappa", {2}}};
  const Response barrier = response_of(test::shipped("log_barrier:point_point"), options);
  EXPECT_NEAR(barrier.curves[0].energy[0], -2 * 0.75 * 0.75 * std::log(0.25), 1e-14);
  EXPECT_EQ(barrier.curves[0].force[2], 0);
}

TEST(Response, EveryEnergyOfTheCatalogueHasACurve) {
  for (const Energy& energy : test::catalogue()) {
    if (energy.name.ends_with(":offset")) continue;
    ResponseOptions options;
    options.samples = 20;
    const Response response = response_of(energy, options);
    ASSERT_FALSE(response.curves.empty()) << energy.name;
    // Where two singular values meet, as the lateral ones do, they have no derivatives by themselves, and the search
    // for an equilibrium may end there.
    const int fewest = uses_stretches(energy) ? 2 : 5;
    for (const ResponseCurve& curve : response.curves)
      EXPECT_GE(std::count_if(curve.force.begin(), curve.force.end(), [](double f) { return std::isfinite(f); }),
                fewest)
          << energy.name << " " << curve.mode;
    const std::string svg = svg_of(charts_of(response), energy.name);
    EXPECT_EQ(test::fault_of_xml(svg), "") << energy.name;
    for (const char* none : {"nan,", ",nan", "\"nan", "inf,", ",inf"})
      EXPECT_EQ(svg.find(none), std::string::npos) << energy.name;
  }
}

TEST(Svg, TicksAreRoundAndCover) {
  EXPECT_THAT(axis_ticks(0, 1, 5, false),
              ElementsAre(0, 0.2, testing::DoubleEq(0.4), testing::DoubleNear(0.6, 1e-15), 0.8, 1));
  EXPECT_THAT(axis_ticks(-37, 121, 5, false), ElementsAre(-50, 0, 50, 100, 150));
  EXPECT_THAT(axis_ticks(3, 3, 4, false), testing::SizeIs(testing::Ge(2)));
  EXPECT_THAT(axis_ticks(2, 30, 6, true), ElementsAre(1, 2, 5, 10, 20, 50, 100));
  EXPECT_THAT(axis_ticks(1e-8, 1, 4, true), ElementsAre(1e-8, 1e-6, testing::DoubleNear(1e-4, 1e-18), 0.01, 1));
}

TEST(Svg, LinesBreakWhereThereIsNoNumber) {
  const double none = std::nan("");
  const std::string svg =
      svg_of({{"a < b & c",
               "x (m)",
               "y",
               {{"first", {1, 2, 3, 4, 5}, {1, 2, none, 4, 5}, false}, {"measured", {1, 2}, {3, 4}, true}},
               false,
               true}},
             "title");
  EXPECT_EQ(test::fault_of_xml(svg), "");
  EXPECT_EQ(test::count_of(svg, "<polyline"), 2);
  EXPECT_EQ(test::count_of(svg, "<circle"), 3);  // and one in the legend
  EXPECT_THAT(svg, HasSubstr(">a &lt; b &amp; c</text>"));
  EXPECT_EQ(test::fault_of_xml(svg.substr(0, svg.size() / 2)).empty(), false);
}

class Plot : public CommandTest {};

TEST_F(Plot, DrawsCurvesAndWritesNumbers) {
  const Answer answer =
      ergon("plot mooney_rivlin --set C10=0.2MPa --set C01=20kPa --set K=2GPa --out rubber.svg --csv rubber.csv");
  ASSERT_EQ(answer.code, 0) << answer.err;
  EXPECT_THAT(answer.out,
              testing::StartsWith("rubber.svg: mooney_rivlin with C10 = 200000 Pa, C01 = 20000 Pa, K = 2e+09 Pa\n"
                                  "  uniaxial      stretch 0.4 to 3, nominal stress "));
  const std::string svg = read("rubber.svg");
  EXPECT_EQ(test::fault_of_xml(svg), "");
  EXPECT_EQ(test::count_of(svg, "class=\"curve\""), 5);
  EXPECT_EQ(test::count_of(svg, "<polyline"), 5);
  for (const char* label : {">uniaxial<", ">equibiaxial<", ">pure shear<", ">simple shear<", ">volumetric<",
                            ">nominal stress (Pa) / 10<", ">stretch<", ">amount of shear<"})
    EXPECT_THAT(svg, HasSubstr(label));
  std::istringstream csv(read("rubber.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "mode,stretch,stress (Pa),energy (J/m^3)");
  int rows = 0;
  while (std::getline(csv, line)) ++rows;
  EXPECT_EQ(rows, 1000);
}

TEST_F(Plot, NamesWhatIsWrong) {
  auto message = [&](const std::string& arguments) { return ergon("plot " + arguments).err; };
  EXPECT_EQ(
      message("neo_hookean --mode unaxial"),
      "ergon: error: --mode: 'unaxial' is none of uniaxial, equibiaxial, pure_shear, simple_shear, volumetric; did "
      "you mean 'uniaxial'?\n");
  EXPECT_EQ(message("neo_hookean --from 2 --to 1"), "ergon: error: --from: 2 is not below --to, which is 1\n");
  EXPECT_EQ(message("neo_hookean --out no/such/folder.svg"),
            "ergon: error: no/such/folder.svg: cannot be written: No such file or directory\n");
  EXPECT_EQ(ergon("plot log_barrier --out barrier.svg").code, 0);
  EXPECT_THAT(read("barrier.svg"), HasSubstr(">distance (m)<"));
}

}  // namespace
}  // namespace ergon
