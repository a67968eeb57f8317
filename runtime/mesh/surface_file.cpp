#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>

#include "runtime/error.h"
#include "runtime/mesh/mesh_import.h"
#include "runtime/mesh/surface_readers.h"

namespace ergon {
namespace {

// Lexicographic order of coordinates; -0 and 0 are the same.
struct PointOrder {
  bool operator()(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  }
};

Mesh merged(const SurfaceFile& surface, const std::string& path) {
  const size_t points = surface.points.size();
  std::map<Eigen::Vector3d, size_t, PointOrder> first_with;
  std::vector<size_t> first(points);  // the first point with the same coordinates
  for (size_t i = 0; i < points; ++i) first[i] = first_with.try_emplace(surface.points[i], i).first->second;

  std::vector<std::array<size_t, 3>> triangles;
  std::vector<bool> used(points, false);
  for (const auto& [i, j, k] : surface.triangles) {
    const size_t a = first[static_cast<size_t>(i)], b = first[static_cast<size_t>(j)],
                 c = first[static_cast<size_t>(k)];
    if (a == b || b == c || c == a) continue;
    triangles.push_back({a, b, c});
    used[a] = used[b] = used[c] = true;
  }
  if (triangles.empty()) throw InputError(path + ": holds no triangles");

  Mesh mesh;
  mesh.element = Element::tri3;
  mesh.source = path;
  mesh.X.resize(3, std::count(used.begin(), used.end(), true));
  std::vector<int> vertex_of(points, -1);
  int vertices = 0;
  for (size_t i = 0; i < points; ++i) {
    if (!used[i]) continue;
    vertex_of[i] = vertices;
    mesh.X.col(vertices++) = surface.points[i];
  }
  for (const auto& triangle : triangles) {
    for (const size_t point : triangle) mesh.cells.push_back(vertex_of[point]);
  }
  return mesh;
}

}  // namespace

std::string whole_file(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw InputError(fmt::format("{}: cannot be opened: {}", path, std::strerror(errno)));
  std::string text;
  char block[1 << 16];
  size_t count = 0;
  while ((count = std::fread(block, 1, sizeof block, file.get())) > 0) text.append(block, count);
  if (std::ferror(file.get())) throw InputError(fmt::format("{}: cannot be read: {}", path, std::strerror(errno)));
  return text;
}

bool TextLines::next() {
  if (rest_.empty()) return false;
  const size_t end = rest_.find('\n');
  std::string_view line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  ++line_;
  words_.clear();
  constexpr std::string_view kBlank = " \t\r\v\f";
  for (size_t start = 0; (start = line.find_first_not_of(kBlank, start)) != std::string_view::npos;) {
    const size_t stop = std::min(line.find_first_of(kBlank, start), line.size());
    words_.push_back(line.substr(start, stop - start));
    start = stop;
  }
  return true;
}

void TextLines::fail(const std::string& message) const {
  throw InputError(fmt::format("{}:{}: {}", path_, line_, message));
}

double TextLines::number(size_t index, const std::string& what) const {
  if (index >= words_.size()) fail(what + " is missing");
  std::string_view word = words_[index];
  if (word.size() > 1 && word[0] == '+') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::invalid_argument || end != word.data() + word.size()) {
    fail(fmt::format("{} is '{}', which is not a number", what, words_[index]));
  }
  if (error == std::errc::result_out_of_range) {
    // Too small for a double is as good as zero; too large is not.
    value = word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos ? 0.0 : INFINITY;
  }
  if (!std::isfinite(value)) fail(fmt::format("{} is '{}'; it must be finite", what, words_[index]));
  return value;
}

long long TextLines::integer(std::string_view word, const std::string& what) const {
  long long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    fail(fmt::format("{} is '{}', which is not a whole number", what, word));
  }
  return value;
}

void append_face(const std::vector<long long>& face, const std::string& place, int base, SurfaceFile& surface) {
  const auto append = [&](size_t a, size_t b, size_t c) {
    surface.triangles.push_back({static_cast<int>(face[a]), static_cast<int>(face[b]), static_cast<int>(face[c])});
  };
  const long long count = static_cast<long long>(surface.points.size());
  for (const long long point : face) {
    if (point < 0 || point >= count) {
      throw InputError(fmt::format("{}: a face names vertex {}, but the file has {} (counted from {})", place,
                                   point + base, count, base));
    }
  }
  if (face.size() == 3) return append(0, 1, 2);
  if (face.size() != 4) {
    throw InputError(fmt::format("{}: a face has {} vertices; export the surface as triangles", place, face.size()));
  }
  const auto area = [&](size_t a, size_t b, size_t c) -> Eigen::Vector3d {
    const Eigen::Vector3d& origin = surface.points[static_cast<size_t>(face[a])];
    return (surface.points[static_cast<size_t>(face[b])] - origin)
        .cross(surface.points[static_cast<size_t>(face[c])] - origin);
  };
  const auto agreement = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return a.normalized().dot(b.normalized());
  };
  if (agreement(area(0, 1, 2), area(0, 2, 3)) >= agreement(area(1, 2, 3), area(1, 3, 0))) {
    append(0, 1, 2);
    append(0, 2, 3);
  } else {
    append(1, 2, 3);
    append(1, 3, 0);
  }
}

Mesh read_surface(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".obj" && extension != ".stl" && extension != ".ply") {
    throw InputError(fmt::format("{}: unknown surface format '{}'; known are .obj, .stl and .ply", path, extension));
  }
  const std::string text = whole_file(path);
  if (extension == ".obj") return merged(read_obj(text, path), path);
  if (extension == ".stl") return merged(read_stl(text, path), path);
  return merged(read_ply(text, path), path);
}

}  // namespace ergon
