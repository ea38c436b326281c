// From the robot's bytes to wheel travel: the one place where a live run and a replayed robot.log do the
// same.
#pragma once

#include "hal/create/command_reader.hpp"
#include "hal/create/oi_stream.hpp"
#include "hal/create/wheel_travel.hpp"
#include "hal/recording/robot_log.hpp"

namespace st {

class OdometryStream {
 public:
  OdometryStream(RobotModel model, const RobotGeometry& geometry)
      : commands_(model), parser_(model), travel_(model, geometry) {}

  // Bytes to the robot: a new list of packets to stream changes what a good frame is.
  void sent(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes)
      if (commands_.push(byte) && commands_.command()[0] == oi::kStream)
        parser_.expect(commands_.command().subspan(2));
  }

  // Bytes from the robot, received at t_s. `on_frame(state)` for every good frame, then `on_travel(sample)`
  // when it tells of travel.
  template <typename OnFrame, typename OnTravel>
  void receive(double t_s, std::span<const std::uint8_t> bytes, OnFrame&& on_frame, OnTravel&& on_travel) {
    for (const std::uint8_t byte : bytes) {
      parser_.push(byte);
      while (parser_.next(state_)) {
        OdometrySample sample;
        on_frame(state_);
        const bool after_loss = parser_.bad_bytes() != bad_bytes_;
        bad_bytes_ = parser_.bad_bytes();
        if (travel_.update(t_s, state_, after_loss, sample)) on_travel(sample);
      }
    }
  }
  const StreamParser& parser() const { return parser_; }

 private:
  oi::CommandReader commands_;
  StreamParser parser_;
  WheelTravel travel_;
  SensorState state_;
  std::uint64_t bad_bytes_ = 0;
};

// The decoder that the reader of recordings asks for (hal/recording/robot_log.hpp).
RobotBytes decode_odometry(RobotModel model, const std::optional<RobotGeometry>& geometry, OdometrySink sink);

}  // namespace st
