#pragma once
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

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
  for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(ERGON_SOURCE_DIR) + "/" + folder))
    if (entry.path().extension() == ".energy") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace ergon::test
