#include "scenes/scene_reader.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "scenes/scene_keys.h"

namespace ergon {

Scene read_scene_text(std::string_view text, const std::string& file) {
  Scene scene;
  scene.file = file;
  try {
    const toml::table table = toml::parse(text, file);
    read_section(table, scene_section(), file, scene);
  } catch (const toml::parse_error& bad) {
    std::string what(bad.description());
    if (what.find("unescaped control characters") != std::string::npos) what = "this string is not closed in its line";
    // "Error while parsing X: " says nothing that the place does not.
    if (what.starts_with("Error while")) what.erase(0, what.find(": ") + 2);
    throw SourceError(place_of(bad.source(), file), what);
  }
  return scene;
}

Scene read_scene(const std::string& file) {
  std::ifstream in(file);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    throw SourceError(Place{file, 0, 0}, fmt::format("cannot read this scene file: {}", std::strerror(errno)));
  return read_scene_text(text.str(), file);
}

}  // namespace ergon
