#pragma once
// Verification: cases that compare what the program computes with closed forms and published tables. One case is one
// file in tools/verify/cases: NAME.cpp defines VerifyCase NAME_case(), and the build finds it.

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace ergon {

struct VerifyRow {
  std::string quantity;  // what is compared, with its unit
  std::string element;   // "Hex20", or the law where it is that which is verified
  std::string mesh;      // "16x1x1 cells"
  double value = std::numeric_limits<double>::quiet_NaN();
  double reference = 0;
  // Largest error that passes, relative to the reference, or absolute where that is 0. Absent: a coarser mesh or a
  // model that cannot reach the reference, shown and not judged; then `note` says why.
  std::optional<double> bound = 0.01;
  std::string note = {};

  double error() const;
  bool judged() const { return bound.has_value(); }
  bool passed() const { return !judged() || error() <= *bound; }  // not where the value is not a number
};

// What two rows tend to whose errors are in proportion to the size of cells, and cells of `fine` are half as long: a
// row that is judged, against `reference`.
VerifyRow limit_of(const VerifyRow& coarse, const VerifyRow& fine, double reference);

// What a case is given to write to.
class VerifyRows {
 public:
  using Sink = std::function<void(const VerifyRow&)>;
  VerifyRows(bool quick, Sink sink) : quick_(quick), sink_(std::move(sink)) {}

  bool quick() const { return quick_; }  // only rows that take less than a second or so are wanted
  void add(const VerifyRow& row) const { sink_(row); }

 private:
  bool quick_;
  Sink sink_;
};

struct VerifyCase {
  std::string name;     // of its file
  std::string summary;  // a line
  std::string source;   // of the references
  // Throws std::runtime_error where an equilibrium is not found.
  std::function<void(const VerifyRows&)> run;
};

// All cases, sorted by name. Throws InputError, with the nearest name, for a name that there is no case of.
const std::vector<VerifyCase>& verify_cases();
const VerifyCase& verify_case(const std::string& name);

}  // namespace ergon
