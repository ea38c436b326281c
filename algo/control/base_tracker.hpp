// Where the robot's base is, frame by frame: an extended Kalman filter over the pose of the base and how much
// its wheels turn it per metre beyond what they report (they are never equally large). The wheels predict;
// the tracked object's place and heading correct, each if it can be true. A heading that slides, as that of a
// round thing may, is held against the wheels and the places, and left out.
#pragma once

#include "algo/control/start_motion.hpp"

namespace st {

class BaseTracker {
 public:
  // Begins with what the start motion told.
  void start(const Obedience& picked, const Pose2& object);

  // A frame. `told_v_mps`, `told_w_rps`: what the robot was told to do since the one before, for when its
  // wheels say nothing. `object`: null or not good while it is not seen.
  void update(const WheelOdometry& wheels, double told_v_mps, double told_w_rps, const SeenObject* object);

  const Pose2& base() const { return base_; }  // floor frame, when the newest frame was taken
  // How far the base turns per metre beyond what its wheels tell.
  double extra_turn_rpm() const { return extra_turn_rpm_; }
  // The base after its wheels have told of so much more.
  Pose2 after(const WheelOdometry& wheels) const {
    return advanced(base_, wheels.forward_m, wheels.turn_rad + extra_turn_rpm_ * wheels.forward_m);
  }
  bool seen() const { return seen_; }  // in the newest frame, where the wheels let it be

 private:
  static constexpr int kStates = 4;  // x, y, yaw; extra turn per metre

  void begin_at(const Pose2& base);
  void predict(double forward_m, double turn_rad);
  struct Innovation {  // of one measured number
    double error = 0, S = 0;
    double H[kStates]{}, PH[kStates]{};
  };
  Innovation innovation(double error, const double (&H)[kStates], double sigma) const;
  Innovation place_innovation(const Pose2& object, int axis) const;
  void correct(const Innovation& e);
  void correct_place(const Pose2& object);
  void refuse(const Pose2& base);
  void learn(const WheelOdometry& wheels, const Pose2& object, bool true_heading);

  BaseGuess guess_;
  WheelRegression regression_;
  BaseFit fit_;
  Pose2 base_, object_;
  double extra_turn_rpm_ = 0;
  double P_[kStates][kStates]{};
  bool seen_ = false;
  bool had_heading_ = false;  // a true one, in the frame before
  int refused_ = 0;           // places, one after the other, that agree
  Pose2 refused_base_;        // by the first of them, carried on by the wheels
  BodyMotion window_;
  double window_forward_m_ = 0;
};

}  // namespace st
