#include "scenes/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "runtime/error.h"

namespace ergon {
namespace fs = std::filesystem;

Catalogue::Catalogue(const std::vector<std::string>& folders) : folders_(folders) {
  for (const std::string& folder : folders) {
    if (!fs::is_directory(folder)) throw InputError(fmt::format("{}: there is no such folder of energies", folder));
    std::map<std::string, std::string> here;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file() || entry.path().extension() != ".energy") continue;
      auto [first, is_new] = here.emplace(entry.path().stem().string(), entry.path().string());
      if (!is_new) {
        std::array both = {first->second, entry.path().string()};
        std::sort(both.begin(), both.end());
        throw InputError(fmt::format("two energies are named '{}': {} and {}", first->first, both[0], both[1]));
      }
    }
    files_.insert(here.begin(), here.end());
  }
}

std::vector<std::string> Catalogue::default_folders() {
  std::vector<std::string> out;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const char* place : {"energies", "../energies", "../share/ergon/energies"}) {
    fs::path folder = fs::weakly_canonical(program / place, error);
    if (!fs::is_directory(folder, error)) continue;
    if (std::find(out.begin(), out.end(), folder.string()) == out.end()) out.push_back(folder.string());
  }
  return out;
}

std::vector<std::string> Catalogue::names() const {
  std::vector<std::string> out;
  for (const auto& [name, file] : files_) out.push_back(name);
  return out;
}

std::string Catalogue::file_of(const std::string& law, const std::string& base, const Place& place) const {
  if (law.ends_with(".energy")) {
    const fs::path path = fs::path(base) / law;
    if (!fs::is_regular_file(path))
      throw SourceError(place, fmt::format("there is no energy file '{}' (paths are relative to the scene file)",
                                           path.lexically_normal().string()));
    return path.lexically_normal().string();
  }
  auto found = files_.find(law);
  if (found == files_.end())
    throw SourceError(place, fmt::format("there is no energy '{}' in {}{}", law, fmt::join(folders_, ", "),
                                         did_you_mean(law, names())));
  return found->second;
}

}  // namespace ergon
