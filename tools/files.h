#pragma once
// Text files that commands write.

#include <string>

namespace ergon {

// Throws OutputError "FILE: cannot be written: REASON".
void write_text_file(const std::string& file, const std::string& text);

}  // namespace ergon
