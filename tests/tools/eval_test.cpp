#include <gmock/gmock.h>
#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include "symbolic/reference.h"
#include "tests/paths.h"
#include "tests/tools/command.h"

namespace ergon {
namespace {

// One tetrahedron of volume 1/6 and its state under x = F X.
constexpr const char* kMesh =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
    "$Elements\n1\n1 4 2 1 1 1 2 3 4\n$EndElements\n";
constexpr const char* kPositions = "0 0 0\n1.25 0.5 0\n0.125 0.75 -0.25\n0 0.0625 1.5\n";
const std::vector<double> kF = {1.25, 0.5, 0, 0.125, 0.75, -0.25, 0, 0.0625, 1.5};

class Eval : public CommandTest {
 protected:
  void SetUp() override {
    CommandTest::SetUp();
    write("tet.msh", kMesh);
    write("x.txt", kPositions);
  }
  nlohmann::ordered_json json(const std::string& arguments) {
    const Answer answer = ergon("eval " + arguments + " --json");
    EXPECT_EQ(answer.code, 0) << answer.err;
    return nlohmann::ordered_json::parse(answer.out);
  }
  void expect_error(const std::string& arguments, const std::string& message) {
    const Answer answer = ergon("eval " + arguments);
    EXPECT_EQ(answer.code, 2) << arguments;
    EXPECT_EQ(answer.err, "ergon: error: " + message + "\n");
  }
};

TEST_F(Eval, AgreesWithTheReferenceOfTheSameEnergy) {
  const nlohmann::ordered_json result = json(
      "stable_neo_hookean --mesh tet.msh --positions x.txt --set E=0.1MPa --set nu=0.3 --project none "
      "--gradient g.mtx --hessian H.mtx");
  std::vector<std::string> fields;
  for (const auto& item : result.items()) fields.push_back(item.key());
  EXPECT_THAT(fields, testing::ElementsAre("value", "gradient_norm", "hessian_frobenius", "elements", "indefinite"));
  EXPECT_EQ(result["elements"], 1);
  EXPECT_EQ(result["indefinite"], 0);

  const Energy energy = read_energy(test::source("/energies/solids/stable_neo_hookean.energy"));
  const ReferenceValue reference = evaluate_reference(energy, "", {{"F", kF}, {"E", {1e5}}, {"nu", {0.3}}});
  // The corners' shape function gradients are the unit vectors and minus their sum: x_a depends on F's column a-1.
  Eigen::Matrix<double, 9, 12> chain = Eigen::Matrix<double, 9, 12>::Zero();
  for (int a = 0; a < 3; ++a) {
    chain.block<3, 3>(3 * a, 3 * (a + 1)).setIdentity();
    chain.block<3, 3>(3 * a, 0) = -Eigen::Matrix3d::Identity();
  }
  const double volume = 1.0 / 6;
  const Eigen::Matrix<double, 12, 1> gradient =
      volume * chain.transpose() * Eigen::Map<const Eigen::VectorXd>(reference.gradient.data(), 9);
  const Eigen::Matrix<double, 12, 12> hessian =
      volume * chain.transpose() * Eigen::Map<const Eigen::MatrixXd>(reference.hessian.data(), 9, 9) * chain;
  EXPECT_NEAR(result["value"], volume * reference.value, 1e-13 * volume * reference.value);
  EXPECT_NEAR(result["gradient_norm"], gradient.norm(), 1e-13 * gradient.norm());
  EXPECT_NEAR(result["hessian_frobenius"], hessian.norm(), 1e-13 * hessian.norm());

  std::istringstream text(read("g.mtx"));
  std::string header;
  std::getline(text, header);
  EXPECT_EQ(header, "%%MatrixMarket matrix array real general");
  int rows = 0, cols = 0;
  text >> rows >> cols;
  ASSERT_EQ(rows, 12);
  ASSERT_EQ(cols, 1);
  for (int i = 0; i < 12; ++i) {
    double component = 0;
    text >> component;
    EXPECT_NEAR(component, gradient[i], 1e-12 * gradient.norm());
  }
  std::istringstream matrix(read("H.mtx"));
  std::getline(matrix, header);
  int entries = 0;
  matrix >> rows >> cols >> entries;
  ASSERT_EQ(entries, 78);
  for (int k = 0; k < entries; ++k) {
    int i = 0, j = 0;
    double value = 0;
    matrix >> i >> j >> value;
    EXPECT_NEAR(value, hessian(i - 1, j - 1), 1e-12 * hessian.norm());
  }
}

TEST_F(Eval, CountsWhatProjectionChanges) {
  // Compressed springs push sideways: the three edges at the corner are halved, the others shortened too.
  write("half.txt", "0 0 0\n0.5 0 0\n0 0.5 0\n0 0 0.5\n");
  const std::string spring = "spring --mesh tet.msh --positions half.txt --set k=2 --project ";
  EXPECT_EQ(json(spring + "clamp")["indefinite"], 6);
  EXPECT_EQ(json(spring + "none")["indefinite"], 0);
  // Three edges shortened by 1/2, three by sqrt(2)/2.
  EXPECT_NEAR(json(spring + "none")["value"], 3 * 0.25 + 3 * 0.5, 1e-14);
  EXPECT_LT(json(spring + "clamp")["hessian_frobenius"], json(spring + "none")["hessian_frobenius"]);
}

TEST_F(Eval, KeepsOnlyActiveStencils) {
  const std::string barrier = "log_barrier:half_space --mesh tet.msh --set n=0,0,1 --set kappa=3 ";
  // Three vertices at z = 0 are 0.25 above the plane, one at z = 1 is beyond dhat.
  const nlohmann::ordered_json result = json(barrier + "--set height=-0.25 --set dhat=0.5");
  EXPECT_EQ(result["elements"], 3);
  EXPECT_NEAR(result["value"], 3 * 3 * 0.0625 * std::log(2.0), 1e-14);
  expect_error(
      barrier + "--set height=0.25 --set dhat=\"0.5 m\"",
      "tet.msh: log_barrier:half_space is not defined at these positions: a `require` condition does not hold, or its "
      "value is not finite");
}

TEST_F(Eval, RestStateIsTheDefault) {
  EXPECT_EQ(json("stable_neo_hookean --mesh tet.msh --set E=1 --set nu=0.3")["gradient_norm"], 0);
}

TEST_F(Eval, BadInputIsNamed) {
  const std::string tet = " --mesh tet.msh ";
  expect_error("stable_neo_hookean" + tet + "--set E=1",
               "stable_neo_hookean needs 'nu': Poisson's ratio, in (-1, 0.5); give it with --set nu=VALUE");
  expect_error("stable_neo_hookean" + tet + "--set E=1 --set nu=0.5", "--set: 'nu' must be in (-1, 0.5), found '0.5'");
  expect_error("stable_neo_hookean" + tet + "--set E=1mm", "--set: 'E' must be in Pa, found '1mm', which is in m");
  expect_error("stable_neo_hookean" + tet + "--set Nu=1",
               "--set: stable_neo_hookean has no input 'Nu' (its inputs: E, nu); did you mean 'nu'?");
  expect_error("stable_neo_hookean" + tet + "--set E=1 --set E=2", "--set: 'E' is given twice");
  expect_error("stable_neo_hookean" + tet + "--set E", "--set: 'E' is not NAME=VALUE");
  expect_error("log_barrier:half_space" + tet + "--set n=0,1", "--set: 'n' is a vector of 3, found 2 numbers");
  expect_error("spring" + tet + "--set k=1 --project clmp",
               "--project: 'clmp' is none of clamp, abs, none; did you mean 'clamp'?");
  write("short.txt", "0 0 0\n");
  expect_error("spring" + tet + "--set k=1 --positions short.txt", "short.txt: 1 vertices, the mesh has 4");
  expect_error("spring --mesh none.msh --set k=1", "none.msh: cannot be opened: No such file or directory");
}

TEST_F(Eval, OneStateIsEvaluatedWithoutAMesh) {
  const Answer answer =
      ergon("eval spring --set x0=0,0,0 --set x1=3,0,0 --set X0=0,0,0 --set X1=1,0,0 --set k=2 --json");
  EXPECT_EQ(answer.code, 0) << answer.err;
  const auto row = nlohmann::json::parse(answer.out);
  EXPECT_EQ(row["value"], 4);
  EXPECT_DOUBLE_EQ(row["gradient_norm"].get<double>(), std::sqrt(32.0));
  EXPECT_EQ(row["require"], 1);
  EXPECT_TRUE(row["active"].is_null());
  const Answer collapsed = ergon("eval spring --set x0=0,0,0 --set x1=0,0,0 --set X0=0,0,0 --set X1=1,0,0 --set k=2");
  EXPECT_EQ(collapsed.code, 0);
  EXPECT_THAT(collapsed.out, testing::HasSubstr("nan"));
  EXPECT_EQ(ergon("eval spring --set k=2").err,
            "ergon: error: without --mesh every input is given by --set; 'x0' is missing\n");
}

}  // namespace
}  // namespace ergon
