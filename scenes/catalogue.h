#pragma once
// Where energies are found: by name in the catalogue's folders, by path relative to the scene that uses them. Laws of
// contact are composed with distances here.

#include <map>
#include <string>
#include <vector>

#include "symbolic/diagnostic.h"
#include "symbolic/energy.h"

namespace ergon {

class Catalogue {
 public:
  // Every NAME.energy below the folders, by NAME; an earlier folder hides a later one. Throws InputError for a folder
  // that does not exist and for a name that stands twice in one folder.
  explicit Catalogue(const std::vector<std::string>& folders);

  // The folders energies/ and share/ergon/energies/ that exist beside or one above the running program.
  static std::vector<std::string> default_folders();

  // Of all complete energies, sorted; also each barrier over each distance, as "log_barrier:point_edge", with
  // ":offset" behind it where the gap is less than the distance. Throws SourceError for a file without a header.
  std::vector<std::string> names() const;
  std::vector<std::string> distances() const;
  const std::vector<std::string>& folders() const { return folders_; }

  // An energy, or a part of one, by a name as above or by a path in place of the name of the law. Throws SourceError at
  // `place` with the nearest name when there is none.
  Energy read(const std::string& name, const std::string& base, const Place& place) const;
  // The same, complete: a barrier needs a distance. Throws SourceError at `place` that says so.
  Energy read_complete(const std::string& name, const std::string& base, const Place& place) const;

  // The file of a law: a name, or a path ending in .energy (relative to `base`, unless absolute). Throws SourceError at
  // `place` with the nearest name when there is none.
  std::string file_of(const std::string& law, const std::string& base, const Place& place) const;

 private:
  std::vector<std::string> of_kind(Energy::Kind kind) const;

  std::vector<std::string> folders_;
  std::map<std::string, std::string> files_;
};

}  // namespace ergon
