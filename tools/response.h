#pragma once
// How a law answers to deformation, as curves: stress against stretch of a density, force or moment and energy against
// length, angle or distance of a stencil energy.

#include <map>
#include <string>
#include <vector>

#include "symbolic/energy.h"
#include "tools/svg.h"

namespace ergon {

struct ResponseCurve {
  std::string mode;                     // of a density, as LoadPath names it; of a stencil, as StencilPath does
  std::string quantity, quantity_unit;  // "stretch", "1"
  std::vector<double> x, force,
      energy;  // NaN where the law is not defined; force is the energy's slope by x, or stress
};

struct Response {
  std::string name;  // of the energy
  std::string force, force_unit, energy_unit;
  std::map<std::string, std::vector<double>> data;  // what was used of params, rest and lag data
  std::vector<ResponseCurve> curves;
};

struct ResponseOptions {
  std::map<std::string, std::vector<double>> given{};  // params, rest and lag data in SI; the rest is usual_data()
  double low = 0, high = 0;                            // of the stretch, or of a stencil's quantity; 0, 0: as is usual
  std::vector<std::string> modes{};                    // these only; none: all
  int samples = 200;
};

// The modes of an energy: names of LoadPath or StencilPath.
std::vector<std::string> modes_of(const Energy& energy);

// Of a complete energy without cases, or in its first case. Curves that are zero throughout are left out. Throws
// InputError for a mode that there is none of, with the nearest.
Response response_of(const Energy& energy, const ResponseOptions& options);

// Stress of stretching, of shear and of volume apart; of stencils force and energy apart.
std::vector<Chart> charts_of(const Response& response);

// Lines `mode,stretch,stress (Pa),energy (J/m^3)` under such a header, with the names and units of the response.
std::string csv_of(const Response& response);

// "mu = 1 Pa, K = 100 Pa", of params, and of rest and lag data that was used.
std::string data_text(const Energy& energy, const std::map<std::string, std::vector<double>>& data);

}  // namespace ergon
