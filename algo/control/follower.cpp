#include "algo/control/follower.hpp"

#include <cmath>

namespace st {
namespace {

constexpr double kFinest_mps = 0.001;
constexpr double kFastest_mps = 0.5;  // of a Create's wheel
constexpr double kClose_m = 0.0005;   // half the step of what a Create can be told in a second
constexpr double kLongestMakingUp_s = 1.0;
// What is missing is made up over as long as a tick may last at all: one that lasts longer than expected then
// overshoots by nothing, where making it up within the tick would overshoot by many times what was missing.
constexpr double kMakeUp_s = 0.25;

double most(double a, double b) { return a > b ? a : b; }

double rounded(double mps, double fastest_mps) {
  const double whole = kFinest_mps * std::floor(mps / kFinest_mps + 0.5);
  return whole > fastest_mps ? fastest_mps : whole < -fastest_mps ? -fastest_mps : whole;
}

}  // namespace

OpenLoopFollower::OpenLoopFollower(const Path& path, double wheel_base_m)
    : path_(&path), wheel_base_m_(wheel_base_m) {
  const double path_mps = kFinest_mps * std::ceil(path.fastest_wheel_mps(wheel_base_m) / kFinest_mps);
  fastest_mps_ = path_mps < kFastest_mps ? path_mps : kFastest_mps;
}

void OpenLoopFollower::roll(double passed_s) {
  rolled_.left_m += commanded_.left_mps * passed_s;
  rolled_.right_m += commanded_.right_mps * passed_s;
}

bool OpenLoopFollower::done() const {
  if (time_s_ < path_->duration_s()) return false;
  const WheelWay due = wheel_way(*path_, time_s_, wheel_base_m_);
  return (std::fabs(due.left_m - rolled_.left_m) < kClose_m &&
          std::fabs(due.right_m - rolled_.right_m) < kClose_m) ||
         time_s_ > path_->duration_s() + kLongestMakingUp_s;
}

WheelSpeeds OpenLoopFollower::step(double passed_s, double tick_s) {
  time_s_ += passed_s;
  roll(passed_s);
  commanded_ = {};
  if (done()) return commanded_;
  const WheelWay now = wheel_way(*path_, time_s_, wheel_base_m_),
                 next = wheel_way(*path_, time_s_ + tick_s, wheel_base_m_);
  const double make_up_s = most(tick_s, kMakeUp_s);
  const auto speed = [&](double now_m, double next_m, double rolled_m) {
    return rounded((next_m - now_m) / tick_s + (now_m - rolled_m) / make_up_s, fastest_mps_);
  };
  commanded_ = {speed(now.left_m, next.left_m, rolled_.left_m),
                speed(now.right_m, next.right_m, rolled_.right_m)};
  return commanded_;
}

void OpenLoopFollower::hold(double passed_s) {
  roll(passed_s);
  commanded_ = {};
}

}  // namespace st
