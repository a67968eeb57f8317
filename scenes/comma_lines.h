#pragma once
// Text of cells between commas: tables of numbers, measured data. It establishes what is a cell; what cells mean is
// told by who reads them.

#include <istream>
#include <string>
#include <vector>

namespace ergon {

struct CommaLine {
  int number;  // in the file, from 1
  std::vector<std::string> cells;
};

// Text without blanks and quotation marks around it.
std::string trimmed(const std::string& text);

// The lines that are not empty, without what follows a #.
std::vector<CommaLine> comma_lines(std::istream& stream);

}  // namespace ergon
