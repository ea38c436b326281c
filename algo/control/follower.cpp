#include "algo/control/follower.hpp"

#include <cmath>

namespace st {
namespace {

constexpr double kFinest_mps = 0.001;
constexpr double kFastest_mps = 0.5;  // of a Create's wheel
constexpr double kClose_m = 0.0005;   // half the step of what a Create can be told in a second
constexpr double kLongestMakingUp_s = 1.0;

double speed_for(double missing_m, double tick_s) {
  const double mps = kFinest_mps * std::floor(missing_m / tick_s / kFinest_mps + 0.5);
  return mps > kFastest_mps ? kFastest_mps : mps < -kFastest_mps ? -kFastest_mps : mps;
}

}  // namespace

WheelWay OpenLoopFollower::missing(double at_s) const {
  const WheelWay due = wheel_way(*path_, at_s, wheel_base_m_);
  return {due.left_m - rolled_.left_m, due.right_m - rolled_.right_m};
}

bool OpenLoopFollower::done() const {
  if (time_s_ < path_->duration_s()) return false;
  const WheelWay rest = missing(time_s_);
  return (std::fabs(rest.left_m) < kClose_m && std::fabs(rest.right_m) < kClose_m) ||
         time_s_ > path_->duration_s() + kLongestMakingUp_s;
}

WheelSpeeds OpenLoopFollower::step(double passed_s, double tick_s) {
  time_s_ += passed_s;
  rolled_.left_m += commanded_.left_mps * passed_s;
  rolled_.right_m += commanded_.right_mps * passed_s;
  const WheelWay next = missing(time_s_ + tick_s);
  commanded_ =
      done() ? WheelSpeeds{} : WheelSpeeds{speed_for(next.left_m, tick_s), speed_for(next.right_m, tick_s)};
  return commanded_;
}

void OpenLoopFollower::hold(double passed_s) {
  rolled_.left_m += commanded_.left_mps * passed_s;
  rolled_.right_m += commanded_.right_mps * passed_s;
  commanded_ = {};
}

}  // namespace st
