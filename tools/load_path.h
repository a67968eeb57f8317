#pragma once
// The tests that laboratories make of a material: what of F is prescribed at a stretch, what is left free and therefore
// without stress, and which stress is measured. Nominal stress (first Piola-Kirchhoff, force per area at rest; of a
// membrane force per width, of a line force) throughout.
// The tests of rubber: Treloar 1944. Stress-Strain Data for Vulcanised Rubber under Various Types of Deformation.
// Trans. Faraday Society 40.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/law_point.h"

namespace ergon {

struct LoadPath {
  std::string name;           // "uniaxial", "equibiaxial", "pure_shear", "simple_shear", "volumetric"
  Eigen::VectorXd start;      // F at a stretch of 0, column by column
  Eigen::VectorXd direction;  // and how it changes with the stretch, or with the amount of shear
  std::vector<int> free;      // components of F that take the values at which their stress is 0
  std::vector<std::pair<int, double>> measured;  // components of the stress with their weights
  double rest = 1;                               // the stretch, or amount of shear, of the undeformed state
};

// Of a geometry ("solid", "membrane", "line"), in a fixed order. A uniaxial test lets all turn and shear that the law
// wants to, so that it is one of anisotropic laws too.
const std::vector<LoadPath>& load_paths(const std::string& geometry);

struct LoadState {
  Eigen::VectorXd F;
  double stress = 0;
  double energy = 0;
  double slope = 0;         // of the stress by the stretch
  Eigen::VectorXd by_data;  // of the stress by the components of all symbols; those of F are 0
};

// Where the free components are in equilibrium at this stretch: Newton's method on their stress, from `from`, which is
// such a state nearby. Nothing where the law is not defined on the way or no equilibrium is found.
std::optional<LoadState> equilibrium(const LawPoint& law, const LoadPath& path, double stretch, Eigen::VectorXd from,
                                     bool with_data = false);

// The same over stretches in any order: each is reached from the undeformed state, along with those between. Entries
// are empty from where the law is not defined or gives way.
std::vector<std::optional<LoadState>> along(const LawPoint& law, const LoadPath& path,
                                            const std::vector<double>& stretches, bool with_data = false);

}  // namespace ergon
