#include "hal/create/handshake.hpp"

#include <time.h>

#include <vector>

#include "hal/create/oi.hpp"
#include "hal/create/oi_stream.hpp"
#include "hal/error.hpp"

namespace st {
namespace {

constexpr int kListen_ms = 400;
constexpr int kModeGap_ms = 20;  // a mode command sooner after another may be ignored

std::int64_t now_ms() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1000 + t.tv_nsec / 1000000;
}

class Conversation {
 public:
  Conversation(SerialPort& port, RobotLogWriter& log) : port_(port), log_(log) {}

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
  SerialPort& port_;
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

}  // namespace

RobotIdentity meet_robot(SerialPort& port, std::optional<RobotModel> told, RobotLogWriter& log) {
  Conversation robot(port, log);
  const bool slow_first = told == RobotModel::kCreate1;
  const int bauds[] = {slow_first ? 57600 : 115200, slow_first ? 115200 : 57600};
  // A program that died in the middle of a command left the robot waiting for its data: Start, as often as
  // any command has data bytes. First what covers all but scripts and songs, since each may be heard as a
  // beep.
  for (const int starts : {16, 120})
    for (const int baud : bauds) {
      port.set_baud(baud);
      robot.say(oi::start_run(starts));
      SensorState state;
      robot.hear(oi::kOiMode, kModeGap_ms, state);
      const std::uint8_t mode_only[] = {oi::kOiMode};
      robot.say(oi::stream(mode_only));
      if (!robot.hear(oi::kOiMode, kListen_ms, state)) continue;
      const RobotIdentity identity = identify(robot, baud, state);
      if (told && *told != identity.model)
        throw Failure(ExitCode::kDeviceFault, "robot port " + port.path() +
                                                  ": this robot answers like a Create " +
                                                  (identity.model == RobotModel::kCreate1 ? "1" : "2") +
                                                  ", not like the model told; leave --model out");
      return identity;
    }
  const std::string where = "robot port " + port.path() + ": ";
  if (robot.bytes_heard() > 0)
    throw Failure(ExitCode::kDeviceFault,
                  where +
                      "what answers is not understood at 115200 or 57600 baud; is it a Create, "
                      "at its own baud rate? Take its battery out for a moment");
  throw Failure(ExitCode::kDeviceFault,
                where +
                    "no answer; switch the robot on, press its power or Clean button in case it "
                    "sleeps, and check the cable");
}

}  // namespace st
