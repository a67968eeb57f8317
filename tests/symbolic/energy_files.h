#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "symbolic/compose.h"
#include "tests/paths.h"

namespace ergon::test {

inline std::string contents(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

// All .energy files below a folder of the source tree, sorted.
inline std::vector<std::filesystem::path> energy_files(const std::string& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source() + "/" + folder))
    if (entry.path().extension() == ".energy") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

// All complete energies of the catalogue, sorted by name.
inline const std::vector<Energy>& catalogue() {
  static const std::vector<Energy> energies = energies_below(test::source("/energies"));
  return energies;
}

inline std::vector<std::string> catalogue_names() {
  std::vector<std::string> names;
  for (const Energy& energy : catalogue()) names.push_back(energy.name);
  return names;
}

// One of them.
inline const Energy& shipped(const std::string& name) {
  for (const Energy& energy : catalogue())
    if (energy.name == name) return energy;
  throw std::invalid_argument("the catalogue has no energy " + name);
}

// The name of a test of an energy and, unless it is empty, of one of its cases.
inline std::string name_of_test(const std::string& energy, const std::string& case_name = "") {
  std::string name = case_name.empty() ? energy : energy + "_" + case_name;
  std::replace(name.begin(), name.end(), ':', '_');
  return name;
}

}  // namespace ergon::test
