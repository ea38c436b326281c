// The robot behind DriveBase: the guard's other end of the socket, and a thread that reads what the robot
// tells.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "hal/create/guard.hpp"
#include "hal/create/handshake.hpp"
#include "hal/create/odometry_decoder.hpp"
#include "hal/create/sim_child.hpp"
#include "hal/create/spsc_ring.hpp"

namespace st {

class CreateRobot final : public DriveBase {
 public:
  // Takes the port over from the handshake: starts the guard, which alone holds it from then on, and the
  // reader.
  CreateRobot(std::unique_ptr<RobotPort> port, const RobotIdentity& identity, const RobotGeometry& wheels,
              std::unique_ptr<RobotLogWriter> log, std::unique_ptr<SimChild> sim);
  ~CreateRobot() override { close(); }

  // Safe mode and the sensor stream. Throws Failure (kDeviceFault) when the robot does not enter it.
  void take_control();

  bool drive(double left_mps, double right_mps) override;
  bool stop() override;
  void poll(FixedVector<OdometrySample, 64>& odometry, RobotStatus& status) override;
  RobotGeometry geometry() const override { return geometry_; }
  RobotModel model() const override { return identity_.model; }
  std::string sim_state_path() const override { return sim_ ? sim_->state_path() : std::string(); }
  void close() override;

 private:
  bool send(const oi::Command& command);
  void read_robot();
  void on_message(std::span<const std::uint8_t> message);
  void on_frame(const SensorState& state);
  void ask_for_distance(std::int64_t now_ns);
  void begin_regaining(std::int64_t now_ns);
  void regain_control(std::int64_t now_ns);
  void stop_without_guard();
  void stop_for_good();
  bool lost_contact() const;
  void note(RobotFault fault) { noted_.fetch_or(1u << static_cast<unsigned>(fault)); }
  RobotFault worst_fault();

  RobotIdentity identity_;
  RobotGeometry geometry_;
  double left_scale_, right_scale_;  // how far a wheel rolls when it is asked to roll a metre
  PortAddress port_;
  std::unique_ptr<RobotLogWriter> log_;
  std::unique_ptr<SimChild> sim_;
  Guard guard_;
  std::thread reader_;

  // Written by the reader, read by the loop.
  struct Travel {
    OdometrySample sample;
    std::uint64_t log_bytes = 0;  // of robot.log, with the line that told of it
  };
  SpscRing<Travel, 256> travel_;
  std::atomic<std::uint64_t> log_bytes_{0};  // all of their travel is in the ring
  std::atomic<std::uint32_t> noted_{0};      // bit per RobotFault, since the last poll()
  std::atomic<bool> disconnected_{false};
  std::atomic<std::int64_t> heard_ns_{0};  // newest good frame
  std::atomic<std::int64_t> listened_in_vain_ns_{0};
  std::atomic<std::uint64_t> good_frames_{0}, bad_bytes_{0};
  std::atomic<int> mode_{oi::kPassive}, battery_mv_{0};
  std::atomic<bool> in_control_{false}, closing_{false};
  std::atomic<bool> standstill_{true};  // contact was lost: nothing moves before stop() was called
  std::atomic<int> reconnects_{0};

  // The loop's own: taken from the ring too early for what the log is known to hold.
  Travel early_;
  bool has_early_ = false;

  // The reader's own.
  OdometryStream stream_;
  std::int64_t weak_since_ns_ = 0;  // the battery was last seen not to be empty
  std::int64_t regain_ns_ = 0;      // when the next command on the way back to Safe mode is due; 0: none
  bool regain_safe_ = false;
  std::int64_t distance_asked_ns_ = 0;
  bool distance_in_list_ = false, distance_came_ = false;
};

}  // namespace st
