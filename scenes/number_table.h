#pragma once
// A text file of numbers: a line of names of columns with units, as `E (kPa),nu`, and lines of values with commas
// between; `#` starts a comment.

#include <string>
#include <vector>

#include "symbolic/diagnostic.h"
#include "symbolic/units.h"

namespace ergon {

struct NumberTable {
  struct Column {
    std::string name;
    std::string unit_text;  // "" where none is written
    ScaledUnit unit;
    std::vector<double> values;  // SI
  };
  std::string file;
  std::vector<Column> columns;
  std::vector<int> lines;  // of the file, per row

  size_t rows() const { return lines.size(); }
  // Throws SourceError at the file's first line with the nearest name.
  const Column& column(const std::string& name) const;
};

// Throws SourceError at the line for a unit that is not known, a value that is no finite number, another number of
// values than of columns; and for a file that cannot be read, at `place`.
NumberTable read_number_table(const std::string& file, const Place& place);

}  // namespace ergon
