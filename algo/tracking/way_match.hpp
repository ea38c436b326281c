// Which object goes along with the robot's wheels, told from the ways alone: the heading of a round thing may
// be the very thing that is not known yet.
#pragma once

#include "algo/core/fixed_vector.hpp"
#include "algo/core/pose.hpp"
#include "algo/core/records.hpp"

namespace st {

class WayMatch {
 public:
  // The wheels since the frame before, once for a frame; then every object with a good pose in it, by its
  // number (1 and up), in the plane.
  void begin_frame(const WheelOdometry& wheels);
  void add(int id, double x_m, double y_m);

  // The one object whose ways are those of the wheels; 0: none is, or more than one.
  int best() const;

 private:
  struct Entry {
    int id = 0;
    double x_m = 0, y_m = 0;        // where it was when the window began
    int window = -1;                // which one that was
    double told2 = 0, misfit2 = 0;  // squares of the ways told and of what was seen beside them
  };
  FixedVector<Entry, 16> entries_;
  Pose2 base_;  // since the window began
  double passed_s_ = 0;
  int window_ = 0;
  bool closes_ = false;  // with this frame
};

}  // namespace st
