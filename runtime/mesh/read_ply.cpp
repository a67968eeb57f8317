#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

#include "runtime/error.h"
#include "runtime/mesh/surface_readers.h"

namespace ergon {
namespace {

// The number types of PLY, under both of their names.
struct NumberType {
  std::string_view name, other_name;
  size_t bytes;
  char kind;  // i, u, f
};
constexpr NumberType kTypes[] = {{"char", "int8", 1, 'i'},     {"uchar", "uint8", 1, 'u'},   {"short", "int16", 2, 'i'},
                                 {"ushort", "uint16", 2, 'u'}, {"int", "int32", 4, 'i'},     {"uint", "uint32", 4, 'u'},
                                 {"float", "float32", 4, 'f'}, {"double", "float64", 8, 'f'}};

struct Property {
  std::string name;
  const NumberType* type = nullptr;
  const NumberType* count_type = nullptr;  // of a list; nullptr for a single number
};

struct PlyElement {
  std::string name;
  long long count = 0;
  std::vector<Property> properties;
};

enum class Format { text, little_endian, big_endian };

struct Header {
  Format format = Format::text;
  std::vector<PlyElement> elements;
};

const NumberType* type_named(const TextLines& lines, std::string_view name) {
  for (const NumberType& type : kTypes) {
    if (type.name == name || type.other_name == name) return &type;
  }
  lines.fail(fmt::format("unknown number type '{}'", name));
}

Header read_header(TextLines& lines) {
  if (!lines.next() || lines.words().size() != 1 || lines.words()[0] != "ply") lines.fail("expected 'ply'");
  Header header;
  bool has_format = false;
  while (lines.next()) {
    const auto& words = lines.words();
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") {
      if (!has_format) lines.fail("the header names no format");
      return header;
    }
    if (words[0] == "format" && words.size() == 3) {
      has_format = true;
      if (words[1] == "ascii") {
        header.format = Format::text;
      } else if (words[1] == "binary_little_endian") {
        header.format = Format::little_endian;
      } else if (words[1] == "binary_big_endian") {
        header.format = Format::big_endian;
      } else {
        lines.fail(fmt::format("unknown format '{}'", words[1]));
      }
    } else if (words[0] == "element" && words.size() == 3) {
      header.elements.push_back({std::string(words[1]), lines.integer(words[2], "the element's count"), {}});
      if (header.elements.back().count < 0) lines.fail("an element's count is negative");
    } else if (words[0] == "property" && words.size() == 3 && !header.elements.empty()) {
      header.elements.back().properties.push_back({std::string(words[2]), type_named(lines, words[1]), nullptr});
    } else if (words[0] == "property" && words.size() == 5 && words[1] == "list" && !header.elements.empty()) {
      const NumberType* count_type = type_named(lines, words[2]);
      if (count_type->kind == 'f') lines.fail("a list's length must have a whole type");
      header.elements.back().properties.push_back({std::string(words[4]), type_named(lines, words[3]), count_type});
    } else {
      lines.fail(fmt::format("'{}' is not understood in a PLY header", words[0]));
    }
  }
  lines.fail("the file ends inside the header");
}

// The numbers of the body one after the other, whatever the format.
class Body {
 public:
  Body(TextLines& lines, Format format, std::string path)
      : lines_(lines), format_(format), path_(std::move(path)), data_(lines.rest()) {}

  void start_record(const PlyElement& element, long long index) {
    record_ = fmt::format("{} {}", element.name, index);
    if (format_ != Format::text) return;
    do {
      if (!lines_.next()) lines_.fail(fmt::format("the file ends before {}", record_));
    } while (lines_.words().empty());
    word_ = 0;
  }

  std::string place() const {
    return format_ == Format::text ? fmt::format("{}:{}", path_, lines_.line()) : path_ + ": " + record_;
  }

  double number(const NumberType& type, const std::string& name) {
    if (format_ == Format::text) return lines_.number(word_++, record_ + ": " + name);
    if (data_.size() < type.bytes) throw InputError(fmt::format("{}: the file ends inside {}", path_, record_));
    std::uint64_t bits = 0;
    for (size_t i = 0; i < type.bytes; ++i) {
      const size_t at = format_ == Format::big_endian ? i : type.bytes - 1 - i;
      bits = (bits << 8) | static_cast<unsigned char>(data_[at]);
    }
    data_.remove_prefix(type.bytes);
    if (type.kind == 'u') return static_cast<double>(bits);
    if (type.kind == 'i') {
      const int shift = static_cast<int>(64 - 8 * type.bytes);
      return static_cast<double>(static_cast<std::int64_t>(bits << shift) >> shift);
    }
    const double value =
        type.bytes == 4 ? std::bit_cast<float>(static_cast<std::uint32_t>(bits)) : std::bit_cast<double>(bits);
    if (!std::isfinite(value)) {
      throw InputError(fmt::format("{}: {}: {} is {}; it must be finite", path_, record_, name, value));
    }
    return value;
  }

  std::vector<long long> list(const Property& property) {
    const double count = number(*property.count_type, "length of " + property.name);
    std::vector<long long> values;
    for (double i = 0; i < count; ++i) {
      values.push_back(static_cast<long long>(number(*property.type, property.name)));
    }
    return values;
  }

 private:
  TextLines& lines_;
  Format format_;
  std::string path_;
  std::string_view data_;
  std::string record_;
  size_t word_ = 0;
};

int axis_of(const Property& property) {
  if (property.count_type) return -1;
  return property.name == "x" ? 0 : property.name == "y" ? 1 : property.name == "z" ? 2 : -1;
}

bool names_corners(const Property& property) {
  return property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index");
}

}  // namespace

SurfaceFile read_ply(std::string_view text, const std::string& path) {
  TextLines lines(text, path);
  const Header header = read_header(lines);
  const auto element_named = [&](std::string_view name) -> const PlyElement& {
    for (const PlyElement& element : header.elements) {
      if (element.name == name) return element;
    }
    throw InputError(fmt::format("{}: the header names no element '{}'", path, name));
  };
  const auto& vertex_properties = element_named("vertex").properties;
  for (int axis = 0; axis < 3; ++axis) {
    if (std::none_of(vertex_properties.begin(), vertex_properties.end(),
                     [&](const Property& p) { return axis_of(p) == axis; })) {
      throw InputError(fmt::format("{}: the vertices have no property '{}'", path, "xyz"[axis]));
    }
  }
  const auto& face_properties = element_named("face").properties;
  if (std::none_of(face_properties.begin(), face_properties.end(), names_corners)) {
    throw InputError(path + ": the faces have no property 'vertex_indices'");
  }

  SurfaceFile surface;
  std::vector<std::pair<std::vector<long long>, std::string>> faces;
  Body body(lines, header.format, path);
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) continue;
    for (long long i = 0; i < element.count; ++i) {
      body.start_record(element, i);
      Eigen::Vector3d point;
      for (const Property& property : element.properties) {
        if (property.count_type) {
          std::vector<long long> corners = body.list(property);
          if (element.name == "face" && names_corners(property)) faces.emplace_back(std::move(corners), body.place());
        } else {
          const double value = body.number(*property.type, property.name);
          if (const int axis = axis_of(property); axis >= 0) point(axis) = value;
        }
      }
      if (element.name == "vertex") surface.points.push_back(point);
    }
  }
  for (const auto& [corners, place] : faces) append_face(corners, place, 0, surface);
  return surface;
}

}  // namespace ergon
