#pragma once
// Charts as SVG: lines over linear or logarithmic axes with ticks, labels and a legend, several charts side by side.
// The text is well-formed XML that needs nothing from elsewhere, so that it may stand in a page of HTML.

#include <string>
#include <string_view>
#include <vector>

namespace ergon {

struct ChartLine {
  std::string label;
  std::vector<double> x, y;  // a pair that is not finite (or not positive on a logarithmic axis) ends a stroke
  bool marks = false;        // a dot at every pair instead of a stroke
  int color = -1;            // lines of one number have one colour; -1: that of the line's place
};

struct Chart {
  std::string title, x_label, y_label;
  std::vector<ChartLine> lines;
  bool log_x = false, log_y = false;
  bool legend_right = false;
};

// An <svg> element of all charts in a row under one title (none where it is ""). A legend where a chart has several
// lines; every line carries its label as its <title>. Numbers on an axis that are very large or small are shown by a
// power of ten beside the label.
std::string svg_of(const std::vector<Chart>& charts, const std::string& title = "");

// &, <, >, " and ' as entities; characters that XML does not have are left out.
std::string xml_text(std::string_view text);

// Round numbers that cover the range, about `count` of them: 1, 2 or 5 times a power of ten apart; on a logarithmic
// axis powers of ten, with 2 and 5 between where there are few. Ascending, at least two.
std::vector<double> axis_ticks(double low, double high, int count, bool logarithmic);

}  // namespace ergon
