#include <fmt/format.h>

#include <algorithm>

#include "runtime/mesh/surface_readers.h"

namespace ergon {

SurfaceFile read_obj(std::string_view text, const std::string& path) {
  // What a surface's shape does not depend on.
  constexpr std::string_view kIgnored[] = {"vt", "vn", "vp", "g", "o", "s", "l", "p", "usemtl", "mtllib"};
  SurfaceFile surface;
  struct Face {
    std::vector<long long> points;
    int line;
  };
  std::vector<Face> faces;
  TextLines lines(text, path);
  while (lines.next()) {
    const auto& words = lines.words();
    if (words.empty() || words[0][0] == '#') continue;
    if (words[0] == "v") {
      const std::string name = fmt::format("vertex {}: ", surface.points.size() + 1);
      surface.points.emplace_back(lines.number(1, name + "x"), lines.number(2, name + "y"),
                                  lines.number(3, name + "z"));
    } else if (words[0] == "f") {
      Face face{{}, lines.line()};
      for (size_t i = 1; i < words.size() && words[i][0] != '#'; ++i) {
        const std::string_view word = words[i].substr(0, words[i].find('/'));
        const long long number = lines.integer(word, fmt::format("vertex number {} of the face", i));
        const long long count = static_cast<long long>(surface.points.size());
        // Negative numbers count back from the vertices read so far.
        const long long index = number < 0 ? count + number : number - 1;
        if (index < 0) lines.fail(fmt::format("the face names vertex {}, which does not exist", number));
        face.points.push_back(index);
      }
      faces.push_back(std::move(face));
    } else if (std::find(std::begin(kIgnored), std::end(kIgnored), words[0]) == std::end(kIgnored)) {
      lines.fail(fmt::format("unknown keyword '{}'", words[0]));
    }
  }
  // A face may name vertices that follow it.
  for (const Face& face : faces) {
    append_face(face.points, fmt::format("{}:{}", path, face.line), 1, surface);
  }
  return surface;
}

}  // namespace ergon
