#include "firmware_like/degradation.hpp"

namespace st {

const LadderStep& ladder_step(int level) {
  return kLadder[level < 0 ? 0 : level >= kLevels ? kLevels - 1 : level];
}

int Degradation::next(double cpu_us) {
  if (since_step_back_ >= 0) ++since_step_back_;
  if (cpu_us > kLate * period_us_) {
    // Late soon after work was taken back: that was too early, so the next attempt waits longer.
    if (since_step_back_ >= 0 && since_step_back_ <= wait_)
      wait_ = wait_ * 2 < kMostEasyFrames ? wait_ * 2 : kMostEasyFrames;
    since_step_back_ = -1;
    easy_ = 0;
    if (level_ + 1 < kLevels) ++level_;
    return level_;
  }
  if (since_step_back_ > wait_) {  // the step back held
    since_step_back_ = -1;
    wait_ = kEasyFrames;
  }
  easy_ = cpu_us < kEasy * period_us_ ? easy_ + 1 : 0;
  if (level_ > 0 && easy_ >= wait_) {
    --level_;
    easy_ = 0;
    since_step_back_ = 0;
  }
  return level_;
}

}  // namespace st
