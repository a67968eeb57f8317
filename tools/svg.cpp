#include "tools/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ergon {
namespace {

// Pixels.
constexpr double chart_width = 360, chart_height = 300, left = 62, right = 12, top = 30, bottom = 46, title_height = 30;

// Okabe, Ito 2008. Color Universal Design: seven colours that people of all kinds of sight can tell apart.
constexpr std::array colors = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};

struct Axis {
  bool logarithmic = false;
  double low = 0, high = 1;  // of the ticks at both ends
  std::vector<double> ticks;
  int exponent = 0;  // numbers are shown divided by this power of ten

  double fraction(double value) const {
    return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  }
  bool shows(double value) const { return std::isfinite(value) && (!logarithmic || value > 0); }
};

Axis axis_of(const Chart& chart, bool logarithmic, std::vector<double> ChartLine::*values) {
  Axis axis{logarithmic, 0, 1, {}, 0};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ChartLine& line : chart.lines) {
    for (const double value : line.*values) {
      if (!axis.shows(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  if (!(low <= high)) low = logarithmic ? 1 : 0, high = logarithmic ? 10 : 1;
  axis.ticks = axis_ticks(low, high, 6, logarithmic);
  axis.low = axis.ticks.front();
  axis.high = axis.ticks.back();
  const double size = std::max(std::fabs(axis.low), std::fabs(axis.high));
  const int exponent = static_cast<int>(std::floor(std::log10(size)));
  if (!logarithmic && (exponent > 3 || exponent < -2)) axis.exponent = 3 * static_cast<int>(std::floor(exponent / 3.0));
  return axis;
}

std::string tick_text(const Axis& axis, double tick) {
  if (axis.logarithmic) return fmt::format("{:g}", tick);
  const double step = axis.ticks[1] - axis.ticks[0];
  const double shown = std::fabs(tick) < 1e-9 * step ? 0 : tick / std::pow(10.0, axis.exponent);
  return fmt::format("{:.6g}", shown);
}

std::string label_with_power(const std::string& label, const Axis& axis) {
  std::string text = xml_text(label);
  if (axis.exponent != 0)
    text += fmt::format(" / 10<tspan dy=\"-5\" font-size=\"9\">{}</tspan><tspan dy=\"5\"> </tspan>", axis.exponent);
  return text;
}

class ChartDrawing {
 public:
  ChartDrawing(const Chart& chart, double x, double y)
      : chart_(chart),
        x0_(x + left),
        y0_(y + top),
        x_(axis_of(chart, chart.log_x, &ChartLine::x)),
        y_(axis_of(chart, chart.log_y, &ChartLine::y)) {}

  std::string text() {
    axes();
    for (size_t i = 0; i < chart_.lines.size(); ++i) line(chart_.lines[i], color_of(i));
    if (chart_.lines.size() > 1) legend();
    return std::move(out_);
  }

 private:
  static constexpr double width = chart_width - left - right, height = chart_height - top - bottom;

  const char* color_of(size_t i) const {
    const int own = chart_.lines[i].color;
    return colors[(own < 0 ? i : static_cast<size_t>(own)) % colors.size()];
  }

  double px(double value) const { return x0_ + width * x_.fraction(value); }
  double py(double value) const { return y0_ + height * (1 - y_.fraction(value)); }

  void rule(double xa, double ya, double xb, double yb, const char* color) {
    out_ += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\"/>\n", xa, ya, xb,
                        yb, color);
  }

  void word(double x, double y, const char* anchor, const std::string& text, const std::string& more = "") {
    out_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>\n", x, y, anchor, more, text);
  }

  void axes() {
    for (const double tick : x_.ticks) {
      rule(px(tick), y0_, px(tick), y0_ + height, tick == 0 && x_.low < 0 ? "#888" : "#e4e4e4");
      word(px(tick), y0_ + height + 14, "middle", tick_text(x_, tick));
    }
    for (const double tick : y_.ticks) {
      rule(x0_, py(tick), x0_ + width, py(tick), tick == 0 && y_.low < 0 ? "#888" : "#e4e4e4");
      word(x0_ - 5, py(tick) + 4, "end", tick_text(y_, tick));
    }
    out_ += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#444\"/>\n",
                        x0_, y0_, width, height);
    const double middle = y0_ + height / 2;
    word(x0_ + width / 2, y0_ + height + 34, "middle", label_with_power(chart_.x_label, x_));
    word(x0_ - 46, middle, "middle", label_with_power(chart_.y_label, y_),
         fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", x0_ - 46, middle));
    word(x0_ + width / 2, y0_ - 8, "middle", xml_text(chart_.title), " font-weight=\"bold\"");
  }

  void line(const ChartLine& line, const char* color) {
    out_ += fmt::format("<g class=\"curve\"><title>{}</title>\n", xml_text(line.label));
    std::string points;
    auto finish = [&] {
      if (!points.empty())
        out_ +=
            fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"/>\n", points, color);
      points.clear();
    };
    for (size_t i = 0; i < line.x.size(); ++i) {
      if (!x_.shows(line.x[i]) || !y_.shows(line.y[i])) {
        finish();
      } else if (line.marks) {
        out_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"2.6\" fill=\"none\" stroke=\"{}\"/>\n",
                            px(line.x[i]), py(line.y[i]), color);
      } else {
        points += fmt::format("{}{:.2f},{:.2f}", points.empty() ? "" : " ", px(line.x[i]), py(line.y[i]));
      }
    }
    finish();
    out_ += "</g>\n";
  }

  void legend() {
    size_t longest = 0;
    for (const ChartLine& line : chart_.lines) longest = std::max(longest, line.label.size());
    const double wide = 32 + 6.4 * static_cast<double>(longest);
    const double x = chart_.legend_right ? x0_ + width - wide - 4 : x0_ + 8;
    out_ += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"#fff\" fill-opacity=\"0.8\"/>\n", x,
        y0_ + 4, wide, 4 + 14 * static_cast<double>(chart_.lines.size()));
    for (size_t i = 0; i < chart_.lines.size(); ++i) {
      const double y = y0_ + 14 + 14 * static_cast<double>(i);
      const char* color = color_of(i);
      out_ += chart_.lines[i].marks
                  ? fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"none\" stroke=\"{}\"/>\n", x + 12,
                                y, color)
                  : fmt::format(
                        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
                        "stroke-width=\"1.8\"/>\n",
                        x + 4, y, x + 20, y, color);
      word(x + 26, y + 4, "start", xml_text(chart_.lines[i].label));
    }
  }

  const Chart& chart_;
  double x0_, y0_;
  Axis x_, y_;
  std::string out_;
};

}  // namespace

std::string xml_text(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else if (static_cast<unsigned char>(c) >= 32 || c == '\n' || c == '\t')
      out += c;
  }
  return out;
}

std::vector<double> axis_ticks(double low, double high, int count, bool logarithmic) {
  std::vector<double> ticks;
  if (logarithmic) {
    const int first = static_cast<int>(std::floor(std::log10(low) + 1e-9));
    const int last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(high) - 1e-9)));
    const int apart = (last - first - 1) / count + 1;
    for (int e = first; e < last + apart; e += apart) {
      ticks.push_back(std::pow(10.0, e));
      if (last - first > 2 || e >= last) continue;
      ticks.push_back(2 * std::pow(10.0, e));
      ticks.push_back(5 * std::pow(10.0, e));
    }
    return ticks;
  }
  const double size = std::max(std::fabs(low), std::fabs(high));
  if (!(high - low > 1e-12 * size)) {  // one value: some room on both sides
    const double room = size > 0 ? 0.1 * size : 1;
    low -= room;
    high += room;
  }
  const double wanted = (high - low) / count, power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double step = power * (wanted <= 1.001 * power   ? 1
                               : wanted <= 2.001 * power ? 2
                               : wanted <= 5.001 * power ? 5
                                                         : 10);
  const double first = std::floor(low / step + 1e-6), last = std::ceil(high / step - 1e-6);
  for (double i = first; i <= last; ++i) ticks.push_back(i * step);
  return ticks;
}

std::string svg_of(const std::vector<Chart>& charts, const std::string& title) {
  const double head = title.empty() ? 0 : title_height;
  const double width = chart_width * static_cast<double>(charts.size()), height = chart_height + head;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" "
      "font-family=\"sans-serif\" font-size=\"11\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      width, height);
  if (!title.empty()) out += fmt::format("<text x=\"12\" y=\"19\" font-size=\"13\">{}</text>\n", xml_text(title));
  for (size_t i = 0; i < charts.size(); ++i)
    out += ChartDrawing(charts[i], chart_width * static_cast<double>(i), head).text();
  return out + "</svg>\n";
}

}  // namespace ergon
