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

#include "hal/create/command_reader.hpp"
#include "hal/create/sim/odometer.hpp"
#include "hal/create/sim/script_engine.hpp"
#include "hal/create/sim/uart_line.hpp"
#include "hal/sim/diff_drive_body.hpp"

namespace st::sim {

struct CreateOptions {
  RobotModel model = RobotModel::kCreate2;
  std::uint64_t seed = 1;
  DiffDriveErrors errors;
  LineNoise noise;                      // robot to host
  LineNoise noise_to_robot;             // host to robot
  int start_baud = 0;                   // 0: the model's own; 19200 as after a start with the button held
  double accel_mps2 = 1.8;              // of a wheel, from the robot description of its ROS driver
  double base_scale = 1;                // true wheel base beside the one that the robot believes in
  double half_frames = 0;               // share of the stream's frames that are cut short
  double speed_step_mmps = 0;           // the Create 2's speed control works in steps of 28.5; 0: none
  bool angle_keeps_fraction = true;     // see Odometer
  int mode_report_offset = 0;           // some firmwares report the mode one too high
  bool checksum_leaves_header = false;  // the rule of the Create 1 specification, which no real one follows
  double sleep_after_s = 300;           // Create 2, Passive, no command; 0: never
  double text_every_s = 0;              // unasked-for text in the stream, as from a charging Create 2
};

// What the surroundings do to the robot.
struct CreateWorld {
  bool bump_left = false, bump_right = false;
  int wheel_drops = 0;  // bits 2-4 of packet 7
  int cliffs = 0;       // bit 0 left, 1 front left, 2 front right, 3 right
  bool on_charger = false;
  int charging_state = 2;  // that it reports there; the Create 2's own table allows 6
  bool wall = false, virtual_wall = false;
  bool blocked = false;                      // wheels cannot turn
  bool dock_near = false;                    // its infrared is seen, and seeking it ends on the charger
  int buttons = 0;                           // packet 18
  int digital_inputs = 0, analog_input = 0;  // cargo bay of a Create 1
  bool unplugged = false;                    // no byte passes, either way
  bool mute = false;                         // the robot hears, and its own bytes get lost
  int battery_mv = 15800, charge_mah = 2200;
};

inline constexpr std::string_view kBatteryText = "\r\nbat:   min 3  sec 10  mV 15613  mA -212  deg-C 24\r\n";

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

  // Sleeping, it hears nothing until somebody presses its button: a pseudo-terminal has no wake line.
  void fall_asleep();
  void press_power() { asleep_ = false; }

  CreateWorld& world() { return world_; }
  const CreateWorld& world() const { return world_; }
  const DiffDriveBody& body() const { return body_; }
  oi::Mode mode() const { return mode_; }
  int baud() const { return baud_; }
  bool asleep() const { return asleep_; }
  bool in_script_wait() const { return script_.waiting(); }
  int wanted_mmps(int wheel) const { return static_cast<int>(wheel_mmps_[wheel]); }  // 0 left, 1 right
  std::span<const std::uint8_t, 3> lights() const { return lights_; }                // as Leds (139) set them
  int outputs() const { return outputs_; }  // bits of 138 (low byte) and 147
  bool standing() const { return body_.left_mps() == 0 && body_.right_mps() == 0; }

 private:
  void slice();
  void listen();
  void execute(std::span<const std::uint8_t> command);
  bool execute_script(std::uint8_t opcode, std::span<const std::uint8_t> data);
  bool enter_mode(std::uint8_t opcode);
  void actuate(std::uint8_t opcode, std::span<const std::uint8_t> data);
  void set_wheels(double left_mmps, double right_mmps);
  void reflexes();
  void seek_dock();
  void move();
  void mind_time();
  void reset();
  void leave_control(oi::Mode mode);
  void send_stream_frame();
  void append_packet(int packet, std::vector<std::uint8_t>& out);
  int value_of(int packet);
  int value_of_surroundings(int packet) const;
  int value_of_moving_parts(int packet) const;
  int infrared() const;
  bool event_holds(int event);

  CreateOptions options_;
  RobotGeometry geometry_;  // as the robot believes it to be
  DiffDriveBody body_;
  Odometer odometer_;
  UartLine to_robot_, to_host_;
  std::deque<std::uint8_t> heard_by_robot_, heard_by_host_;
  CreateWorld world_;

  oi::Mode mode_ = oi::kOff;
  bool asleep_ = false, seeking_dock_ = false;
  int baud_, next_baud_, host_baud_;
  double time_s_ = 0, carried_s_ = 0, slot_s_ = 0, song_ends_s_ = 0, spoken_to_s_ = 0, text_s_ = 0;
  double docked_at_s_ = 0;
  oi::CommandReader commands_;
  ScriptEngine script_;
  double wheel_mmps_[2] = {0, 0};  // left, right, as commanded
  int requested_velocity_ = 0, requested_radius_ = 0;
  std::vector<std::uint8_t> stream_;
  bool streaming_ = false;
  std::size_t last_frame_bytes_ = 0;
  double song_s_[16] = {};
  int song_playing_ = 0;
  std::uint8_t lights_[3]{};
  int outputs_ = 0;
  Random random_;
};

inline int word_of(std::span<const std::uint8_t> data, std::size_t at) {
  return static_cast<std::int16_t>(data[at] << 8 | data[at + 1]);
}

}  // namespace st::sim
