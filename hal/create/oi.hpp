// The Open Interface of the iRobot Create 1 ("Create Open Interface v2", 2006) and Create 2 ("Create 2 OI",
// 2016) as bytes: opcodes, commands, sensor packets. Sixteen-bit fields are big-endian in both directions.
// Nothing is acknowledged, and a command that lacks data bytes eats the next one: a Command goes out in one
// write.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/create/oi_packets.hpp"

namespace st::oi {

enum Opcode : std::uint8_t {
  kReset = 7,
  kStart = 128,
  kBaud = 129,
  kControl = 130,
  kSafe = 131,
  kFull = 132,
  kPower = 133,
  kSpot = 134,
  kCover = 135,
  kDemo = 136,  // Create 1: Demo, one data byte; Create 2: Max clean, none
  kDrive = 137,
  kLowSideDrivers = 138,
  kLeds = 139,
  kSong = 140,
  kPlay = 141,
  kSensors = 142,
  kSeekDock = 143,
  kPwmLowSideDrivers = 144,
  kDriveDirect = 145,
  kDrivePwm = 146,
  kDigitalOutputs = 147,
  kStream = 148,
  kQueryList = 149,
  kPauseResume = 150,
  kSendIr = 151,
  kScript = 152,
  kPlayScript = 153,
  kShowScript = 154,
  kWaitTime = 155,
  kWaitDistance = 156,
  kWaitAngle = 157,
  kWaitEvent = 158,
  kSchedulingLeds = 162,
  kDigitLedsRaw = 163,
  kDigitLedsAscii = 164,
  kButtons = 165,
  kSchedule = 167,
  kSetDayTime = 168,
  kStop = 173,  // Create 2 only
};

enum Mode : int { kOff = 0, kPassive = 1, kSafeMode = 2, kFullMode = 3 };

inline constexpr int kMaxWheel_mmps = 500;
inline constexpr int kMaxRadius_mm = 2000;
inline constexpr int kStraight = -32768;  // special radii of Drive
inline constexpr int kSpinLeft = 1;
inline constexpr int kSpinRight = -1;
inline constexpr double kSlot_s = 0.015;  // the robot updates its sensors and streams this often

int default_baud(RobotModel model);
// Data bytes of the code after opcode 129; 0 for a code that is not one.
int baud_of_code(int code);
int code_of_baud(int baud);  // -1: none
RobotGeometry default_geometry(RobotModel model);

// Whether the opcode sets the wheels' speeds.
constexpr bool drives(std::uint8_t opcode) {
  return opcode == kDrive || opcode == kDriveDirect || opcode == kDrivePwm;
}

// After these the robot goes where it likes or hears no stop: Spot, Clean or Cover, Demo or Max, Dock,
// scripts and waits, another baud rate, and on a Create 2 its own buttons and schedule. And Full mode, in
// which it drives over an edge before anybody could stop it.
constexpr bool escapes_guard(std::uint8_t opcode) {
  return opcode == kBaud || opcode == kFull || opcode == kSpot || opcode == kCover || opcode == kDemo ||
         opcode == kSeekDock || opcode == kScript || opcode == kPlayScript ||
         (opcode >= kWaitTime && opcode <= kWaitEvent) || opcode == kButtons || opcode == kSchedule;
}

// One whole command.
struct Command {
  static constexpr std::size_t kCapacity = 128;
  std::uint8_t bytes[kCapacity]{};
  std::size_t size = 0;

  void add(int byte) {
    if (size < kCapacity) bytes[size++] = static_cast<std::uint8_t>(byte);
  }
  void add16(int value) {
    add(value >> 8 & 255);
    add(value & 255);
  }
  std::span<const std::uint8_t> span() const { return {bytes, size}; }
};

Command simple(Opcode opcode);  // opcodes without data
Command start_run(int count);   // fills the data bytes a stuck parser waits for
Command drive(int velocity_mmps, int radius_mm,
              double wheel_base_m);                   // clamped so that no wheel passes 500 mm/s
Command drive_direct(int left_mmps, int right_mmps);  // each clamped to 500 mm/s
Command halt();                                       // drive direct 0, 0
Command sensors(int packet);
Command stream(std::span<const std::uint8_t> packets);
Command query(std::span<const std::uint8_t> packets);
Command pause_stream(bool resume);
Command baud(int code);

// Data bytes that follow `opcode`, as far as the data bytes seen so far tell: Song, Stream, Query list and
// Script say their length in their data. -1: this model does not know the opcode.
int data_length(RobotModel model, std::uint8_t opcode, std::span<const std::uint8_t> data_so_far);

}  // namespace st::oi
