#include "hal/create/oi.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace st::oi {
namespace {

enum class Known : std::uint8_t { kBoth, kCreate1, kCreate2 };

struct OpcodeRow {
  std::uint8_t opcode;
  std::int8_t data;  // bytes; kVariable: told by the data
  Known known;
};
constexpr std::int8_t kVariable = -1;

// Section 3 of both specifications. Demo (136) is the one opcode whose length depends on the model.
constexpr OpcodeRow kOpcodes[] = {
    {kReset, 0, Known::kBoth},
    {kStart, 0, Known::kBoth},
    {kBaud, 1, Known::kBoth},
    {kControl, 0, Known::kBoth},
    {kSafe, 0, Known::kBoth},
    {kFull, 0, Known::kBoth},
    {kPower, 0, Known::kCreate2},
    {kSpot, 0, Known::kBoth},
    {kCover, 0, Known::kBoth},
    {kDemo, 1, Known::kCreate1},
    {kDemo, 0, Known::kCreate2},
    {kDrive, 4, Known::kBoth},
    {kLowSideDrivers, 1, Known::kBoth},
    {kLeds, 3, Known::kBoth},
    {kSong, kVariable, Known::kBoth},
    {kPlay, 1, Known::kBoth},
    {kSensors, 1, Known::kBoth},
    {kSeekDock, 0, Known::kBoth},
    {kPwmLowSideDrivers, 3, Known::kBoth},
    {kDriveDirect, 4, Known::kBoth},
    {kDrivePwm, 4, Known::kCreate2},
    {kDigitalOutputs, 1, Known::kCreate1},
    {kStream, kVariable, Known::kBoth},
    {kQueryList, kVariable, Known::kBoth},
    {kPauseResume, 1, Known::kBoth},
    {kSendIr, 1, Known::kCreate1},
    {kScript, kVariable, Known::kCreate1},
    {kPlayScript, 0, Known::kCreate1},
    {kShowScript, 0, Known::kCreate1},
    {kWaitTime, 1, Known::kCreate1},
    {kWaitDistance, 2, Known::kCreate1},
    {kWaitAngle, 2, Known::kCreate1},
    {kWaitEvent, 1, Known::kCreate1},
    {kSchedulingLeds, 2, Known::kCreate2},
    {kDigitLedsRaw, 4, Known::kCreate2},
    {kDigitLedsAscii, 4, Known::kCreate2},
    {kButtons, 1, Known::kCreate2},
    {kSchedule, 15, Known::kCreate2},
    {kSetDayTime, 3, Known::kCreate2},
    {kStop, 0, Known::kCreate2},
};

constexpr int kBauds[] = {300, 600, 1200, 2400, 4800, 9600, 14400, 19200, 28800, 38400, 57600, 115200};

Command list_command(Opcode opcode, std::span<const std::uint8_t> packets) {
  Command c;
  c.add(opcode);
  const std::size_t count = std::min(packets.size(), Command::kCapacity - 2);
  c.add(static_cast<int>(count));
  for (const std::uint8_t packet : packets.first(count)) c.add(packet);
  return c;
}

}  // namespace

int default_baud(RobotModel model) { return model == RobotModel::kCreate1 ? 57600 : 115200; }

int baud_of_code(int code) {
  return code >= 0 && code < static_cast<int>(std::size(kBauds)) ? kBauds[code] : 0;
}

int code_of_baud(int baud) {
  for (int code = 0; code < static_cast<int>(std::size(kBauds)); ++code)
    if (kBauds[code] == baud) return code;
  return -1;
}

RobotGeometry default_geometry(RobotModel model) {
  RobotGeometry geometry;  // Create 2: owner's drawing
  // The Create 1 has no published base; 258 mm is what its drivers settled on.
  if (model == RobotModel::kCreate1) geometry.wheel_base_m = 0.258;
  return geometry;
}

Command simple(Opcode opcode) {
  Command c;
  c.add(opcode);
  return c;
}

Command start_run(int count) {
  Command c;
  for (int i = 0; i < count; ++i) c.add(kStart);
  return c;
}

Command drive(int velocity_mmps, int radius_mm, double wheel_base_m) {
  int velocity = std::clamp(velocity_mmps, -kMaxWheel_mmps, kMaxWheel_mmps);
  int radius = radius_mm;
  const bool straight = radius == kStraight || radius == 32767;
  if (!straight) radius = std::clamp(radius, -kMaxRadius_mm, kMaxRadius_mm);
  if (!straight && std::abs(radius) > 1) {  // 1 and -1 spin in place at the given wheel speed
    const double outer_per_mean = 1.0 + wheel_base_m * 1000.0 / (2.0 * std::abs(radius));
    const int most = static_cast<int>(kMaxWheel_mmps / outer_per_mean);
    velocity = std::clamp(velocity, -most, most);
  }
  Command c;
  c.add(kDrive);
  c.add16(velocity);
  c.add16(radius);
  return c;
}

Command drive_direct(int left_mmps, int right_mmps) {
  Command c;
  c.add(kDriveDirect);
  c.add16(std::clamp(right_mmps, -kMaxWheel_mmps, kMaxWheel_mmps));  // right first
  c.add16(std::clamp(left_mmps, -kMaxWheel_mmps, kMaxWheel_mmps));
  return c;
}

Command halt() { return drive_direct(0, 0); }

Command sensors(int packet) {
  Command c = simple(kSensors);
  c.add(packet);
  return c;
}

Command stream(std::span<const std::uint8_t> packets) { return list_command(kStream, packets); }
Command query(std::span<const std::uint8_t> packets) { return list_command(kQueryList, packets); }

Command pause_stream(bool resume) {
  Command c = simple(kPauseResume);
  c.add(resume ? 1 : 0);
  return c;
}

Command baud(int code) {
  Command c = simple(kBaud);
  c.add(code);
  return c;
}

int data_length(RobotModel model, std::uint8_t opcode, std::span<const std::uint8_t> data_so_far) {
  const Known other = model == RobotModel::kCreate1 ? Known::kCreate2 : Known::kCreate1;
  for (const OpcodeRow& row : kOpcodes) {
    if (row.opcode != opcode || row.known == other) continue;
    if (row.data != kVariable) return row.data;
    if (opcode == kSong) return data_so_far.size() < 2 ? 2 : 2 + 2 * data_so_far[1];
    return data_so_far.empty() ? 1 : 1 + data_so_far[0];
  }
  return -1;
}

}  // namespace st::oi
