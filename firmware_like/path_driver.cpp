#include "firmware_like/path_driver.hpp"

namespace st {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;
// After a longer stall than the guard's patience the robot stood, and the path's time with it.
constexpr double kLongestStep_s = 0.25;

}  // namespace

PathDriver::PathDriver(DriveBase& robot, const Path& path, Reaction on_bump)
    : robot_(robot), follower_(path, robot.geometry().wheel_base_m), supervisor_(on_bump) {}

void PathDriver::decide(double now_s, const Sight& sight) {
  if (first_s_ < 0) first_s_ = last_s_ = now_s;
  const double passed_s = now_s - last_s_ < kLongestStep_s ? now_s - last_s_ : kLongestStep_s;
  last_s_ = now_s;
  reaction_ = supervisor_.judge(now_s, status_, sight, speeds_);
  speeds_ = {};
  if (reaction_ != Reaction::kNone) {
    follower_.hold(passed_s);
    return;
  }
  if (now_s - first_s_ < kStillBefore_s) return;
  if (!follower_.done())
    speeds_ = follower_.step(passed_s, kFrame_s);
  else if (done_s_ < 0)
    done_s_ = now_s;
}

void PathDriver::wait_without_frame(double now_s) {
  if (first_s_ < 0 || (now_s - last_s_) * 1000 < kStaleFrame_ms) return;
  speeds_ = {};
  robot_.stop();
}

void PathDriver::send() { robot_.drive(speeds_.left_mps, speeds_.right_mps); }

bool PathDriver::finished(double now_s) const { return done_s_ >= 0 && now_s - done_s_ > kStillAfter_s; }

}  // namespace st
