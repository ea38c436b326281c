#include "hal/create/oi_packets.hpp"

#include <cstdlib>
#include <iterator>

namespace st::oi {
namespace {

constexpr Sends kNever = Sends::kNever, kIdle = Sends::kIdle, kYes = Sends::kYes;

// Section 4 of both specifications.
constexpr PacketInfo kPackets[] = {
    {kBumpsWheelDrops, 1, kYes, kYes, "bumps_wheel_drops", "bits", 0, 31, 0},
    {kWall, 1, kYes, kYes, "wall", "0/1", 0, 1, 0},
    {kCliffLeft, 1, kYes, kYes, "cliff_left", "0/1", 0, 1, 0},
    {kCliffFrontLeft, 1, kYes, kYes, "cliff_front_left", "0/1", 0, 1, 0},
    {kCliffFrontRight, 1, kYes, kYes, "cliff_front_right", "0/1", 0, 1, 0},
    {kCliffRight, 1, kYes, kYes, "cliff_right", "0/1", 0, 1, 0},
    {kVirtualWall, 1, kYes, kYes, "virtual_wall", "0/1", 0, 1, 0},
    {kOvercurrents, 1, kYes, kYes, "overcurrents", "bits", 0, 31, 0},
    {kDirt, 1, kIdle, kYes, "dirt", "0-255", 0, 0, 0},
    {16, 1, kIdle, kIdle, "unused_16", "", 0, 0, 0},
    {kInfrared, 1, kYes, kYes, "infrared", "code", 0, 0, 0},
    {kButtonsPressed, 1, kYes, kYes, "buttons", "bits", 0, 0, 0},
    {kDistance, -2, kYes, kYes, "distance_since_read", "mm", 0, 0, 0},
    {kAngle, -2, kYes, kYes, "angle_since_read", "deg", 0, 0, 0},
    {kChargingState, 1, kYes, kYes, "charging_state", "code", 0, 6, 0},
    {kVoltage, 2, kYes, kYes, "battery_voltage", "mV", 5000, 22000, 4000},
    {kCurrent, -2, kYes, kYes, "battery_current", "mA", -8000, 8000, 0},
    {kTemperature, -1, kYes, kYes, "battery_temperature", "degC", -20, 90, 5},
    {kCharge, 2, kYes, kYes, "battery_charge", "mAh", 0, 8000, 300},
    {kCapacity, 2, kYes, kYes, "battery_capacity", "mAh", 0, 8000, 300},
    {kWallSignal, 2, kYes, kYes, "wall_signal", "0-4095", 0, 4095, 0},
    {kCliffLeftSignal, 2, kYes, kYes, "cliff_left_signal", "0-4095", 0, 4095, 0},
    {kCliffFrontLeftSignal, 2, kYes, kYes, "cliff_front_left_signal", "0-4095", 0, 4095, 0},
    {kCliffFrontRightSignal, 2, kYes, kYes, "cliff_front_right_signal", "0-4095", 0, 4095, 0},
    {kCliffRightSignal, 2, kYes, kYes, "cliff_right_signal", "0-4095", 0, 4095, 0},
    {kDigitalInputs, 1, kYes, kIdle, "digital_inputs", "bits", 0, 0, 0},
    {kAnalogInput, 2, kYes, kIdle, "analog_input", "5V/1023", 0, 1023, 0},
    {kChargers, 1, kYes, kYes, "charging_sources", "bits", 0, 3, 0},
    {kOiMode, 1, kYes, kYes, "oi_mode", "code", 0, 0, 0},
    {kSongNumber, 1, kYes, kYes, "song_number", "", 0, 0, 0},
    {kSongPlaying, 1, kYes, kYes, "song_playing", "0/1", 0, 1, 0},
    {kStreamCount, 1, kYes, kYes, "stream_packets", "", 0, 108, 0},
    {kRequestedVelocity, -2, kYes, kYes, "requested_velocity", "mm/s", -500, 500, 0},
    {kRequestedRadius, -2, kYes, kYes, "requested_radius", "mm", 0, 0, 0},
    {kRequestedRight, -2, kYes, kYes, "requested_right", "mm/s", -500, 500, 0},
    {kRequestedLeft, -2, kYes, kYes, "requested_left", "mm/s", -500, 500, 0},
    {kEncoderLeft, -2, kNever, kYes, "encoder_left", "counts", 0, 0, 0},
    {kEncoderRight, -2, kNever, kYes, "encoder_right", "counts", 0, 0, 0},
    {kLightBumper, 1, kNever, kYes, "light_bumper", "bits", 0, 127, 0},
    {kLightLeftSignal, 2, kNever, kYes, "light_left", "0-4095", 0, 4095, 0},
    {47, 2, kNever, kYes, "light_front_left", "0-4095", 0, 4095, 0},
    {48, 2, kNever, kYes, "light_center_left", "0-4095", 0, 4095, 0},
    {49, 2, kNever, kYes, "light_center_right", "0-4095", 0, 4095, 0},
    {50, 2, kNever, kYes, "light_front_right", "0-4095", 0, 4095, 0},
    {kLightRightSignal, 2, kNever, kYes, "light_right", "0-4095", 0, 4095, 0},
    {kInfraredLeft, 1, kNever, kYes, "infrared_left", "code", 0, 0, 0},
    {kInfraredRight, 1, kNever, kYes, "infrared_right", "code", 0, 0, 0},
    {kCurrentLeft, -2, kNever, kYes, "motor_current_left", "mA", -4000, 4000, 0},
    {kCurrentRight, -2, kNever, kYes, "motor_current_right", "mA", -4000, 4000, 0},
    {kCurrentMainBrush, -2, kNever, kYes, "motor_current_main_brush", "mA", -4000, 4000, 0},
    {kCurrentSideBrush, -2, kNever, kYes, "motor_current_side_brush", "mA", -4000, 4000, 0},
    {kStasis, 1, kNever, kYes, "stasis", "bits", 0, 3, 0},
};
static_assert(std::size(kPackets) == kLastPacket - kFirstPacket + 1);
constexpr bool in_order() {
  for (std::size_t i = 0; i < std::size(kPackets); ++i)
    if (kPackets[i].id != kFirstPacket + static_cast<int>(i)) return false;
  return true;
}
static_assert(in_order(), "rows are found by their place");

struct GroupRow {
  std::uint8_t group, first, last;
};
constexpr GroupRow kGroups[] = {{0, 7, 26},    {1, 7, 16},    {2, 17, 20},  {3, 21, 26},
                                {4, 27, 34},   {5, 35, 42},   {6, 7, 42},   {100, 7, 58},
                                {101, 43, 58}, {106, 46, 51}, {107, 54, 58}};

}  // namespace

const PacketInfo* packet_info(RobotModel model, int packet) {
  if (packet < kFirstPacket || packet > kLastPacket) return nullptr;
  const PacketInfo& row = kPackets[packet - kFirstPacket];
  return model == RobotModel::kCreate2 || row.create1 != kNever ? &row : nullptr;
}

int all_sensors(RobotModel model) { return model == RobotModel::kCreate1 ? 6 : 100; }

PacketRange packet_range(RobotModel model, int packet) {
  for (const GroupRow& row : kGroups)
    if (row.group == packet)
      return packet_info(model, row.last) != nullptr ? PacketRange{row.first, row.last} : PacketRange{};
  if (packet_info(model, packet) != nullptr) return {packet, packet};
  return {};
}

int packet_size(RobotModel model, int packet) {
  const PacketRange range = packet_range(model, packet);
  int bytes = 0;
  for (int id = range.first; id <= range.last; ++id) bytes += std::abs(kPackets[id - kFirstPacket].bytes);
  return bytes;
}

bool plausible(int packet, int value, const int* before) {
  const PacketInfo& row = kPackets[packet - kFirstPacket];
  const bool within = row.low == row.high || (value >= row.low && value <= row.high);
  return within && (row.step == 0 || before == nullptr || std::abs(value - *before) <= row.step);
}

bool packet_is_signed(int packet) {
  return packet >= kFirstPacket && packet <= kLastPacket && kPackets[packet - kFirstPacket].bytes < 0;
}

}  // namespace st::oi
