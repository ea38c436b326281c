// The sensor packets of the Open Interface: one table for both models, with sizes, names and units.
#pragma once

#include <cstdint>
#include <span>

#include "hal/create/drive_base.hpp"

namespace st::oi {

inline constexpr int kFirstPacket = 7;
inline constexpr int kLastPacket = 58;

enum Packet : std::uint8_t {
  kBumpsWheelDrops = 7,
  kWall = 8,
  kCliffLeft = 9,
  kCliffFrontLeft = 10,
  kCliffFrontRight = 11,
  kCliffRight = 12,
  kVirtualWall = 13,
  kOvercurrents = 14,
  kDirt = 15,
  kInfrared = 17,
  kButtonsPressed = 18,
  kDistance = 19,
  kAngle = 20,
  kChargingState = 21,
  kVoltage = 22,
  kCurrent = 23,
  kTemperature = 24,
  kCharge = 25,
  kCapacity = 26,
  kWallSignal = 27,
  kCliffLeftSignal = 28,
  kCliffFrontLeftSignal = 29,
  kCliffFrontRightSignal = 30,
  kCliffRightSignal = 31,
  kDigitalInputs = 32,
  kAnalogInput = 33,
  kChargers = 34,
  kOiMode = 35,
  kSongNumber = 36,
  kSongPlaying = 37,
  kStreamCount = 38,
  kRequestedVelocity = 39,
  kRequestedRadius = 40,
  kRequestedRight = 41,
  kRequestedLeft = 42,
  kEncoderLeft = 43,
  kEncoderRight = 44,
  kLightBumper = 45,
  kLightLeftSignal = 46,
  kLightRightSignal = 51,
  kInfraredLeft = 52,
  kInfraredRight = 53,
  kCurrentLeft = 54,
  kCurrentRight = 55,
  kCurrentMainBrush = 56,
  kCurrentSideBrush = 57,
  kStasis = 58,
};

// Whether a model sends a packet: kIdle ones stand in its frames and are always 0.
enum class Sends : std::uint8_t { kNever, kIdle, kYes };

struct PacketInfo {
  std::uint8_t id;
  std::int8_t bytes;  // negative: signed, two's complement
  Sends create1, create2;
  const char* name;
  const char* unit;  // of measure; "bits" and "code" as the specification lists them; "counts" wrap at 2^16
  std::int16_t low, high;  // what it is known to lie within; equal: anything goes.
  std::int16_t step;       // how far it may lie from the frame before; 0: as far as it likes
};

// Null outside of 7-58, and for what this model does not have.
const PacketInfo* packet_info(RobotModel model, int packet);

// Everything a robot tells in one answer: group 6 of a Create 1, group 100 of a Create 2.
int all_sensors(RobotModel model);

// Bytes of a single packet or of a group (0-6, and 100, 101, 106, 107 of the Create 2); 0: this model has no
// such packet.
int packet_size(RobotModel model, int packet);
bool packet_is_signed(int packet);
// Whether a robot may well have sent this; `before`: what the frame before it held, or null. Firmwares have
// surprised before: what is not plausible is to be doubted, not refused.
bool plausible(int packet, int value, const int* before);

// The single packets [first, last] that a packet or group holds, in ascending order; first > last: no such
// packet.
struct PacketRange {
  int first = 1, last = 0;
};
PacketRange packet_range(RobotModel model, int packet);

}  // namespace st::oi
