#include "tools/stress_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <optional>

#include "scenes/comma_lines.h"
#include "symbolic/analyse.h"
#include "tools/load_path.h"

namespace ergon {
namespace {

class StressReader {
 public:
  StressReader(const std::string& file, const Energy& density) : file_(file), unit_(value_unit(density)) {
    for (const LoadPath& path : load_paths(density.geometry)) modes_.push_back(path.name);
  }

  std::vector<StressPoint> read() {
    std::ifstream stream(file_);
    if (!stream) throw SourceError({file_, 0, 0}, "cannot open the file of measured stress");
    for (const CommaLine& line : comma_lines(stream)) {
      line_ = line.number;
      columns_ == 0 ? header(line.cells) : row(line.cells);
    }
    if (points_.empty()) throw SourceError({file_, 0, 0}, "holds no measured stress");
    return std::move(points_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw SourceError({file_, line_, 1}, message); }

  void header(const std::vector<std::string>& names) {
    columns_ = names.size();
    for (size_t i = 0; i < names.size(); ++i) {
      const size_t end = names[i].find_first_of(" (/[");
      const std::string name = names[i].substr(0, end);
      const std::string rest = end == std::string::npos ? "" : trimmed(names[i].substr(end));
      if (name == "mode") mode_ = i;
      if (name == "stretch") stretch_ = i;
      if (name == "stress") stress_unit(i, rest);
    }
    if (!stretch_ || !stress_)
      fail(fmt::format("the first line names the columns, as `mode,stretch,stress (MPa)`; there is none named '{}'",
                       stretch_ ? "stress" : "stretch"));
  }

  void stress_unit(size_t column, const std::string& written) {
    stress_ = column;
    std::string unit = written;
    unit.erase(
        std::remove_if(unit.begin(), unit.end(), [](char c) { return c == '(' || c == ')' || c == '[' || c == ']'; }),
        unit.end());
    if (unit.starts_with("/")) unit = unit.substr(1);
    unit = trimmed(unit);
    const std::string expected = to_string(unit_);
    if (unit.empty()) fail(fmt::format("the column 'stress' needs its unit, as `stress ({})`", expected));
    try {
      const ScaledUnit scaled = parse_unit(unit);
      if (scaled.unit != unit_) fail(fmt::format("the stress must be in {}, found {}", expected, unit));
      scale_ = scaled.scale;
    } catch (const std::invalid_argument& error) {
      fail(error.what());
    }
  }

  void row(const std::vector<std::string>& cells) {
    if (cells.size() != columns_) fail(fmt::format("expected {} values, found {}", columns_, cells.size()));
    StressPoint point;
    point.mode = mode_ ? cells[*mode_] : "uniaxial";
    if (std::find(modes_.begin(), modes_.end(), point.mode) == modes_.end())
      fail(fmt::format("'{}' is none of {}{}", point.mode, fmt::join(modes_, ", "), did_you_mean(point.mode, modes_)));
    point.stretch = number(cells[*stretch_]);
    point.stress = scale_ * number(cells[*stress_]);
    if (point.mode != "simple_shear" && !(point.stretch > 0))
      fail(fmt::format("a stretch is a length over the length at rest, above 0; found {}", cells[*stretch_]));
    points_.push_back(point);
  }

  double number(const std::string& text) const {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (text.empty() || *end != '\0' || !std::isfinite(value)) fail(fmt::format("expected a number, found '{}'", text));
    return value;
  }

  const std::string& file_;
  Unit unit_;
  std::vector<std::string> modes_;
  int line_ = 0;
  size_t columns_ = 0;
  std::optional<size_t> mode_, stretch_, stress_;
  double scale_ = 1;
  std::vector<StressPoint> points_;
};

}  // namespace

std::vector<StressPoint> read_stress_data(const std::string& file, const Energy& density) {
  return StressReader(file, density).read();
}

}  // namespace ergon
