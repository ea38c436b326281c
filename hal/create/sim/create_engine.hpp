// A simulated iRobot Create 1 or 2 that speaks the real Open Interface: bytes in, time, bytes out. It knows
// no real clock and no device; the pseudo-terminal and the offline simulator put it into theirs.
//
// It behaves as the specifications say, and as robots do: a command that lacks data bytes waits for them for
// ever, silence goes on driving, Safe mode falls to Passive on its reflexes, bytes take their time on the
// wire.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <string_view>
#include <vector>

#include "hal/create/oi.hpp"
#include "hal/create/sim/odometer.hpp"
#include "hal/create/sim/uart_line.hpp"
#include "hal/sim/diff_drive_body.hpp"

namespace st::sim {

struct CreateOptions {
  RobotModel model = RobotModel::kCreate2;
  std::uint64_t seed = 1;
  DiffDriveErrors errors;
  LineNoise noise;                   // robot to host
  double accel_mps2 = 1.8;           // of a wheel, from the robot description of its ROS driver
  bool angle_keeps_fraction = true;  // see Odometer
  int mode_report_offset = 0;        // some firmwares report the mode one too high
};

// What the surroundings do to the robot.
struct CreateWorld {
  bool bump_left = false, bump_right = false;
  int wheel_drops = 0;  // bits 2-4 of packet 7
  int cliffs = 0;       // bit 0 left, 1 front left, 2 front right, 3 right
  bool on_charger = false;
  bool unplugged = false;  // no byte passes, either way
  int battery_mv = 15800, charge_mah = 2200;
};

class CreateEngine {
 public:
  static constexpr double kSlice_s = 0.001;

  explicit CreateEngine(const CreateOptions& options);

  void set_host_baud(int baud) { host_baud_ = baud; }
  void receive(std::span<const std::uint8_t> bytes) { to_robot_.send(bytes); }
  // Advances by whole slices of 1 ms; the rest of dt_s waits for the next call.
  void step(double dt_s);
  // Moves what the host has received by now to `out`; returns how much.
  std::size_t transmit(std::span<std::uint8_t> out);
  // Text of the robot's own that gets into the stream, as firmwares emit now and then.
  void say(std::string_view text);

  CreateWorld& world() { return world_; }
  const DiffDriveBody& body() const { return body_; }
  oi::Mode mode() const { return mode_; }
  int baud() const { return baud_; }
  bool standing() const { return body_.left_mps() == 0 && body_.right_mps() == 0; }

 private:
  void slice();
  void hear(std::uint8_t byte);
  void execute(std::uint8_t opcode, std::span<const std::uint8_t> data);
  bool enter_mode(std::uint8_t opcode);
  void actuate(std::uint8_t opcode, std::span<const std::uint8_t> data);
  void set_wheels(double left_mmps, double right_mmps);
  void reflexes();
  void reset();
  void leave_control(oi::Mode mode);
  void send_stream_frame();
  void append_packet(int packet, std::vector<std::uint8_t>& out);
  int value_of(int packet);
  int value_of_moving_parts(int packet) const;

  CreateOptions options_;
  RobotGeometry geometry_;
  DiffDriveBody body_;
  Odometer odometer_;
  UartLine to_robot_, to_host_;
  std::deque<std::uint8_t> heard_by_robot_, heard_by_host_;
  CreateWorld world_;

  oi::Mode mode_ = oi::kOff;
  int baud_, next_baud_, host_baud_;
  double time_s_ = 0, carried_s_ = 0, slot_s_ = 0, song_ends_s_ = 0;
  std::vector<std::uint8_t> command_;  // opcode and the data bytes so far
  double wheel_mmps_[2] = {0, 0};      // left, right, as commanded
  int requested_velocity_ = 0, requested_radius_ = 0;
  std::vector<std::uint8_t> stream_;
  bool streaming_ = false;
  std::size_t last_frame_bytes_ = 0;
  double song_s_[16] = {};
  int song_playing_ = 0;
};

}  // namespace st::sim
