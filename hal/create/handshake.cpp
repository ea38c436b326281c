#include "hal/create/handshake.hpp"

#include <time.h>

#include <iterator>

#include "hal/create/oi.hpp"
#include "hal/create/oi_stream.hpp"
#include "hal/error.hpp"

namespace st {
namespace {

constexpr int kListen_ms = 400;
constexpr int kModeGap_ms = 20;  // a mode command sooner after another may be ignored
constexpr int kSpeedChange_ms = 100;
constexpr int kSlowBaud = 19200;  // what a robot that was started with its button held down listens at

std::int64_t now_ms() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1000 + t.tv_nsec / 1000000;
}

class Conversation {
 public:
  Conversation(RobotPort& port, RobotLogWriter& log) : port_(port), log_(log) {}

  void say(const oi::Command& command) {
    log_.add(host_seconds(), false, command.span());
    port_.write(command.span());
  }
  // Listens for a good frame that has `packet`.
  bool hear(int packet, int timeout_ms, SensorState& state) {
    StreamParser parser(RobotModel::kCreate2);  // knows all packets of a Create 1, at the same sizes
    for (const std::int64_t end_ms = now_ms() + timeout_ms; now_ms() < end_ms;) {
      std::uint8_t bytes[256];
      const std::size_t n = port_.read(bytes, static_cast<int>(end_ms - now_ms()));
      log_.add(host_seconds(), true, {bytes, n});
      bytes_heard_ += n;
      bool found = false;
      for (std::size_t i = 0; i < n; ++i)
        for (parser.push(bytes[i]); parser.next(state);) found = found || state.has(packet);
      if (found && state.has(packet)) return true;
    }
    return false;
  }
  std::size_t bytes_heard() const { return bytes_heard_; }

 private:
  RobotPort& port_;
  RobotLogWriter& log_;
  std::size_t bytes_heard_ = 0;
};

RobotIdentity identify(Conversation& robot, int baud, const SensorState& passive) {
  RobotIdentity identity;
  identity.baud = baud;
  identity.mode_offset = passive.value(oi::kOiMode) - oi::kPassive;
  identity.mode_trusted = identity.mode_offset == 0 || identity.mode_offset == 1;
  if (!identity.mode_trusted) identity.mode_offset = 0;
  // Only a Create 2 has encoders.
  const std::uint8_t encoders[] = {oi::kOiMode, oi::kEncoderLeft, oi::kEncoderRight};
  SensorState state;
  robot.say(oi::stream(encoders));
  identity.model =
      robot.hear(oi::kEncoderLeft, kListen_ms, state) ? RobotModel::kCreate2 : RobotModel::kCreate1;
  return identity;
}

// At 19200 baud the stream does not fit its slots.
void speed_up(Conversation& robot, RobotPort& port, RobotIdentity& identity) {
  const int baud = oi::default_baud(identity.model);
  SensorState nothing;
  robot.say(oi::baud(oi::code_of_baud(baud)));
  robot.hear(oi::kOiMode, kSpeedChange_ms, nothing);
  port.set_baud(baud);
  identity.baud = baud;
}

bool meet_at(Conversation& robot, RobotPort& port, int baud, int starts, RobotIdentity& identity) {
  port.set_baud(baud);
  robot.say(oi::start_run(starts));
  SensorState state;
  robot.hear(oi::kOiMode, kModeGap_ms, state);
  const std::uint8_t mode_only[] = {oi::kOiMode};
  robot.say(oi::stream(mode_only));
  if (!robot.hear(oi::kOiMode, kListen_ms, state)) return false;
  identity = identify(robot, baud, state);
  if (baud == kSlowBaud) speed_up(robot, port, identity);
  return true;
}

[[noreturn]] void say_why(const Conversation& robot, const RobotPort& port) {
  const std::string where = "robot port " + port.path() + ": ";
  if (robot.bytes_heard() > 0)
    throw Failure(
        ExitCode::kDeviceFault,
        where +
            "what answers is not understood at 115200, 57600 or 19200 baud; is it a Create? Take its "
            "battery out for a moment: that sets its own baud rate again");
  throw Failure(ExitCode::kDeviceFault,
                where +
                    "no answer; switch the robot on, press its power or Clean button in case it "
                    "sleeps, and check the cable");
}

}  // namespace

RobotIdentity meet_robot(RobotPort& port, std::optional<RobotModel> told, RobotLogWriter& log) {
  Conversation robot(port, log);
  const bool slow_first = told == RobotModel::kCreate1;
  // The guard at the other end of a connection has found the speed already.
  const int bauds[] = {slow_first ? 57600 : 115200, slow_first ? 115200 : 57600, kSlowBaud};
  const std::size_t speeds = port.address().tcp ? 1 : std::size(bauds);
  // A program that died in the middle of a command left the robot waiting for its data: Start, as often as
  // any command has data bytes. First what covers all but scripts and songs, since each may be heard as a
  // beep.
  for (const int starts : {16, 120}) {
    for (std::size_t i = 0; i < speeds; ++i) {
      RobotIdentity identity;
      if (!meet_at(robot, port, bauds[i], starts, identity)) continue;
      if (told && *told != identity.model)
        throw Failure(ExitCode::kDeviceFault, "robot port " + port.path() +
                                                  ": this robot answers like a Create " +
                                                  (identity.model == RobotModel::kCreate1 ? "1" : "2") +
                                                  ", not like the model told; leave --model out");
      return identity;
    }
    if (robot.bytes_heard() == 0) port.pulse_wake_line();
  }
  say_why(robot, port);
}

}  // namespace st
