#pragma once
// Results as rows: one JSON object per line for programs, or a table for people. Rows appear as they are measured.

#include <iosfwd>
#include <nlohmann/json.hpp>
#include <vector>

namespace ergon {

using Row = nlohmann::ordered_json;

class Rows {
 public:
  Rows(std::ostream& out, bool json) : out_(out), json_(json) {}
  // All rows have the fields of the first.
  void add(const Row& row);

 private:
  std::ostream& out_;
  bool json_;
  std::vector<size_t> widths_;  // of the table's columns, from the first row
};

}  // namespace ergon
