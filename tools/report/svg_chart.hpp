// Line charts as inline SVG.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace st {

std::string escape_html(std::string_view text);

struct ChartPoint {
  double x = 0, y = 0;
};

struct Series {
  std::string name;                            // in the legend; empty: not there
  std::string style;                           // CSS class: preset, actual, shape, faint
  std::vector<std::vector<ChartPoint>> lines;  // separate pieces: a gap in the data is a gap in the line
};

struct ChartMark {
  double x = 0, y = 0, yaw_rad = 0;
  std::string style;  // CSS class
  enum class Kind { kDot, kArrow, kSquare } kind = Kind::kDot;
};

struct Chart {
  std::string x_label, y_label;
  std::vector<Series> series;
  std::vector<ChartMark> marks;
  double band = 0;               // half-height of a shaded band about zero; 0: none
  double x_low = 0, x_high = 0;  // that the x axis must hold; equal: whatever the data needs
  bool equal_axes = false;       // a map: one scale for both, grid in the same steps
  bool zero_in_y = false;
  double width = 760, height = 190;
};

std::string draw(const Chart& chart);

// Bars from zero: x edges (count + 1) and heights.
struct BarChart {
  std::string x_label, y_label;
  std::vector<double> edges, heights;
  bool log_heights = false;
  double width = 760, height = 190;
};
std::string draw(const BarChart& chart);

// Coloured stretches along one axis of time.
struct Stretch {
  double from = 0, to = 0;
  std::string style;
};
struct Timeline {
  std::vector<std::string> row_names;
  std::vector<std::vector<Stretch>> rows;
  std::string x_label;
  double x_low = 0, x_high = 1;
  double width = 760;
};
std::string draw(const Timeline& timeline);

}  // namespace st
