// What the simulated Create tells of itself and of its surroundings.
#include <cmath>

#include "hal/create/sim/create_engine.hpp"

namespace st::sim {
namespace {

constexpr int kDegC = 19;  // the number that begins every frame, so that it stands within frames as well
constexpr int kIdle_ma = 180, kWheel_ma = 90, kBlocked_ma = 1200;
constexpr int kFloorSignal = 1600, kWallSignal = 900;

}  // namespace

void CreateEngine::append_packet(int packet, std::vector<std::uint8_t>& out) {
  const oi::PacketRange range = oi::packet_range(options_.model, packet);
  for (int id = range.first; id <= range.last; ++id) {
    const int value = value_of(id);
    if (oi::packet_size(options_.model, id) == 2) out.push_back(static_cast<std::uint8_t>(value >> 8));
    out.push_back(static_cast<std::uint8_t>(value));
  }
}

int CreateEngine::value_of(int packet) {
  if (packet == oi::kDistance) return odometer_.read_distance_mm();
  if (packet == oi::kAngle) return odometer_.read_angle_deg();
  if (packet < oi::kOiMode) return value_of_surroundings(packet);
  switch (packet) {
    case oi::kOiMode:
      return mode_ + options_.mode_report_offset;
    case oi::kSongNumber:
      return song_playing_;
    case oi::kSongPlaying:
      return time_s_ < song_ends_s_ ? 1 : 0;
    case oi::kStreamCount:
      return static_cast<int>(stream_.size());
    default:
      return value_of_moving_parts(packet);
  }
}

int CreateEngine::value_of_surroundings(int packet) const {
  switch (packet) {
    case oi::kBumpsWheelDrops:
      return (world_.bump_right ? 1 : 0) | (world_.bump_left ? 2 : 0) | (world_.wheel_drops & 0x1c);
    case oi::kWall:
      return world_.wall ? 1 : 0;
    case oi::kCliffLeft:
    case oi::kCliffFrontLeft:
    case oi::kCliffFrontRight:
    case oi::kCliffRight:
      return world_.cliffs >> (packet - oi::kCliffLeft) & 1;
    case oi::kVirtualWall:
      return world_.virtual_wall ? 1 : 0;
    case oi::kOvercurrents:
      return world_.blocked ? (wheel_mmps_[1] != 0 ? 8 : 0) | (wheel_mmps_[0] != 0 ? 16 : 0) : 0;
    case oi::kInfrared:
      return infrared();
    case oi::kButtonsPressed:
      return world_.buttons;
    case oi::kChargingState:
      return world_.on_charger ? world_.charging_state : 0;
    case oi::kVoltage:
      return world_.battery_mv;
    case oi::kCurrent: {
      int ma = kIdle_ma;
      for (const double mmps : wheel_mmps_) ma += mmps == 0 ? 0 : world_.blocked ? kBlocked_ma : kWheel_ma;
      return -ma;
    }
    case oi::kTemperature:
      return kDegC;
    case oi::kCharge:
      return world_.charge_mah;
    case oi::kCapacity:
      return 2696;
    case oi::kWallSignal:
      return world_.wall ? kWallSignal : 0;
    case oi::kCliffLeftSignal:
    case oi::kCliffFrontLeftSignal:
    case oi::kCliffFrontRightSignal:
    case oi::kCliffRightSignal:
      return (world_.cliffs >> (packet - oi::kCliffLeftSignal) & 1) != 0 ? 0 : kFloorSignal;
    case oi::kDigitalInputs:
      return world_.digital_inputs;
    case oi::kAnalogInput:
      return world_.analog_input;
    case oi::kChargers:
      return world_.on_charger ? 2 : 0;
    default:
      return 0;
  }
}

// The bytes of the docks that were sold with each: both beams and the force field.
int CreateEngine::infrared() const {
  const bool one = options_.model == RobotModel::kCreate1;
  if (!world_.dock_near) return one ? 255 : 0;
  return one ? 254 : 173;
}

int CreateEngine::value_of_moving_parts(int packet) const {
  const auto motor_ma = [&](int wheel) {
    return wheel_mmps_[wheel] == 0 ? 0 : world_.blocked ? kBlocked_ma : kWheel_ma;
  };
  switch (packet) {
    case oi::kRequestedVelocity:
      return requested_velocity_;
    case oi::kRequestedRadius:
      return requested_radius_;
    case oi::kRequestedRight:
      return static_cast<int>(std::lround(wheel_mmps_[1]));
    case oi::kRequestedLeft:
      return static_cast<int>(std::lround(wheel_mmps_[0]));
    case oi::kEncoderLeft:
      return odometer_.count(0);
    case oi::kEncoderRight:
      return odometer_.count(1);
    case oi::kLightBumper:
      return world_.wall ? 0x20 : 0;
    case oi::kLightRightSignal:
      return world_.wall ? kWallSignal : 0;
    case oi::kInfraredLeft:
    case oi::kInfraredRight:
      return infrared();
    case oi::kCurrentLeft:
      return motor_ma(0);
    case oi::kCurrentRight:
      return motor_ma(1);
    case oi::kStasis:
      return body_.v() > 0 ? 1 : 0;
    default:
      return 0;
  }
}

// The events that a script can wait for; a negative one waits for the opposite.
bool CreateEngine::event_holds(int event) {
  const auto holds = [&](int number) {
    switch (number) {
      case 1:
        return world_.wheel_drops != 0;
      case 2:
        return (world_.wheel_drops & 0x10) != 0;
      case 3:
        return (world_.wheel_drops & 0x08) != 0;
      case 4:
        return (world_.wheel_drops & 0x04) != 0;
      case 5:
        return world_.bump_left || world_.bump_right;
      case 6:
        return world_.bump_left;
      case 7:
        return world_.bump_right;
      case 8:
        return world_.virtual_wall;
      case 9:
        return world_.wall;
      case 10:
        return world_.cliffs != 0;
      case 11:
      case 12:
      case 13:
      case 14:
        return (world_.cliffs >> (number - 11) & 1) != 0;
      case 15:
        return world_.on_charger;
      case 16:
        return (world_.buttons & 4) != 0;
      case 17:
        return (world_.buttons & 1) != 0;
      case 22:
        return mode_ == oi::kPassive;
      default:
        return number >= 18 && number <= 21 && (world_.digital_inputs >> (number - 18) & 1) != 0;
    }
  };
  return event > 0 ? holds(event) : event < 0 && !holds(-event);
}

}  // namespace st::sim
