// Open loop: which object went with the wheels, told from the whole drive. Nothing is steered by it.
#pragma once

#include "algo/control/start_motion.hpp"

namespace st {

class MotionMatch {
 public:
  void add(const WheelOdometry& wheels, const SeenObjects& objects);
  // The object whose motion the wheels explain best, and by far the most of it; 0: none.
  int best() const;

 private:
  struct Entry {
    int id = 0;
    bool seen = false;  // in the frame before
    Pose2 pose;
    BodyMotion window;
    double forward_m = 0, turn_rad = 0, duration_s = 0;
    WheelRegression regression;
    double turn_square = 0, turn_misfit = 0;  // of the windows, rad^2
    BaseGuess guess;
  };
  void add_to(Entry& entry, const WheelOdometry& wheels, const SeenObject& object);

  FixedVector<Entry, 16> entries_;
};

}  // namespace st
