#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "runtime/error.h"
#include "runtime/mesh/surface_readers.h"

namespace ergon {
namespace {

constexpr size_t kHeader = 84;  // 80 bytes of comment and the number of triangles
constexpr size_t kRecord = 50;  // a normal, three vertices, two bytes of attributes

std::uint32_t little_endian_32(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = (value << 8) | static_cast<unsigned char>(bytes[i]);
  return value;
}

SurfaceFile read_binary(std::string_view data, const std::string& path) {
  if (data.size() < kHeader) {
    throw InputError(fmt::format("{}: {} bytes are neither a text nor a binary STL file", path, data.size()));
  }
  const std::uint64_t count = little_endian_32(data.data() + 80);
  if (data.size() < kHeader + count * kRecord) {
    throw InputError(fmt::format("{}: announces {} triangles, which take {} bytes, but has only {}", path, count,
                                 kHeader + count * kRecord, data.size()));
  }
  SurfaceFile surface;
  for (std::uint64_t t = 0; t < count; ++t) {
    const char* record = data.data() + kHeader + t * kRecord + 12;
    const int first = static_cast<int>(surface.points.size());
    for (int corner = 0; corner < 3; ++corner) {
      Eigen::Vector3d point;
      for (int axis = 0; axis < 3; ++axis) {
        point(axis) = std::bit_cast<float>(little_endian_32(record + 12 * corner + 4 * axis));
      }
      if (!point.allFinite()) {
        throw InputError(fmt::format("{}: triangle {}: vertex {} is ({}, {}, {}); it must be finite", path, t + 1,
                                     corner + 1, point.x(), point.y(), point.z()));
      }
      surface.points.push_back(point);
    }
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

SurfaceFile read_text(std::string_view text, const std::string& path) {
  SurfaceFile surface;
  TextLines lines(text, path);
  // Moves on to the next line that is not blank and says what it must start with.
  const auto next = [&](bool must_exist) {
    while (lines.next()) {
      if (!lines.words().empty()) return true;
    }
    if (must_exist) lines.fail("the file ends inside a facet");
    return false;
  };
  const auto expect = [&](std::initializer_list<std::string_view> words, const std::string& what) {
    next(true);
    size_t i = 0;
    for (const std::string_view word : words) {
      if (i >= lines.words().size() || lines.words()[i] != word) lines.fail("expected '" + what + "'");
      ++i;
    }
  };
  while (next(false)) {
    const std::string_view word = lines.words()[0];
    if (word == "solid" || word == "endsolid") continue;
    if (word != "facet") lines.fail(fmt::format("expected 'facet', found '{}'", word));
    expect({"outer", "loop"}, "outer loop");
    const int first = static_cast<int>(surface.points.size());
    for (int corner = 0; corner < 3; ++corner) {
      expect({"vertex"}, "vertex");
      surface.points.emplace_back(lines.number(1, "x"), lines.number(2, "y"), lines.number(3, "z"));
    }
    expect({"endloop"}, "endloop");
    expect({"endfacet"}, "endfacet");
    surface.triangles.push_back({first, first + 1, first + 2});
  }
  return surface;
}

}  // namespace

SurfaceFile read_stl(std::string_view data, const std::string& path) {
  // Binary files may start with "solid" too: their length decides.
  const bool fits =
      data.size() >= kHeader && data.size() == kHeader + std::uint64_t{little_endian_32(data.data() + 80)} * kRecord;
  const size_t word = data.find_first_not_of(" \t\r\n");
  const bool text = !fits && word != std::string_view::npos && data.substr(word, 5) == "solid";
  return text ? read_text(data, path) : read_binary(data, path);
}

}  // namespace ergon
