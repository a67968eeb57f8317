#pragma once
// The surface file formats behind read_surface. A reader checks what its format says and gives back all that the file
// states; merging and leaving out is done once, by read_surface.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace ergon {

struct SurfaceFile {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
};

// `text` is the whole file, `path` its name for messages. All throw InputError "path:line: ..." for text and
// "path: record: ..." for binary data.
SurfaceFile read_obj(std::string_view text, const std::string& path);
SurfaceFile read_stl(std::string_view text, const std::string& path);
SurfaceFile read_ply(std::string_view text, const std::string& path);

// The content of a file. Throws InputError naming the path and the system's reason.
std::string whole_file(const std::string& path);

// A text file line by line, as words; line numbers count from 1.
class TextLines {
 public:
  TextLines(std::string_view text, std::string path) : rest_(text), path_(std::move(path)) {}
  bool next();  // moves to the next line; false at the end
  const std::vector<std::string_view>& words() const { return words_; }
  int line() const { return line_; }
  std::string_view rest() const { return rest_; }  // what follows this line
  [[noreturn]] void fail(const std::string& message) const;

  // The word at `index` as a finite number, or as a whole number; throws InputError naming `what`.
  double number(size_t index, const std::string& what) const;
  long long integer(std::string_view word, const std::string& what) const;

 private:
  std::string_view rest_;
  std::string path_;
  std::vector<std::string_view> words_;
  int line_ = 0;
};

// Appends a face of three or four points (counted from 0) as triangles; a quadrilateral is cut along the diagonal whose
// two triangles agree better in direction. Throws InputError "place: ..." for other counts and for points that do not
// exist, which the message counts from `base` as the format does.
void append_face(const std::vector<long long>& face, const std::string& place, int base, SurfaceFile& surface);

}  // namespace ergon
