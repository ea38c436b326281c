#include "firmware_like/safety_supervisor.hpp"

#include <cmath>

namespace st {
namespace {

constexpr double kAfterBump_s = 0.5;  // what was in the way is given time to go on its way

}  // namespace

Reaction SafetySupervisor::judge(double now_s, const RobotStatus& status, const Sight& sight,
                                 const WheelSpeeds& told) {
  if (ended_) return Reaction::kEnd;
  const bool blind = blind_too_long(now_s, sight, told);
  last_s_ = now_s;
  RobotFault fault = status.fault;
  Reaction reaction = judge_robot(now_s, fault);
  if (reaction == Reaction::kNone && sight.watched && sight.age_s * 1000 > kStaleFrame_ms) {
    fault = RobotFault::kStale;
    reaction = rule_of(fault).reaction;
  }
  if (reaction != Reaction::kEnd && blind) {
    fault = RobotFault::kNotSeen;
    reaction = rule_of(fault).reaction;
  }
  ended_ = reaction == Reaction::kEnd;
  fault_ = reaction == Reaction::kNone ? RobotFault::kNone : fault;
  return reaction;
}

Reaction SafetySupervisor::judge_robot(double now_s, RobotFault fault) {
  if (fault == RobotFault::kBump && on_bump_ == Reaction::kHold) hold_until_s_ = now_s + kAfterBump_s;
  if (fault != RobotFault::kNone && fault != RobotFault::kBump) return rule_of(fault).reaction;
  if (now_s < hold_until_s_) return Reaction::kHold;
  return fault == RobotFault::kBump ? on_bump_ : Reaction::kNone;
}

// Only what is driven blindly counts, a turn on the spot included: a robot that waits may be out of sight.
bool SafetySupervisor::blind_too_long(double now_s, const Sight& sight, const WheelSpeeds& told) {
  if (!sight.watched) return false;
  if (sight.sees) {
    seen_ = true;
    blind_s_ = blind_m_ = 0;
  } else if ((told.left_mps != 0 || told.right_mps != 0) && last_s_ >= 0) {
    blind_s_ += now_s - last_s_;
    blind_m_ += (now_s - last_s_) * 0.5 * std::fabs(told.left_mps + told.right_mps);
  }
  return blind_s_ > (seen_ ? kBlindTime_s : kUnseenTime_s) ||
         blind_m_ > (seen_ ? kBlindDistance_m : kUnseenDistance_m);
}

}  // namespace st
