#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "tools/report/sections.hpp"
#include "tools/report/svg_chart.hpp"

namespace st {
namespace {

constexpr double kGapS = 0.3, kHalfWindowS = 0.2;

struct Speed {
  double t_s = 0, v_mps = 0, w_rps = 0, yaw_rad = 0;
  bool fresh = false;  // first after a gap
};

// Slopes of lines through the samples within a fifth of a second: speeds as they were, without the noise of
// differences.
std::vector<Speed> speeds_of(const std::vector<PlanarSample>& driven) {
  std::vector<double> yaw(driven.size());
  for (std::size_t i = 0; i < driven.size(); ++i)
    yaw[i] = i == 0 ? driven[0].yaw_rad : yaw[i - 1] + wrap_angle(driven[i].yaw_rad - yaw[i - 1]);
  std::vector<Speed> speeds;
  std::size_t from = 0;
  for (std::size_t i = 0; i < driven.size(); ++i) {
    const bool fresh = i == 0 || driven[i].t_s - driven[i - 1].t_s > kGapS;
    if (fresh) from = i;
    while (driven[i].t_s - driven[from].t_s > kHalfWindowS) ++from;
    double n = 0, st = 0, stt = 0, sum[3] = {0, 0, 0}, product[3] = {0, 0, 0};
    for (std::size_t k = from; k < driven.size() && driven[k].t_s - driven[i].t_s <= kHalfWindowS; ++k) {
      if (k > i && driven[k].t_s - driven[k - 1].t_s > kGapS) break;
      const double t = driven[k].t_s - driven[i].t_s, values[3] = {driven[k].x_m, driven[k].y_m, yaw[k]};
      n += 1, st += t, stt += t * t;
      for (int c = 0; c < 3; ++c)
        sum[c] += values[c] - (c == 2 ? yaw[i] : 0), product[c] += t * (values[c] - (c == 2 ? yaw[i] : 0));
    }
    const double det = n * stt - st * st;
    Speed speed{driven[i].t_s, 0, 0, yaw[i], fresh};
    if (det > 1e-12) {
      const auto slope = [&](int c) { return (n * product[c] - st * sum[c]) / det; };
      const SinCos h = sin_cos(yaw[i]);
      speed.v_mps = h.cos * slope(0) + h.sin * slope(1);
      speed.w_rps = slope(2);
    }
    speeds.push_back(speed);
  }
  return speeds;
}

template <typename Value>
std::vector<std::vector<ChartPoint>> over_time(const std::vector<Speed>& speeds, double t0_s, Value value) {
  std::vector<std::vector<ChartPoint>> lines;
  for (const Speed& s : speeds) {
    if (s.fresh) lines.emplace_back();
    lines.back().push_back({s.t_s - t0_s, value(s)});
  }
  return lines;
}

// The preset's value at the place that was reached at each moment, so that both stand over the same time.
template <typename Value>
std::vector<std::vector<ChartPoint>> preset_over_time(const ReportInput& input, Value value) {
  const PathStudy& path = input.study.path;
  std::vector<std::vector<ChartPoint>> lines(1);
  const double start_s = path.on_floor.front().t_s, origin_s = path.driven.front().t_s;
  for (const PathError& error : path.placed) {
    const double t = origin_s + error.path_t_s;
    const auto after = std::ranges::lower_bound(path.on_floor, std::max(t, start_s), {}, &PathSample::t_s);
    lines[0].push_back(
        {error.t_s - input.t0_s, value(after == path.on_floor.end() ? path.on_floor.back() : *after)});
  }
  return lines;
}

std::string speed_figures(const ReportInput& input) {
  Chart v, w, yaw;
  v.x_label = w.x_label = yaw.x_label = "time (s)";
  v.y_label = "speed v (m/s)";
  w.y_label = "turn rate w (rad/s)";
  yaw.y_label = "yaw (deg)";
  v.zero_in_y = w.zero_in_y = true;
  v.x_high = w.x_high = yaw.x_high = input.length_s();
  if (input.study.path.object != 0) {
    v.series.push_back(
        {"preset", "preset", preset_over_time(input, [](const PathSample& s) { return s.v_mps; })});
    w.series.push_back(
        {"preset", "preset", preset_over_time(input, [](const PathSample& s) { return s.w_rps; })});
  }
  for (const ObjectStudy& object : input.study.objects) {
    if (!object.has_base) continue;
    const std::vector<Speed> speeds = speeds_of(object.driven);
    const bool drove = input.study.path.object == 0 || object.id == input.study.path.object;
    const std::string name = "object " + std::to_string(object.id), style = drove ? "actual" : "other";
    v.series.push_back({name, style, over_time(speeds, input.t0_s, [](const Speed& s) { return s.v_mps; })});
    w.series.push_back({name, style, over_time(speeds, input.t0_s, [](const Speed& s) { return s.w_rps; })});
    yaw.series.push_back(
        {name, style, over_time(speeds, input.t0_s, [](const Speed& s) { return s.yaw_rad * 180 / kPi; })});
  }
  if (yaw.series.empty()) return {};
  return figure(draw(v), "Speed of the base along its heading.") +
         figure(draw(w), "Rate of turn, positive counter-clockwise.") +
         figure(draw(yaw), "Heading on the floor, unwrapped.");
}

std::string state_timeline(const ReportInput& input) {
  Timeline timeline;
  timeline.x_label = "time (s)";
  timeline.x_low = 0;
  timeline.x_high = input.length_s();
  for (const RunRecord::Object& object : input.run.objects) {
    timeline.row_names.push_back("object " + std::to_string(object.id));
    timeline.rows.emplace_back();
    std::vector<Stretch>& row = timeline.rows.back();
    for (const ObjectRow& r : object.rows) {
      const double t = r.t_s - input.t0_s;
      const bool same = !row.empty() && row.back().style == name_of(r.state) && t - row.back().to < kGapS;
      if (!row.empty() && t - row.back().to < kGapS) row.back().to = t;
      if (!same) row.push_back({t, t, name_of(r.state)});
    }
  }
  if (timeline.rows.empty()) return {};
  std::string key;
  for (const TrackState state :
       {TrackState::kGood, TrackState::kPredicted, TrackState::kPoor, TrackState::kLost})
    key += std::string("<span class=\"key ") + name_of(state) + "\"></span>" + name_of(state) + " ";
  return figure(draw(timeline), "State of the track: " + key);
}

}  // namespace

std::string motion_section(const ReportInput& input) {
  return section("Speed and heading", speed_figures(input)) + section("Tracking", state_timeline(input));
}

}  // namespace st
