#include "tools/files.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "runtime/error.h"

namespace ergon {

void write_text_file(const std::string& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw OutputError(fmt::format("{}: cannot be written: {}", file, std::strerror(errno)));
}

}  // namespace ergon
