// Where the robot's base is, frame by frame: the tracked object's pose, the base in it as far as its motion
// has told by now, and between good poses the wheels.
#pragma once

#include "algo/control/start_motion.hpp"

namespace st {

// The pose after the base has gone on along an arc.
Pose2 advanced(const Pose2& base, double forward_m, double turn_rad);

class BaseTracker {
 public:
  // Begins with what the start motion told.
  void start(const Obedience& picked, const Pose2& object);

  // A frame. `told_v_mps`, `told_w_rps`: what the robot was told to do since the one before, for when its
  // wheels say nothing. `object`: null or not good while it is not seen.
  void update(const WheelOdometry& wheels, double told_v_mps, double told_w_rps, const SeenObject* object);

  const Pose2& base() const { return base_; }  // floor frame, when the newest frame was taken
  bool seen() const { return seen_; }          // in the newest frame, where the wheels let it be
  const BaseFit& fit() const { return fit_; }

 private:
  void learn(const WheelOdometry& wheels, const Pose2& object);

  BaseGuess guess_;
  WheelRegression regression_;
  BaseFit fit_;
  Pose2 base_, object_;
  bool has_object_ = false, seen_ = false;
  int refused_ = 0;
  BodyMotion window_;
  double window_forward_m_ = 0;
};

}  // namespace st
