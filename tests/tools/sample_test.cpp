#include "tools/sample.h"
#include "tests/paths.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/error.h"
#include "runtime/mesh/mesh_tools.h"

namespace ergon {
namespace {

TEST(Sample, CubeHasSixTetrahedraPerCellAndUnitVolume) {
  const Mesh mesh = sample_mesh(Element::tet4, 3);
  EXPECT_EQ(mesh.cell_count(), 6 * 27);
  double volume = 0;
  for (double v : rest_volumes(mesh)) {
    EXPECT_GT(v, 0);
    volume += v;
  }
  EXPECT_NEAR(volume, 1, 1e-12);
}

TEST(Sample, EveryElementOfTheBenchmarkHasASoundMesh) {
  for (Element element : all_elements()) {
    if (element == Element::point) continue;
    EXPECT_NO_THROW(check_mesh(sample_mesh(element, 2))) << name_of(element);
  }
}

TEST(Sample, NoiseHasTheAmplitudeAskedForAndIsTheSameEveryTime) {
  const Mesh mesh = sample_mesh(Element::tet4, 6);
  const Eigen::Matrix3Xd x = displaced(mesh.X, 1.0 / 6, 0.15 / 6);
  EXPECT_NEAR((x - mesh.X).cwiseAbs().maxCoeff(), 0.15 / 6, 1e-15);
  EXPECT_EQ(x, displaced(mesh.X, 1.0 / 6, 0.15 / 6));
}

TEST(Sample, ValuesAreWithinTheirRanges) {
  const Energy energy = read_energy(test::source("/energies/contact/friction.energy"));
  for (int attempt = 0; attempt < 20; ++attempt) {
    for (Role role : {Role::param, Role::lag}) {
      for (const auto& [name, values] : sample_values(energy, role, attempt)) {
        for (double value : values) EXPECT_TRUE(energy.find(name)->range.contains(value)) << name << " " << value;
      }
    }
  }
  EXPECT_THAT(sample_values(energy, Role::lag, 3).at("n"), testing::ElementsAre(0, 0, 1));
}

}  // namespace
}  // namespace ergon
