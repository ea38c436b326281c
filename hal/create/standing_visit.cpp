#include "hal/create/standing_visit.hpp"

#include <time.h>

#include <vector>

#include "hal/error.hpp"

namespace st {
namespace {

constexpr int kTries = 5;
constexpr int kQuiet_ms = 40;  // more than two slots without a byte: the stream has ended
constexpr int kAnswer_ms = 300;
constexpr timespec kModeGap{0, 50'000'000};

}  // namespace

StandingVisit::StandingVisit(const RobotOptions& options)
    : no_log_(std::string()), port_(options.port), identity_(meet_robot(port_, options.model, no_log_)) {}

StandingVisit::~StandingVisit() {
  try {
    port_.write(oi::simple(oi::kStart).span());
  } catch (const Failure&) {
    // The port is gone: nothing is left to be said.
  }
}

SensorState StandingVisit::all_sensors() {
  const int group = oi::all_sensors(identity_.model);
  const auto size = static_cast<std::size_t>(oi::packet_size(identity_.model, group));
  std::uint8_t bytes[256];
  port_.write(oi::pause_stream(false).span());
  for (int attempt = 0; attempt < kTries; ++attempt) {
    while (port_.read(bytes, kQuiet_ms) > 0) {
    }
    port_.write(oi::sensors(group).span());
    std::size_t got = 0;
    while (got < size) {
      const std::size_t n = port_.read({bytes + got, sizeof bytes - got}, kAnswer_ms);
      if (n == 0) break;
      got += n;
    }
    if (got != size) continue;
    SensorState state;
    decode_packet(identity_.model, group, {bytes, size}, state);
    return state;
  }
  throw Failure(ExitCode::kDeviceFault,
                "robot port " + port_.path() + ": its sensors do not answer; start again");
}

void StandingVisit::send(const oi::Command& command) {
  if (!safe_) {
    port_.write(oi::simple(oi::kSafe).span());
    nanosleep(&kModeGap, nullptr);
  }
  safe_ = true;
  port_.write(command.span());
}

}  // namespace st
