#include "scenes/catalogue.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "runtime/error.h"
#include "symbolic/compose.h"

namespace ergon {
namespace fs = std::filesystem;
namespace {

// From its header alone.
Energy::Kind kind_of_file(const std::string& file) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const std::string word = line.substr(0, line.find_first_of(" \t\r"));
    if (word == "density") return Energy::Kind::density;
    if (word == "energy") return Energy::Kind::stencil;
    if (word == "barrier") return Energy::Kind::barrier;
    if (word == "distance") return Energy::Kind::distance;
    if (!word.empty() && word[0] != '#') break;
  }
  return read_energy(file).kind;  // says what is wrong with it
}

// "; did you mean 'mine.energy'?": of the files in the folder of one that is not there.
std::string nearest_beside(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(path.has_parent_path() ? path.parent_path() : fs::path("."), error))
    if (entry.path().extension() == ".energy") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  const std::string nearest = nearest_name(path.stem().string(), names);
  return nearest.empty() ? "" : fmt::format("; did you mean '{}.energy'?", nearest);
}

}  // namespace

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

std::vector<std::string> Catalogue::of_kind(Energy::Kind kind) const {
  std::vector<std::string> out;
  for (const auto& [name, file] : files_)
    if (kind_of_file(file) == kind) out.push_back(name);
  return out;
}

std::vector<std::string> Catalogue::distances() const { return of_kind(Energy::Kind::distance); }

std::vector<std::string> Catalogue::names() const {
  std::vector<std::string> out = of_kind(Energy::Kind::density);
  for (std::string& name : of_kind(Energy::Kind::stencil)) out.push_back(std::move(name));
  for (const std::string& barrier : of_kind(Energy::Kind::barrier))
    for (const std::string& distance : distances())
      for (const char* offset : {"", ":offset"}) out.push_back(fmt::format("{}:{}{}", barrier, distance, offset));
  std::sort(out.begin(), out.end());
  return out;
}

Energy Catalogue::read(const std::string& name, const std::string& base, const Place& place) const {
  ComposedName parts;
  try {
    parts = split_name(name);
  } catch (const std::invalid_argument& error) {
    throw SourceError(place, error.what());
  }
  Energy law = read_energy(file_of(parts.law, base, place));
  if (parts.distance.empty()) return law;
  if (law.kind != Energy::Kind::barrier)
    throw SourceError(place,
                      fmt::format("{} is not a barrier; only a law that begins with `barrier` is composed with a "
                                  "distance",
                                  parts.law));
  const auto distance = files_.find(parts.distance);
  if (distance == files_.end() || kind_of_file(distance->second) != Energy::Kind::distance)
    throw SourceError(place, fmt::format("there is no distance '{}'; known are {}{}", parts.distance,
                                         fmt::join(distances(), ", "), did_you_mean(parts.distance, distances())));
  return compose(law, read_energy(distance->second), parts.offset);
}

Energy Catalogue::read_complete(const std::string& name, const std::string& base, const Place& place) const {
  Energy energy = read(name, base, place);
  if (energy.kind == Energy::Kind::barrier)
    throw SourceError(place, fmt::format("{0} is a barrier over a gap; name the distance with it, as in "
                                         "{0}:point_triangle (known are {1})",
                                         name, fmt::join(distances(), ", ")));
  if (energy.kind == Energy::Kind::distance)
    throw SourceError(place, fmt::format("{0} is a distance; name a barrier with it, as in log_barrier:{0}", name));
  return energy;
}

std::string Catalogue::file_of(const std::string& law, const std::string& base, const Place& place) const {
  if (law.ends_with(".energy")) {
    const fs::path path = fs::path(base) / law;
    if (!fs::is_regular_file(path))
      throw SourceError(place, fmt::format("there is no energy file '{}' (paths are relative to the scene file){}",
                                           path.lexically_normal().string(), nearest_beside(path)));
    return path.lexically_normal().string();
  }
  auto found = files_.find(law);
  if (found == files_.end()) {
    if (fs::is_regular_file(fs::path(base) / (law + ".energy")))
      throw SourceError(place, fmt::format("there is no energy '{0}' in {1}; that of the file {0}.energy is named with "
                                           "the ending: '{0}.energy'",
                                           law, fmt::join(folders_, ", ")));
    std::vector<std::string> files;
    for (const auto& [name, file] : files_) files.push_back(name);
    throw SourceError(place, fmt::format("there is no energy '{}' in {}{}", law, fmt::join(folders_, ", "),
                                         did_you_mean(law, files)));
  }
  return found->second;
}

}  // namespace ergon
