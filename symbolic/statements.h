#pragma once
// The first reading of an `.energy` file: comments taken out, continuation lines joined, places kept.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "symbolic/diagnostic.h"

namespace ergon {

// One statement on a single line, whatever the number of lines it was written on. Where these are of another text,
// their columns are 0.
struct Statement {
  std::string text;
  std::vector<std::pair<size_t, Place>> lines;  // offset in `text` where each source line starts, and its place

  Place place(size_t offset = 0) const;  // columns count characters of UTF-8, offsets bytes
};

struct Statements {
  std::string summary;  // the comment lines above the first statement, joined by spaces
  std::vector<Statement> all;
};

// A statement continues on the lines below it that are indented. `#` starts a comment. Throws SourceError for an
// indented line that continues nothing.
Statements split_statements(std::string_view text, const std::string& file);

}  // namespace ergon
