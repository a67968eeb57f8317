#include "scenes/scene_reader.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "scenes/scene_keys.h"

namespace ergon {

toml::table parse_scene(std::string_view text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& bad) {
    std::string what(bad.description());
    if (what.find("unescaped control characters") != std::string::npos) what = "this string is not closed in its line";
    // "Error while parsing X: " says nothing that the place does not.
    if (what.starts_with("Error while")) what.erase(0, what.find(": ") + 2);
    throw SourceError(place_of(bad.source(), file), what);
  }
}

Scene read_scene_text(std::string_view text, const std::string& file) {
  Scene scene;
  scene.file = file;
  read_section(parse_scene(text, file), scene_section(), file, scene);
  return scene;
}

std::string read_scene_file_text(const std::string& file) {
  std::ifstream in(file);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    throw SourceError(Place{file, 0, 0}, fmt::format("cannot read this scene file: {}", std::strerror(errno)));
  return text.str();
}

Scene read_scene(const std::string& file) { return read_scene_text(read_scene_file_text(file), file); }

}  // namespace ergon
