#pragma once
// Measured stress against stretch, from a text file.

#include <string>
#include <vector>

#include "symbolic/energy.h"

namespace ergon {

struct StressPoint {
  std::string mode;    // as LoadPath names it
  double stretch = 1;  // of simple shear the amount of shear
  double stress = 0;   // SI, nominal
};

// Reads lines of values with commas between, under a line of the columns' names: `stretch` and `stress (UNIT)`, and
// `mode` unless all is uniaxial; other columns are left alone, `#` starts a comment. Throws SourceError at the line for
// a column that is missing, a unit that is not that of the density's stress, a mode that the density has none of, a
// number that cannot be read, a stretch that is not above 0, and a file without data.
std::vector<StressPoint> read_stress_data(const std::string& file, const Energy& density);

}  // namespace ergon
