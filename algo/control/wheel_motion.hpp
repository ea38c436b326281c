// How an object's motion goes with that of a robot's wheels. Both in the plane; the base is the point on the
// floor under the turning centre, forward as it drives. If the object is the robot, its origin moves, in its
// own axes, while the base goes f forward and turns by s:
//     ax = C f + by s      ay = S f - bx s      (C, S) = g (cos phi, sin phi)
// with the base at (bx, by) and driving along phi in the object's frame, and g = 1 when the wheels are as
// large as believed. That is linear in (C, by) and (S, bx), with the same two regressors: two fits that share
// one 2 x 2 matrix. Integrals over a stretch (algo/control/base_estimate.hpp) keep the noise of the poses out
// of the sums.
#pragma once

#include "algo/core/pose.hpp"

namespace st {

// The pose after the base has gone on along an arc.
Pose2 advanced(const Pose2& base, double forward_m, double turn_rad);

// An object's motion in its own axes, summed up over small steps.
struct BodyMotion {
  double x_m = 0, y_m = 0, turn_rad = 0;

  // The arc from p to q: the chord, as seen in the mean heading.
  void add(const Pose2& p, const Pose2& q);
};

// The base in an object's frame, as far as it is known.
struct BaseFit {
  bool valid = false;
  double gain = 0;      // g: travel seen per travel of the wheels
  Pose2 T_object_base;  // turning centre, forward direction
};

// What the shape says of the turning centre before anything has moved: the middle of what is seen of it.
struct BaseGuess {
  double x_m = 0, y_m = 0, sigma_m = 0.05;
};

class WheelRegression {
 public:
  // A stretch: the wheels' f and s, and the object's motion, which is known to sigma_m.
  void add(double forward_m, double turn_rad, const BodyMotion& seen, double sigma_m);
  BaseFit fit(const BaseGuess& guess) const;
  // What was added until now is to count so much less, since its errors go together.
  void weaken(double share);

  // Sum of the squares that the fit leaves, and of all, in sigmas; and how many they are.
  double residual(const BaseFit& fit) const;
  double total() const { return total_; }
  int rows() const { return rows_; }

 private:
  double ff_ = 0, fs_ = 0, ss_ = 0;           // of the regressors, over sigma^2
  double xf_ = 0, xs_ = 0, yf_ = 0, ys_ = 0;  // of them with what was seen
  double total_ = 0;
  int rows_ = 0;
};

}  // namespace st
