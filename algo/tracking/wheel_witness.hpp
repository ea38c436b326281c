// Whether the wheels of the robot may tell how the object turns. They do while what is seen agrees; a robot
// that is lifted, held fast or slips turns another way than they say, and then they are not asked for a
// while.
#pragma once

#include <cmath>

namespace st {

class WheelWitness {
 public:
  // Another frame whose turn the wheels told: what was seen turned further than that by `more_rad`.
  void seen(double told_rad, double more_rad) {
    constexpr double kPace = 0.2, kLeast_rad = 0.004, kShare = 0.15;
    constexpr int kDoubtFrames = 45;
    misfit_rad_ += kPace * (more_rad - misfit_rad_);
    if (std::fabs(misfit_rad_) <= kLeast_rad + kShare * std::fabs(told_rad)) return;
    misfit_rad_ = 0;
    doubt_frames_ = kDoubtFrames;
  }
  // Once a frame, before it is used.
  bool trusted() { return doubt_frames_ == 0 || --doubt_frames_ == 0; }

 private:
  double misfit_rad_ = 0;
  int doubt_frames_ = 0;
};

}  // namespace st
