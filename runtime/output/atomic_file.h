#pragma once
// Files that are either there as a whole or not at all.

#include <string>
#include <string_view>

namespace ergon {

// Content goes to a temporary file in the folder of `path`; commit() brings it to the disk and gives it its name, in
// the place of a file that had it before. Without commit() nothing is left behind. Everything throws OutputError naming
// `path` and the system's reason.
class AtomicFile {
 public:
  // The folder must exist; `path` must not be something else than a regular file.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail(const char* what) const;
  void discard() noexcept;

  std::string path_;
  std::string temporary_;
  int descriptor_ = -1;
};

void write_file(const std::string& path, std::string_view content);

}  // namespace ergon
