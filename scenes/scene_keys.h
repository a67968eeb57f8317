#pragma once
// Every key of a scene, table by table.

#include "scenes/keys.h"

namespace ergon {

Section<Scene> scene_section();

// The steps of reading one: the text of a file, and its tables. Throw SourceError.
std::string read_scene_file_text(const std::string& file);
toml::table parse_scene(std::string_view text, const std::string& file);

}  // namespace ergon
