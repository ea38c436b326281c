// The robot as the loop sees it. Commands go to the guard process by a pipe and never block; wheel travel
// comes back decoded, from a reader thread.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "algo/core/records.hpp"

namespace st {

enum class RobotModel { kCreate1, kCreate2 };

// Wheels as they are, not as the robot believes them: measured ones go here.
struct RobotGeometry {
  double wheel_base_m = 0.235;
  double wheel_diameter_m = 0.072;
  double counts_per_turn = 508.8;
  double right_to_left = 1;  // the right wheel's diameter beside the left one's; the two have that mean
};

// What keeps the robot from driving on; safety_rules.hpp says what follows from each. The last two are not
// the robot's own: the camera does not see it, or sees nothing new.
enum class RobotFault : std::uint8_t {
  kNone,
  kSilent,
  kDisconnected,
  kBump,
  kCliff,
  kWheelDrop,
  kLeftSafeMode,
  kLowBattery,
  kNotSeen,
  kStale
};
const char* name_of(RobotFault fault);

struct RobotStatus {
  RobotFault fault = RobotFault::kNone;
  double last_heard_s = 0;  // age of the newest good sensor frame
  std::uint64_t good_frames = 0, bad_bytes = 0;
  int oi_mode = 0;  // 0 off, 1 passive, 2 safe, 3 full
  int battery_mv = 0;
  int reconnects = 0;           // how often the port came back
  std::uint64_t log_bytes = 0;  // of robot.log, that the odometry up to now was read from
};

class DriveBase {
 public:
  virtual ~DriveBase() = default;

  // Wheel speeds in m/s, clamped to the robot's limits. Also the heartbeat: the guard stops the robot when
  // commands cease for 250 ms. After the robot was silent or disconnected the wheels stay still, whatever is
  // asked of them, until stop() was called once: it starts in a standstill. False when the command could not
  // be handed over. No heap, no lock, no wait.
  virtual bool drive(double left_mps, double right_mps) = 0;
  virtual bool stop() = 0;

  // Takes up to the vector's free room of odometry that arrived since the last call. No heap, no lock, no
  // wait.
  virtual void poll(FixedVector<OdometrySample, 64>& odometry, RobotStatus& status) = 0;

  virtual RobotGeometry geometry() const = 0;
  virtual RobotModel model() const = 0;
  // For PORT `sim`: the state file of the simulated robot; else empty.
  virtual std::string sim_state_path() const { return {}; }

  // Stops the robot, ends the guard, closes. Safe to call twice.
  virtual void close() = 0;
};

// PORT of the command line: a serial device, or `sim` (starts `startrack create-sim` as a child and talks to
// its pseudo-terminal). Wakes the robot, enters Safe mode, starts the sensor stream. Throws Failure
// (kDeviceFault). Must be called before the arena is mapped: it forks.
struct RobotOptions {
  std::string port;
  std::optional<RobotModel> model;  // as told; else found out
  // Measured wheels; 0: as the model has them.
  RobotGeometry wheels{0, 0, 0, 0};
  std::string log_path;    // robot.log: every byte both ways; empty: none
  std::uint64_t seed = 1;  // for `sim`: wheel slip
};
std::unique_ptr<DriveBase> open_robot(const RobotOptions& options);

}  // namespace st
