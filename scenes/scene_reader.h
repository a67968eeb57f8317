#pragma once
// Scene files: TOML in, Scene out, every key checked; and the reference of all keys, from the same table.

#include <string>
#include <string_view>

#include "scenes/scene.h"

namespace ergon {

// Throws SourceError at the place of the first thing that is not right: syntax, unknown keys (with the nearest known
// one), types, units, ranges, keys that are missing or contradict each other. `file` is kept for messages and relative
// paths.
Scene read_scene_text(std::string_view text, const std::string& file);
// The same from a file; one that cannot be read is a SourceError too.
Scene read_scene(const std::string& file);

// scenes/README.md: every key with type, unit, range, default and help.
std::string scene_reference_markdown();

}  // namespace ergon
