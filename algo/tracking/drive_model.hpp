// What the way of driving says about the heading. Wheels do not slip sideways: a differential-drive robot
// moves along its heading, so where it went tells how it stands, whatever its look says. That an object
// drives like this is recognised, never assumed, and forward in its own frame is learned from its own motion;
// the same constraint as in algo/control/base_estimate.hpp, kept up from frame to frame.
#pragma once

#include "algo/core/fixed_vector.hpp"
#include "algo/core/pose.hpp"

namespace st {

// The heading that the motion up to now implies, on the floor.
struct ExpectedHeading {
  bool known = false;
  double yaw_rad = 0, sigma_rad = 0;
  double rate_rps = 0;  // how fast it turns
};

class DriveModel {
 public:
  void reset() { *this = DriveModel{}; }

  // A good pose: the object's origin and yaw on the floor. In order of time, whether recognised or not.
  // From a heading that is in doubt nothing is learned but that it fits the axis or does not: a picture that
  // contradicts the axis for half a metre is right in the end.
  void add(double t_s, const Pose2& pose, bool doubt);

  // The headings lately added were wrong by so much.
  void turn_recent(double by_rad);

  // Along its own axis to within about five degrees, over a quarter of a metre and more.
  bool recognised() const;

  // For the object at `predicted`, from where it came. Unknown while it hardly moved within the last second,
  // and before it is recognised.
  ExpectedHeading expect(double t_s, const Pose2& predicted) const;

 private:
  struct Sample {
    double t_s = 0;
    Pose2 pose;
  };
  struct Axis {
    double cos = 1, sin = 0;  // forward or backward, in the object's frame
    double offset_m = 0;      // of the turning centre along it
    double lateral = 0;       // motion across it beside motion along it, root of the ratio of squares
  };
  struct Motion {  // in the object's own axes
    double x_m = 0, y_m = 0, turn_rad = 0;
    void add_step(const Pose2& from, const Pose2& to);
    double length_m() const;
  };
  void learn(const Motion& window, bool doubt);
  Axis axis() const;
  ExpectedHeading expect_by_headings(double t_s, const Pose2& predicted, const Axis& drive) const;
  ExpectedHeading expect_by_places(double t_s, const Pose2& predicted, const Axis& drive) const;
  static double heading_error(const Motion& motion, const Axis& axis);

  FixedVector<Sample, 32> recent_;
  Motion window_;
  double scatter_[3][3]{};  // of (along x, along y, turn), one a window
  double travel_m_ = 0;
  bool backward_ = false;  // against the axis, when it last moved
  int misfits_ = 0;        // windows in a row that contradict the axis
};

}  // namespace st
