#include "tests/paths.h"

namespace ergon::test {

std::string source(const std::string& path) { return ERGON_SOURCE_DIR + path; }
std::string built(const std::string& path) { return ERGON_BINARY_DIR + path; }

}  // namespace ergon::test
