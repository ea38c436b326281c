#include "algo/control/path.hpp"

#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

// A curvature that changes at speed makes the yaw rate jump. By so much it may: 25 mm/s at each wheel, which
// the robot's own speed control smooths within 15 ms.
constexpr double kYawRateJump_rps = 0.2;

double least(double a, double b) { return a < b ? a : b; }
double most(double a, double b) { return a > b ? a : b; }

bool rolls(const PathSegment& s) { return s.kind == SegmentKind::kLine || s.kind == SegmentKind::kArc; }

// The trapezoid over `extent` from entry to exit speed; the top is lowered where there is no room to reach
// it.
void shape_profile(PathSegment& s) {
  const double v0 = s.entry_speed, v1 = s.exit_speed, a = s.accel;
  if (2 * s.top_speed * s.top_speed - v0 * v0 - v1 * v1 > 2 * a * s.extent)
    s.top_speed = std::sqrt(most(0.0, a * s.extent + 0.5 * (v0 * v0 + v1 * v1)));
  s.rise_s = most(0.0, s.top_speed - v0) / a;
  const double fall_s = most(0.0, s.top_speed - v1) / a;
  const double ramps = 0.5 * (v0 + s.top_speed) * s.rise_s + 0.5 * (v1 + s.top_speed) * fall_s;
  s.hold_s = s.top_speed > 0 ? most(0.0, s.extent - ramps) / s.top_speed : 0.0;
  s.duration_s = s.rise_s + s.hold_s + fall_s;
}

struct Progress {
  double extent, speed;
};

Progress progress_at(const PathSegment& s, double t_s) {
  if (s.kind == SegmentKind::kWait) return {0, 0};
  if (t_s >= s.duration_s) return {s.extent, s.exit_speed};
  if (t_s < s.rise_s) return {s.entry_speed * t_s + 0.5 * s.accel * t_s * t_s, s.entry_speed + s.accel * t_s};
  if (t_s < s.rise_s + s.hold_s)
    return {0.5 * (s.entry_speed + s.top_speed) * s.rise_s + s.top_speed * (t_s - s.rise_s), s.top_speed};
  const double left_s = s.duration_s - t_s;  // counted from the end, so that it ends exactly there
  return {s.extent - s.exit_speed * left_s - 0.5 * s.accel * left_s * left_s,
          s.exit_speed + s.accel * left_s};
}

// The pose after `extent` of the segment. On an arc: chord 2 sin(turn / 2) / curvature in the direction of
// the half turn.
PathSample advance(const PathSegment& s, double extent) {
  PathSample p = s.start;
  double chord_m = 0, turn_rad = 0;
  if (s.kind == SegmentKind::kLine) chord_m = s.direction * extent;
  if (s.kind == SegmentKind::kTurn) turn_rad = s.direction * extent;
  if (s.kind == SegmentKind::kArc) {
    turn_rad = s.curvature * extent;
    chord_m = 2 * sin_cos(0.5 * turn_rad).sin / s.curvature;
  }
  const SinCos heading = sin_cos(p.yaw_rad + 0.5 * turn_rad);
  p.x_m += chord_m * heading.cos;
  p.y_m += chord_m * heading.sin;
  p.yaw_rad += turn_rad;
  return p;
}

double way_m(const PathSegment& s, double extent) {
  return s.kind == SegmentKind::kLine ? s.direction * extent : s.kind == SegmentKind::kArc ? extent : 0.0;
}

PathSample sample_segment(const PathSegment& s, double local_s) {
  const Progress progress = progress_at(s, local_s);
  PathSample p = advance(s, progress.extent);
  p.t_s = s.start.t_s + local_s;
  p.v_mps = rolls(s) ? (s.kind == SegmentKind::kLine ? s.direction : 1.0) * progress.speed : 0.0;
  p.w_rps = s.kind == SegmentKind::kTurn ? s.direction * progress.speed : p.v_mps * s.curvature;
  return p;
}

// The last segment that has begun; at most ten halvings.
std::size_t segment_at(const Path& path, double t_s) {
  std::size_t low = 0, high = path.size();
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (path.segment(middle).start.t_s <= t_s ? low : high) = middle;
  }
  return low;
}

double local_time(const PathSegment& s, double t_s) {
  return least(most(0.0, t_s - s.start.t_s), s.duration_s);
}

}  // namespace

bool Path::add_line(double length_m) {
  PathSegment s;
  s.kind = SegmentKind::kLine;
  s.extent = std::fabs(length_m);
  s.direction = length_m < 0 ? -1 : 1;
  return segments_.push_back(s);
}

bool Path::add_arc(double radius_m, double angle_rad) {
  PathSegment s;
  s.kind = SegmentKind::kArc;
  s.extent = std::fabs(angle_rad) * radius_m;
  s.direction = angle_rad < 0 ? -1 : 1;
  s.curvature = s.direction / radius_m;
  return segments_.push_back(s);
}

bool Path::add_turn(double angle_rad) {
  PathSegment s;
  s.kind = SegmentKind::kTurn;
  s.extent = std::fabs(angle_rad);
  s.direction = angle_rad < 0 ? -1 : 1;
  return segments_.push_back(s);
}

bool Path::add_wait(double seconds) {
  PathSegment s;
  s.extent = seconds;
  return segments_.push_back(s);
}

bool Path::add_square(double side_m, double direction) {
  bool fits = true;
  for (int i = 0; i < 4; ++i) fits = add_line(side_m) && add_turn(direction * 0.5 * kPi) && fits;
  return fits;
}

double Path::top_speed(const PathSegment& s) const {
  if (s.kind == SegmentKind::kTurn) return limits.turn_rps;
  return s.kind == SegmentKind::kArc ? least(limits.speed_mps, limits.turn_rps / std::fabs(s.curvature))
                                     : limits.speed_mps;
}

double Path::junction_speed(const PathSegment& a, const PathSegment& b) const {
  const bool same_way = rolls(a) && rolls(b) && !(a.kind == SegmentKind::kLine && a.direction < 0) &&
                        !(b.kind == SegmentKind::kLine && b.direction < 0);
  if (!same_way) return 0;
  const double speed = least(top_speed(a), top_speed(b)), jump = std::fabs(a.curvature - b.curvature);
  return jump * speed > kYawRateJump_rps ? kYawRateJump_rps / jump : speed;
}

void Path::plan() {
  // What braking before the end allows, from the last segment back; then what speeding up from the start
  // allows.
  double next_entry = 0;
  for (std::size_t i = segments_.size(); i-- > 0;) {
    PathSegment& s = segments_[i];
    s.accel = s.kind == SegmentKind::kTurn ? limits.turn_accel_rps2 : limits.accel_mps2;
    s.top_speed = top_speed(s);
    s.exit_speed = next_entry;
    const double brakes_from = std::sqrt(next_entry * next_entry + 2 * s.accel * s.extent);
    s.entry_speed = i == 0 ? 0 : least(junction_speed(segments_[i - 1], s), brakes_from);
    next_entry = s.entry_speed;
  }
  PathSample at;
  double entry = 0, travel_m = 0;
  for (PathSegment& s : segments_) {
    s.entry_speed = entry;
    s.exit_speed = least(s.exit_speed, std::sqrt(entry * entry + 2 * s.accel * s.extent));
    entry = s.exit_speed;
    s.start = at;
    s.start_travel_m = travel_m;
    travel_m += way_m(s, s.extent);
    if (s.kind == SegmentKind::kWait)
      s.duration_s = s.extent;
    else
      shape_profile(s);
    at = advance(s, s.kind == SegmentKind::kWait ? 0 : s.extent);
    at.t_s = s.start.t_s + s.duration_s;
  }
}

double Path::duration_s() const {
  if (empty()) return 0;
  const PathSegment& last = segments_[size() - 1];
  return last.start.t_s + last.duration_s;
}

double Path::length_m() const {
  double sum = 0;
  for (const PathSegment& s : segments_) sum += rolls(s) ? s.extent : 0;
  return sum;
}

double Path::fastest_wheel_mps(double wheel_base_m) const {
  double fastest = 0;
  for (const PathSegment& s : segments_) {
    const double v = rolls(s) ? top_speed(s) : 0.0;
    const double w = s.kind == SegmentKind::kTurn ? top_speed(s) : v * std::fabs(s.curvature);
    fastest = most(fastest,
                   wheel_speeds(v, w, wheel_base_m).right_mps);  // to the left, the right one is the faster
  }
  return fastest;
}

PathSample sample(const Path& path, double t_s) {
  if (path.empty()) return {};
  const PathSegment& s = path.segment(segment_at(path, t_s));
  PathSample p = sample_segment(s, local_time(s, t_s));
  if (t_s <= 0 || t_s >= path.duration_s()) p.v_mps = p.w_rps = 0;
  p.t_s = t_s;
  return p;
}

WheelWay wheel_way(const Path& path, double t_s, double wheel_base_m) {
  if (path.empty()) return {};
  const PathSegment& s = path.segment(segment_at(path, t_s));
  const double extent = progress_at(s, local_time(s, t_s)).extent;
  const double way = s.start_travel_m + way_m(s, extent),
               half = 0.5 * wheel_base_m * advance(s, extent).yaw_rad;
  return {way - half, way + half};
}

WheelSpeeds wheel_speeds(double v_mps, double w_rps, double wheel_base_m) {
  const double difference = 0.5 * w_rps * wheel_base_m;
  return {v_mps - difference, v_mps + difference};
}

}  // namespace st
