#pragma once
// A scene file whose values can be replaced before it is read, for sweeps and for trying a value from the command line.

#include <toml++/toml.h>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenes/scene.h"
#include "symbolic/diagnostic.h"

namespace ergon {

class SceneText {
 public:
  // Throws SourceError where the file cannot be read or is not TOML. What its keys are is not looked at.
  explicit SceneText(const std::string& file);

  const std::string& file() const { return file_; }

  // Replaces or adds a value. `path`: keys joined by dots; one of several tables by its `name`, or by its number from
  // 0: "time.dt", "object.beam.energy.0.E". Throws SourceError at `place` where no table is on the way there.
  void set(const std::string& path, const toml::node& value, const Place& place);

  // The files that the scene names, as paths from the working directory, each once, in the order of the scene.
  std::vector<std::string> files() const;
  // The same scene naming other files in their place.
  void rename_files(const std::vector<std::pair<std::string, std::string>>& to);

  std::string text() const;
  // Throws SourceError, at the places of the file where its values are still there.
  Scene read() const;

 private:
  template <class F>
  void for_each_file(F f);

  std::string file_;
  std::string folder_;  // that its paths are relative to
  toml::table table_;
};

// "PATH=VALUE" of a command line: the value as TOML, or else as a string. Throws SourceError at `place`.
std::pair<std::string, toml::table> read_change(const std::string& text, const Place& place);

}  // namespace ergon
