// What commands, and the robot's own reflexes, make the simulated Create do.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "hal/create/sim/create_engine.hpp"

namespace st::sim {
namespace {

constexpr double kRobotRadius_m = 0.165;
constexpr double kPwmFull = 255;
constexpr double kDocking_mmps = 100, kDocking_s = 2;

}  // namespace

// Opcodes that do nothing but change the mode. Demos and cleaning drive the real robot about; here they only
// take control from the host, as they do there. Seeking the dock does drive.
bool CreateEngine::enter_mode(std::uint8_t opcode) {
  switch (opcode) {
    case oi::kReset:
      reset();
      return true;
    case oi::kStart:
    case oi::kPower:
    case oi::kSpot:
    case oi::kCover:
    case oi::kDemo:
    case oi::kSeekDock:
      leave_control(oi::kPassive);
      seeking_dock_ = opcode == oi::kSeekDock;
      return true;
    case oi::kStop:
      leave_control(oi::kOff);
      streaming_ = false;
      return true;
    case oi::kControl:
    case oi::kSafe:
    case oi::kFull:
      leave_control(opcode == oi::kFull ? oi::kFullMode : oi::kSafeMode);  // entering turns the motors off
      return true;
    default:
      return false;
  }
}

void CreateEngine::actuate(std::uint8_t opcode, std::span<const std::uint8_t> data) {
  switch (opcode) {
    case oi::kDrive: {
      const int v = word_of(data, 0), r = word_of(data, 2);
      const double half_mm = 500.0 * geometry_.wheel_base_m;
      const bool straight = r == oi::kStraight || r == 32767 || r == 0;
      if (straight)
        set_wheels(v, v);
      else if (std::abs(r) == 1)
        set_wheels(-r * v, r * v);
      else
        set_wheels(v * (1 - half_mm / r), v * (1 + half_mm / r));
      requested_velocity_ = v;
      requested_radius_ = r;
      return;
    }
    case oi::kDriveDirect:
      set_wheels(word_of(data, 2), word_of(data, 0));
      return;
    case oi::kDrivePwm: {
      const double per_step = oi::kMaxWheel_mmps / kPwmFull;
      set_wheels(word_of(data, 2) * per_step, word_of(data, 0) * per_step);
      return;
    }
    case oi::kPlay:
      if (time_s_ < song_ends_s_) return;  // a song that plays is not interrupted
      song_playing_ = data[0] % 16;
      song_ends_s_ = time_s_ + song_s_[song_playing_];
      return;
    case oi::kLeds:
      std::copy_n(data.begin(), 3, lights_);
      return;
    case oi::kLowSideDrivers:
      outputs_ = (outputs_ & ~0xff) | data[0];
      return;
    case oi::kDigitalOutputs:
      outputs_ = (outputs_ & 0xff) | data[0] << 8;
      return;
    default:
      return;  // duty cycles, digits, infrared: nothing that moves or answers
  }
}

void CreateEngine::set_wheels(double left_mmps, double right_mmps) {
  const double most = oi::kMaxWheel_mmps;
  const double step = options_.speed_step_mmps;
  const auto possible = [&](double mmps) {
    return std::clamp(step > 0 ? step * std::round(mmps / step) : mmps, -most, most);
  };
  wheel_mmps_[0] = possible(left_mmps);
  wheel_mmps_[1] = possible(right_mmps);
  requested_velocity_ = static_cast<int>(std::lround(0.5 * (wheel_mmps_[0] + wheel_mmps_[1])));
}

void CreateEngine::reflexes() {
  if (mode_ != oi::kSafeMode) return;
  const double v = 0.5e-3 * (wheel_mmps_[0] + wheel_mmps_[1]);
  const double w = 1e-3 * (wheel_mmps_[1] - wheel_mmps_[0]) / geometry_.wheel_base_m;
  const bool towards_edge = v > 0 || (v < 0 && std::fabs(v) < kRobotRadius_m * std::fabs(w));
  if ((world_.cliffs != 0 && towards_edge) || world_.wheel_drops != 0 || world_.on_charger)
    leave_control(oi::kPassive);
}

// Slowly straight ahead until the contacts touch: what matters to a driver is that it moves by itself, in
// Passive mode, and how it ends.
void CreateEngine::seek_dock() {
  if (!seeking_dock_) return;
  if (mode_ != oi::kPassive || !world_.dock_near || world_.on_charger) {
    seeking_dock_ = false;
    if (mode_ == oi::kPassive) set_wheels(0, 0);
    return;
  }
  if (wheel_mmps_[0] == 0) {
    set_wheels(kDocking_mmps, kDocking_mmps);
    docked_at_s_ = time_s_ + kDocking_s;
  }
  world_.on_charger = time_s_ >= docked_at_s_;
}

void CreateEngine::leave_control(oi::Mode mode) {
  mode_ = mode;
  seeking_dock_ = false;
  set_wheels(0, 0);
  requested_radius_ = 0;
}

}  // namespace st::sim
