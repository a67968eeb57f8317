#pragma once
// Where energies are found: by name in the catalogue's folders, by path relative to the scene that uses them.

#include <map>
#include <string>
#include <vector>

#include "symbolic/diagnostic.h"

namespace ergon {

class Catalogue {
 public:
  // Every NAME.energy below the folders, by NAME; an earlier folder hides a later one. Throws InputError for a folder
  // that does not exist and for a name that stands twice in one folder.
  explicit Catalogue(const std::vector<std::string>& folders);

  // The folders energies/ and share/ergon/energies/ that exist beside or one above the running program.
  static std::vector<std::string> default_folders();

  std::vector<std::string> names() const;  // sorted
  const std::vector<std::string>& folders() const { return folders_; }

  // The file of a law: a name, or a path ending in .energy (relative to `base`, unless absolute). Throws SourceError at
  // `place` with the nearest name when there is none.
  std::string file_of(const std::string& law, const std::string& base, const Place& place) const;

 private:
  std::vector<std::string> folders_;
  std::map<std::string, std::string> files_;
};

}  // namespace ergon
