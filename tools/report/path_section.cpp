#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "tools/report/sections.hpp"
#include "tools/report/svg_chart.hpp"

namespace st {
namespace {

constexpr double kDegreesPerRad = 180 / kPi;
constexpr double kMillimetres = 1e3;

// A gap of more than a few frames is a gap in the line.
constexpr double kGapS = 0.3;

template <typename Samples, typename ToPoint>
std::vector<std::vector<ChartPoint>> pieces(const Samples& samples, ToPoint to_point) {
  std::vector<std::vector<ChartPoint>> lines;
  double last_t_s = -1e300;
  for (const auto& s : samples) {
    if (s.t_s - last_t_s > kGapS) lines.emplace_back();
    lines.back().push_back(to_point(s));
    last_t_s = s.t_s;
  }
  return lines;
}

std::vector<std::vector<ChartPoint>> laid(const PathStudy& path, const Pose2& T_floor_path) {
  const Pose2 from_placed = compose(T_floor_path, inverse(path.comparison.as_placed.T_floor_path));
  std::vector<std::vector<ChartPoint>> lines(1);
  for (const PathSample& s : path.on_floor) {
    const Pose2 p = compose(from_placed, {s.x_m, s.y_m, s.yaw_rad});
    lines[0].push_back({p.x, p.y});
  }
  return lines;
}

std::string map_figure(const ReportInput& input) {
  Chart map;
  map.x_label = "x on the floor, away from the camera (m)";
  map.y_label = "y on the floor (m)";
  map.equal_axes = true;
  map.height = 560;
  const PathStudy& path = input.study.path;
  if (path.object != 0) {
    const Pose2& T = path.comparison.as_placed.T_floor_path;
    map.series.push_back({"preset, as placed", "preset", laid(path, T)});
    map.series.push_back({"preset, best fit", "shape", laid(path, path.comparison.shape.T_floor_path)});
    map.marks.push_back({path.on_floor.front().x_m, path.on_floor.front().y_m, path.on_floor.front().yaw_rad,
                         "preset", ChartMark::Kind::kArrow});
  }
  for (const ObjectStudy& object : input.study.objects) {
    const std::string name = "actual, object " + std::to_string(object.id);
    const bool drove = path.object == 0 || object.id == path.object;
    if (object.has_base) {
      map.series.push_back(
          {name, drove ? "actual" : "other", pieces(object.driven, [](const PlanarSample& s) {
             return ChartPoint{s.x_m, s.y_m};
           })});
      const PlanarSample &a = object.driven.front(), &b = object.driven.back();
      map.marks.push_back({a.x_m, a.y_m, a.yaw_rad, drove ? "actual" : "other", ChartMark::Kind::kDot});
      map.marks.push_back({b.x_m, b.y_m, b.yaw_rad, drove ? "actual" : "other", ChartMark::Kind::kSquare});
      continue;
    }
    for (const RunRecord::Object& record : input.run.objects) {
      std::vector<ObjectRow> rows = record.id == object.id ? record.rows : std::vector<ObjectRow>{};
      std::erase_if(rows, [](const ObjectRow& row) { return !row.has_pose; });
      if (rows.empty()) continue;
      map.series.push_back({name, "other", pieces(rows, [](const ObjectRow& r) {
                              return ChartPoint{r.x_m, r.y_m};
                            })});
      map.marks.push_back({rows.front().x_m, rows.front().y_m, 0, "other", ChartMark::Kind::kDot});
      map.marks.push_back({rows.back().x_m, rows.back().y_m, 0, "other", ChartMark::Kind::kSquare});
    }
  }
  if (map.series.empty()) return {};
  return figure(draw(map),
                "Seen from above, to scale. Arrow: start and heading of the preset path; dot: where the "
                "object was first "
                "measured; square: where it was last.");
}

std::string row(const std::string& name, const std::string& placed, const std::string& shape) {
  return "<tr><th>" + name + "</th><td>" + placed + "</td><td>" + shape + "</td></tr>";
}

// From the end of the path, laid as measured, to where the base last moved.
double stopped_off(const PathStudy& path, const PathMeasure& measure) {
  const PathComparison& c = path.comparison;
  const PathSample& end = path.on_floor.back();
  const Pose2 from_placed = compose(measure.T_floor_path, inverse(c.as_placed.T_floor_path));
  const Pose2 there = compose(from_placed, {end.x_m, end.y_m, end.yaw_rad});
  const PlanarSample& last = path.driven[c.first + c.count - 1];
  return std::hypot(last.x_m - there.x, last.y_m - there.y);
}

std::string error_table(const PathStudy& path) {
  const PathComparison& c = path.comparison;
  const auto mm = [](double metres) { return number(metres * kMillimetres, 1) + " mm"; };
  const auto deg = [](double rad) { return number(rad * kDegreesPerRad, 2) + "&deg;"; };
  const auto percent = [](double share) { return number(share * 100, 1) + " %"; };
  std::string out =
      "<table class=\"errors\"><thead><tr><th></th><th>as placed</th><th>by shape</th></tr></thead><tbody>";
  out += row("distance from the path, RMS", mm(c.as_placed.rmse_m), mm(c.shape.rmse_m));
  out += row("distance from the path, largest", mm(c.as_placed.max_m), mm(c.shape.max_m));
  out += row("heading error, RMS", deg(c.as_placed.heading_rmse_rad), deg(c.shape.heading_rmse_rad));
  out += row("time within " + number(kPathBandM * 100, 0) + " cm of the path", percent(c.as_placed.in_band),
             percent(c.shape.in_band));
  out += row("where it stopped, from the end of the path", mm(stopped_off(path, c.as_placed)),
             mm(stopped_off(path, c.shape)));
  if (c.is_circle) {
    const double off =
        std::hypot(c.driven_circle.x_m - c.preset_circle.x_m, c.driven_circle.y_m - c.preset_circle.y_m);
    const Pose2 fit = compose(c.shape.T_floor_path, inverse(c.as_placed.T_floor_path));
    const Pose2 centre = compose(fit, {c.preset_circle.x_m, c.preset_circle.y_m, 0});
    const double off_shape = std::hypot(c.driven_circle.x_m - centre.x, c.driven_circle.y_m - centre.y);
    out += row("centre of the circle beside the preset one", mm(off), mm(off_shape));
  }
  out += "</tbody></table>";
  if (c.is_circle) {
    const auto metres = [](double v) { return number(v, 4) + " m"; };
    const auto centre = [](const CircleFit& fit) {
      return "(" + number(fit.x_m, 3) + ", " + number(fit.y_m, 3) + ") m";
    };
    out +=
        "<table "
        "class=\"errors\"><thead><tr><th>circle</th><th>preset</th><th>driven</th></tr></thead><tbody>";
    out += row("radius", metres(c.preset_circle.radius_m), metres(c.driven_circle.radius_m));
    out += row("centre on the floor", centre(c.preset_circle), centre(c.driven_circle));
    out += row("distance from the circle, RMS", mm(c.preset_circle.rms_m), mm(c.driven_circle.rms_m));
    out += "</tbody></table>";
  }
  return out +
         "<p class=\"note\"><b>As placed</b>: the path starts at the pose where the robot's base was first "
         "measured. <b>By "
         "shape</b>: the start pose is fitted out, and what remains is the error of the shape. Every moment "
         "is held against "
         "the place on the path that the robot had reached by then, so a late start or a slow robot is no "
         "error here.</p>";
}

std::string error_charts(const ReportInput& input) {
  const PathStudy& path = input.study.path;
  Chart offset, heading;
  offset.x_label = heading.x_label = "time (s)";
  offset.y_label = "offset (mm)";
  heading.y_label = "heading error (deg)";
  offset.band = kPathBandM * kMillimetres;
  offset.zero_in_y = heading.zero_in_y = true;
  offset.x_high = heading.x_high = input.length_s();
  const auto add = [&](const std::vector<PathError>& errors, const char* name, const char* style) {
    const double t0 = input.t0_s;
    offset.series.push_back({name, style, pieces(errors, [t0](const PathError& e) {
                               return ChartPoint{e.t_s - t0, e.offset_m * kMillimetres};
                             })});
    heading.series.push_back({name, style, pieces(errors, [t0](const PathError& e) {
                                return ChartPoint{e.t_s - t0, e.heading_rad * kDegreesPerRad};
                              })});
  };
  add(path.shaped, "by shape", "shape");
  add(path.placed, "as placed", "actual");
  return figure(draw(offset),
                "Distance from the path while it drove; positive is to the left of it. Shaded: within " +
                    number(kPathBandM * 100, 0) + " cm.") +
         figure(draw(heading), "Heading of the robot beside that of the path.");
}

}  // namespace

std::string path_section(const ReportInput& input) {
  const PathStudy& path = input.study.path;
  if (path.object == 0) return section("Path on the floor", map_figure(input));
  return section("Preset and actual path", map_figure(input) + error_table(path)) +
         section("Errors over time", error_charts(input));
}

}  // namespace st
