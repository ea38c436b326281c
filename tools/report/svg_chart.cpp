#include "tools/report/svg_chart.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "algo/core/scalar_math.hpp"
#include "hal/results/text_format.hpp"

namespace st {
namespace {

constexpr double kLeft = 62, kRight = 14, kTop = 12, kBottom = 40;

std::string fixed(double value, int decimals) {
  std::string out;
  append_fixed(out, value, decimals);
  return out;
}
std::string px(double value) { return fixed(value, 1); }

struct Range {
  double low = 1e300, high = -1e300;

  void include(double v) { low = std::min(low, v), high = std::max(high, v); }
  double size() const { return high - low; }
  void grow(double by) { low -= by, high += by; }
};

// Steps of 1, 2 or 5 times a power of ten, about `count` of them.
double nice_step(double size, double count) {
  const double raw = size / count;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  const double lead = raw / power;
  return power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
}

int decimals_for(double step) {
  return std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
}

struct Axis {
  Range range;
  double from = 0, to = 1, step = 1;  // pixels at both ends of the range, grid step

  double at(double v) const { return from + (v - range.low) / range.size() * (to - from); }
  std::vector<double> ticks() const {
    std::vector<double> values;
    const double first = std::ceil(range.low / step - 1e-9);
    for (int i = 0; i < 200; ++i) {
      const double v = (first + i) * step;
      if (v > range.high + 1e-9 * step) break;
      values.push_back(v);
    }
    return values;
  }
};

std::string text(double x, double y, const char* style, std::string_view content, const char* more = "") {
  return "<text class=\"" + std::string(style) + "\" x=\"" + px(x) + "\" y=\"" + px(y) + "\"" + more + ">" +
         escape_html(content) + "</text>";
}

std::string line(double x0, double y0, double x1, double y1, const char* style) {
  return "<path class=\"" + std::string(style) + "\" d=\"M" + px(x0) + " " + px(y0) + "L" + px(x1) + " " +
         px(y1) + "\"/>";
}

std::string open_svg(double width, double height) {
  return "<svg viewBox=\"0 0 " + px(width) + " " + px(height) + "\" width=\"" + px(width) + "\" height=\"" +
         px(height) + "\" role=\"img\">";
}

std::string grid(const Axis& x, const Axis& y, const std::string& x_label, const std::string& y_label) {
  std::string out;
  for (const double v : x.ticks()) {
    out += line(x.at(v), y.from, x.at(v), y.to, "grid");
    out += text(x.at(v), y.from + 16, "tick mid", fixed(v, decimals_for(x.step)));
  }
  for (const double v : y.ticks()) {
    out += line(x.from, y.at(v), x.to, y.at(v), "grid");
    out += text(x.from - 7, y.at(v) + 4, "tick end", fixed(v, decimals_for(y.step)));
  }
  out += text(0.5 * (x.from + x.to), y.from + 33, "label mid", x_label);
  const double middle = 0.5 * (y.from + y.to);
  const std::string turned = " transform=\"rotate(-90 14 " + px(middle) + ")\"";
  out += text(14, middle, "label mid", y_label, turned.c_str());
  return out;
}

// Points closer than a third of a pixel to the one before say nothing new.
std::string polyline(const std::vector<ChartPoint>& points, const Axis& x, const Axis& y,
                     const std::string& style) {
  constexpr double kApart = 0.33;
  std::string d;
  double last_x = -1e9, last_y = -1e9;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double u = x.at(points[i].x), v = y.at(points[i].y);
    const bool last = i + 1 == points.size();
    if (!d.empty() && !last && std::fabs(u - last_x) < kApart && std::fabs(v - last_y) < kApart) continue;
    d += (d.empty() ? "M" : "L") + px(u) + " " + px(v);
    last_x = u, last_y = v;
  }
  return "<path class=\"line " + style + "\" d=\"" + d + "\"/>";
}

std::string draw_mark(const ChartMark& mark, const Axis& x, const Axis& y) {
  const std::string place = "translate(" + px(x.at(mark.x)) + " " + px(y.at(mark.y)) + ")";
  const std::string open = "<g class=\"mark " + mark.style + "\" transform=\"" + place;
  switch (mark.kind) {
    case ChartMark::Kind::kDot:
      return open + "\"><circle r=\"5\"/></g>";
    case ChartMark::Kind::kSquare:
      return open + "\"><rect x=\"-5\" y=\"-5\" width=\"10\" height=\"10\"/></g>";
    case ChartMark::Kind::kArrow:
      return open + " rotate(" + px(-mark.yaw_rad * 180 / kPi) +
             ")\"><circle r=\"5\"/><path d=\"M0 0H26M19 -4.5L27 0L19 4.5\"/></g>";
  }
  return {};
}

std::string legend(const std::vector<Series>& series, double right) {
  std::string out;
  double at = right;
  for (auto s = series.rbegin(); s != series.rend(); ++s) {
    if (s->name.empty()) continue;
    constexpr double kLetter = 6.6, kSample = 26, kGap = 16;
    at -= kLetter * static_cast<double>(s->name.size());
    out += text(at, 11, "legend", s->name);
    out += "<path class=\"line " + s->style + "\" d=\"M" + px(at - kSample) + " 7H" + px(at - 5) + "\"/>";
    at -= kSample + kGap;
  }
  return out;
}

void ranges_of(const Chart& chart, Range& x, Range& y) {
  for (const Series& s : chart.series)
    for (const auto& points : s.lines)
      for (const ChartPoint& p : points) x.include(p.x), y.include(p.y);
  for (const ChartMark& m : chart.marks) x.include(m.x), y.include(m.y);
  if (chart.x_low < chart.x_high) x.include(chart.x_low), x.include(chart.x_high);
  if (chart.zero_in_y || y.size() < 0) y.include(0);
  if (x.size() < 0) x = {0, 1};
  if (chart.band > 0) y.include(-chart.band), y.include(chart.band);
}

}  // namespace

std::string escape_html(std::string_view content) {
  std::string out;
  for (const char c : content) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

std::string draw(const Chart& chart) {
  Axis x, y;
  ranges_of(chart, x.range, y.range);
  const double top = kTop + 10;
  x.from = kLeft, x.to = chart.width - kRight;
  y.from = chart.height - kBottom, y.to = top;
  if (chart.equal_axes) {
    constexpr double kLeastM = 0.1, kAround = 0.07;
    const double around = kAround * std::max({x.range.size(), y.range.size(), kLeastM});
    x.range.grow(around), y.range.grow(around);
    const double scale = std::min((x.to - x.from) / x.range.size(), (y.from - y.to) / y.range.size());
    x.range.grow(0.5 * ((x.to - x.from) / scale - x.range.size()));
    y.range.grow(0.5 * ((y.from - y.to) / scale - y.range.size()));
    x.step = y.step = nice_step(std::max(x.range.size(), y.range.size()), 9);
  } else {
    if (x.range.size() <= 0) x.range.grow(0.5);
    y.range.grow(y.range.size() > 0 ? 0.06 * y.range.size() : 0.5);
    x.step = nice_step(x.range.size(), 9);
    y.step = nice_step(y.range.size(), 4.5);
  }
  std::string out = open_svg(chart.width, chart.height);
  if (chart.band > 0)
    out += "<rect class=\"band\" x=\"" + px(x.from) + "\" width=\"" + px(x.to - x.from) + "\" y=\"" +
           px(y.at(chart.band)) + "\" height=\"" + px(y.at(-chart.band) - y.at(chart.band)) + "\"/>";
  out += grid(x, y, chart.x_label, chart.y_label);
  if (!chart.equal_axes && y.range.low < 0 && y.range.high > 0)
    out += line(x.from, y.at(0), x.to, y.at(0), "zero");
  for (const Series& s : chart.series)
    for (const auto& points : s.lines)
      if (!points.empty()) out += polyline(points, x, y, s.style);
  for (const ChartMark& mark : chart.marks) out += draw_mark(mark, x, y);
  return out + legend(chart.series, x.to) + "</svg>";
}

std::string draw(const BarChart& chart) {
  Axis x, y;
  for (const double edge : chart.edges) x.range.include(edge);
  if (x.range.size() <= 0) x.range = {0, 1};
  double most = 1;
  for (const double height : chart.heights) most = std::max(most, height);
  const auto measure = [&chart](double h) { return chart.log_heights ? std::log10(1 + h) : h; };
  y.range = {0, measure(most) * 1.06};
  x.from = kLeft, x.to = chart.width - kRight;
  y.from = chart.height - kBottom, y.to = kTop;
  x.step = nice_step(x.range.size(), 9);
  y.step = chart.log_heights ? 1e9 : nice_step(y.range.size(), 4.5);
  std::string out = open_svg(chart.width, chart.height) + grid(x, y, chart.x_label, chart.y_label);
  for (double decade = 1; chart.log_heights && decade <= most; decade *= 10) {
    out += line(x.from, y.at(measure(decade)), x.to, y.at(measure(decade)), "grid");
    out += text(x.from - 7, y.at(measure(decade)) + 4, "tick end", fixed(decade, 0));
  }
  for (std::size_t i = 0; i < chart.heights.size(); ++i) {
    if (chart.heights[i] <= 0) continue;
    const double u0 = x.at(chart.edges[i]), u1 = x.at(chart.edges[i + 1]),
                 v = y.at(measure(chart.heights[i]));
    out += "<rect class=\"bar\" x=\"" + px(u0 + 0.5) + "\" width=\"" + px(std::max(1.0, u1 - u0 - 1)) +
           "\" y=\"" + px(v) + "\" height=\"" + px(y.from - v) + "\"/>";
  }
  return out + "</svg>";
}

std::string draw(const Timeline& timeline) {
  constexpr double kRow = 26, kBar = 16;
  const double bottom = kTop + kRow * static_cast<double>(timeline.rows.size());
  Axis x;
  x.range = {timeline.x_low, std::max(timeline.x_high, timeline.x_low + 1e-3)};
  x.from = kLeft, x.to = timeline.width - kRight;
  x.step = nice_step(x.range.size(), 9);
  std::string out = open_svg(timeline.width, bottom + kBottom);
  for (const double v : x.ticks()) {
    out += line(x.at(v), kTop, x.at(v), bottom, "grid");
    out += text(x.at(v), bottom + 16, "tick mid", fixed(v, decimals_for(x.step)));
  }
  for (std::size_t r = 0; r < timeline.rows.size(); ++r) {
    const double v = kTop + kRow * static_cast<double>(r) + 0.5 * (kRow - kBar);
    out += text(kLeft - 7, v + kBar - 4, "tick end", timeline.row_names[r]);
    for (const Stretch& s : timeline.rows[r])
      out += "<rect class=\"state " + s.style + "\" x=\"" + px(x.at(s.from)) + "\" width=\"" +
             px(std::max(0.8, x.at(s.to) - x.at(s.from))) + "\" y=\"" + px(v) + "\" height=\"" + px(kBar) +
             "\"/>";
  }
  out += text(0.5 * (x.from + x.to), bottom + 33, "label mid", timeline.x_label);
  return out + "</svg>";
}

}  // namespace st
