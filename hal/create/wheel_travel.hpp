// How far each wheel has turned, from what the robot tells in frame after frame.
//
// Create 2: encoder counts (packets 43, 44), which wrap at 2^16 both ways. Create 1 has no encoders: the
// velocities that it was last asked for (41, 42) are integrated from frame to frame, and distance and angle
// (19, 20), whenever a frame holds them, correct the sum by what their rounding to 1 mm and 1 degree cannot
// explain. They clear on reading, and firmwares differ on whether the fraction is kept: so they are asked for
// rarely, and never integrated by themselves.
#pragma once

#include <cstdint>

#include "algo/core/records.hpp"
#include "hal/create/oi_stream.hpp"

namespace st {

// How far a wheel truly rolls when the robot believes that it rolled a metre.
double wheel_scale(const RobotGeometry& believed, const RobotGeometry& actual);

// Of the mean wheel, how large each is.
struct WheelShares {
  double left = 1, right = 1;
};
WheelShares wheel_shares(const RobotGeometry& geometry);

class WheelTravel {
 public:
  // `geometry`: as the wheels truly are. What the robot itself computes from its counts (requested speeds,
  // distance, angle) it computes with the sizes that its model has by default.
  WheelTravel(RobotModel model, const RobotGeometry& geometry)
      : geometry_(geometry), believed_(oi::default_geometry(model)) {}

  // Travel since the sample before, from one good frame that was complete at t_s. `after_loss`: bytes were
  // lost or damaged since the frame before, so that a distance and angle may have been read and never
  // arrived. False: nothing to report (the first frame, a frame without the packets, or a jump that no wheel
  // can make).
  bool update(double t_s, const SensorState& state, bool after_loss, OdometrySample& sample);

  std::uint64_t refused() const { return refused_; }

 private:
  bool from_encoders(double t_s, const SensorState& state, OdometrySample& sample);
  bool from_requests(double t_s, const SensorState& state, bool after_loss, OdometrySample& sample);

  RobotGeometry geometry_, believed_;
  bool started_ = false, suspect_ = false;
  double last_t_s_ = 0;
  std::uint16_t left_ = 0, right_ = 0;  // encoder counts of the newest accepted frame
  std::uint16_t suspect_left_ = 0,
                suspect_right_ = 0;             // of a refused one: two that agree are a restarted robot
  double predicted_m_ = 0, predicted_rad_ = 0;  // Create 1: since distance and angle were read
  bool comparable_ = false;  // both count from the same instant: not for the first reading, nor after a loss
  std::uint64_t refused_ = 0;
};

}  // namespace st
