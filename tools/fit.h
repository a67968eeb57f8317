#pragma once
// Params of a density from measured stress: least squares by the method of Levenberg and Marquardt, with the declared
// ranges as bounds, from several starts. Derivatives of the stress by the params are those of the law itself, with the
// free stretches following.
// Marquardt 1963. An Algorithm for Least-Squares Estimation of Nonlinear Parameters. J. SIAM 11(2).

#include <map>
#include <string>
#include <vector>

#include "tools/stress_data.h"

namespace ergon {

struct FittedParam {
  std::string name;
  double value = 0;
  double error = 0;        // one standard deviation, if the residual is noise; not a number where undetermined
  bool determined = true;  // false: no change of it, with others following or not, changes the stress by much
  bool at_bound = false;
};

struct Fit {
  std::vector<FittedParam> params;                  // of those that were not given
  std::map<std::string, std::vector<double>> data;  // all params, in SI
  std::vector<double> stress;                       // of the law, at the points
  double rms = 0;                                   // root mean square of the residual, in the stress's unit
  double relative = 0;                              // rms over that of the measured stress
  int iterations = 0;
  bool converged = false;
};

// `given` params stay as they are. Throws InputError when no param is left to find, when there are fewer points than
// params, and when the law is not defined at the points for any start.
Fit fit_params(const Energy& density, const std::vector<StressPoint>& points,
               const std::map<std::string, std::vector<double>>& given);

// Largest difference of the stress's derivatives by the params and central differences of the stress, relative to the
// largest derivative: what says that the fit follows the law.
double derivative_error(const Energy& density, const std::vector<StressPoint>& points,
                        const std::map<std::string, std::vector<double>>& data);

}  // namespace ergon
