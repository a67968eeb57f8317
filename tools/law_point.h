#pragma once
// One stencil, or one material point of a density, in doubles: value and derivatives by its dofs and by its data, of
// the energy as it is written. For curves and fits, where one state is looked at at a time.

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "symbolic/cln_algebra.h"
#include "symbolic/energy.h"

namespace ergon {

struct LawState {
  double value = 0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
  bool active = true;   // all `active` conditions hold
  bool defined = true;  // all `require` conditions hold, and value and derivatives are finite
};

class LawPoint {
 public:
  // `data` holds params, rest and lag data by name, in SI, components column by column; all of them. The energy must
  // outlive this.
  LawPoint(const Energy& energy, std::string case_name, const std::map<std::string, std::vector<double>>& data);

  // Derivatives by the components of the dofs, in order of declaration.
  LawState at(const Eigen::VectorXd& dofs) const { return evaluate(dofs, false); }
  // Derivatives by the components of all symbols, in order of declaration.
  LawState with_data(const Eigen::VectorXd& dofs) const { return evaluate(dofs, true); }

  const Energy& energy() const { return *energy_; }
  int dofs() const { return dofs_; }

 private:
  LawState evaluate(const Eigen::VectorXd& dofs, bool all) const;

  const Energy* energy_;
  std::string case_name_;
  ExactInputs inputs_;
  int dofs_ = 0;
};

// Data for a first look: what is `given`, and for all else a value within its range: 1 in SI, but 0.3 for a Poisson's
// ratio `nu`, 100 for a bulk modulus `K`, the middle of a finite range, 0 for places and for quantities with a unit
// that may have either sign; of vectors the first axis. Rest and lag data named after a dof (X0, x0lag of x0) are left
// to the caller.
std::map<std::string, std::vector<double>> usual_data(const Energy& energy,
                                                      const std::map<std::string, std::vector<double>>& given);

}  // namespace ergon
