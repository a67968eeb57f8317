#include <fmt/format.h>

#include "scenes/scene_keys.h"
#include "scenes/scene_reader.h"

namespace ergon {
namespace {

const char* introduction = R"(# Scenes

A scene is a TOML file. `ergon run FILE` simulates it. Every key is listed here; this page is generated from the table
that the reader itself uses (`scenes/scene_keys.cpp`).

A number is in the SI unit given, or a string with any unit of the same kind: `dt = 0.01`, `dt = "10 ms"`,
`E = "0.5 MPa"`, `rotate = ["90 deg", 0, 0]`. Unknown keys are errors.

```toml
[time]
dt = "10 ms"
end = "2 s"

[[object]]
name = "block"
box = { size = [0.1, 0.1, 0.1], cells = [4, 4, 4] }
translate = [0, 0, 0.2]
density = 1000

[[object.energy]]
law = "stable_neo_hookean"
E = "0.5 MPa"
nu = 0.4

[[ground]]
mu = 0.5
```
)";

void write(const SectionText& section, std::string& out) {
  out += fmt::format("\n## {}\n\n{}\n\n", section.heading == "the scene" ? "Top level" : "`" + section.heading + "`",
                     section.help);
  out += "| key | type | unit | range | default | meaning |\n|---|---|---|---|---|---|\n";
  for (const KeyText& key : section.keys)
    out += fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key.name, key.type, key.unit == "1" ? "" : key.unit,
                       key.range, key.fallback, key.help);
  for (const SectionText& inner : section.sections) write(inner, out);
}

}  // namespace

std::string scene_reference_markdown() {
  std::string out = introduction;
  write(text_of(scene_section()), out);
  return out;
}

}  // namespace ergon
