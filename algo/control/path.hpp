// The preset path: what the user programmed, as a sequence of motions with speeds that the robot can follow.
// Frame: where the robot stands at the start, x forward, y left, yaw counter-clockwise and unwrapped.
#pragma once

#include <cstdint>

#include "algo/control/path_sample.hpp"
#include "algo/core/fixed_vector.hpp"

namespace st {

struct PathLimits {
  double speed_mps = 0.2;  // of the body on lines and arcs
  double accel_mps2 = 0.4;
  double turn_rps = 1.0;  // yaw rate, in turns and on arcs
  double turn_accel_rps2 = 2.0;
};

enum class SegmentKind : std::uint8_t { kLine, kArc, kTurn, kWait };

// `extent` is what the segment measures: metres on lines and arcs, radians of a turn, seconds of a wait;
// never negative. `direction` is -1 backwards on a line, and to the right in a turn or on an arc.
struct PathSegment {
  SegmentKind kind = SegmentKind::kWait;
  double extent = 0, direction = 1;
  double curvature = 0;  // 1/m, signed, of an arc

  // Filled in by plan(): the trapezoid in units of extent per second, and the state at the segment's start.
  double entry_speed = 0, top_speed = 0, exit_speed = 0, accel = 0;
  double rise_s = 0, hold_s = 0, duration_s = 0;
  PathSample start;
  double start_travel_m = 0;  // way of the body until here, backwards counted negative
};

class Path {
 public:
  static constexpr std::size_t kMaxSegments = 512;

  PathLimits limits;

  // Each false when the path is full; what it holds then is not the path that was meant.
  bool add_line(double length_m);                   // negative: backwards
  bool add_arc(double radius_m, double angle_rad);  // radius > 0; left is positive
  bool add_turn(double angle_rad);                  // in place; left is positive
  bool add_wait(double seconds);
  bool add_square(double side_m, double direction);  // 1: to the left; four sides, four turns

  // Gives every segment its speeds and start. Between two segments the robot goes on as fast as the jump in
  // curvature allows, and stops only where it must. Call it after the last add.
  void plan();

  bool empty() const { return segments_.empty(); }
  std::size_t size() const { return segments_.size(); }
  const PathSegment& segment(std::size_t i) const { return segments_[i]; }
  double duration_s() const;
  double length_m() const;  // along lines and arcs
  // The fastest that a wheel turns anywhere on a robot with this base.
  double fastest_wheel_mps(double wheel_base_m) const;

 private:
  double top_speed(const PathSegment& segment) const;
  double junction_speed(const PathSegment& a, const PathSegment& b) const;

  FixedVector<PathSegment, kMaxSegments> segments_;
};

// The planned path at t_s seconds after its start; its first pose before, its last pose (at rest) after.
PathSample sample(const Path& path, double t_s);

// What each wheel has rolled from the start until t_s, backwards counted negative.
struct WheelWay {
  double left_m = 0, right_m = 0;
};
WheelWay wheel_way(const Path& path, double t_s, double wheel_base_m);

struct WheelSpeeds {
  double left_mps = 0, right_mps = 0;
};
WheelSpeeds wheel_speeds(double v_mps, double w_rps, double wheel_base_m);

}  // namespace st
