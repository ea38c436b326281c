#include "hal/source/tilt_state.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kCountsPerG = 819.0;
constexpr double kGravity_mps2 = 9.80665;
constexpr int kMotorMoving = 4;

std::int16_t int16_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::int16_t>(bytes[at] | bytes[at + 1] << 8);
}

double pitch_deg(double forward, double up) { return arc_tan2(forward, up) * 180.0 / kPi; }

std::int16_t to_counts(double mps2) {
  return static_cast<std::int16_t>(
      std::clamp(std::nearbyint(mps2 / kGravity_mps2 * kCountsPerG), -32767.0, 32767.0));
}

}  // namespace

std::optional<TiltState> parse_tilt_state(std::span<const std::uint8_t> bytes) {
  if (bytes.size() != static_cast<std::size_t>(kTiltStateBytes)) return std::nullopt;
  TiltState tilt;
  tilt.x = int16_at(bytes, 0);
  tilt.y = int16_at(bytes, 2);
  tilt.z = int16_at(bytes, 4);
  tilt.angle_half_deg = static_cast<std::int8_t>(bytes[6]);
  std::uint32_t status = 0;
  for (std::size_t i = 0; i < 4; ++i) status |= static_cast<std::uint32_t>(bytes[8 + i]) << (8 * i);
  tilt.motor_status = static_cast<std::int32_t>(status);
  return tilt;
}

void format_tilt_state(const TiltState& tilt, std::span<std::uint8_t, kTiltStateBytes> bytes) {
  const std::int16_t axes[3] = {tilt.x, tilt.y, tilt.z};
  for (std::size_t i = 0; i < 3; ++i) {
    bytes[2 * i] = static_cast<std::uint8_t>(axes[i] & 0xff);
    bytes[2 * i + 1] = static_cast<std::uint8_t>((axes[i] >> 8) & 0xff);
  }
  bytes[6] = static_cast<std::uint8_t>(tilt.angle_half_deg);
  bytes[7] = 0;
  const auto status = static_cast<std::uint32_t>(tilt.motor_status);
  for (std::size_t i = 0; i < 4; ++i) bytes[8 + i] = static_cast<std::uint8_t>(status >> (8 * i));
}

std::optional<Vec3> up_from_tilt(const TiltState& tilt) {
  if (tilt.motor_status == kMotorMoving) return std::nullopt;
  const Vec3 chip = Vec3{double(tilt.x), double(tilt.y), double(tilt.z)} * (kGravity_mps2 / kCountsPerG);
  const double length = norm(chip);
  if (length < 0.7 * kGravity_mps2 || length > 1.3 * kGravity_mps2) return std::nullopt;
  const double looks_up_deg = pitch_deg(chip.z, chip.y);
  const bool firmware_agrees = std::fabs(looks_up_deg - 0.5 * tilt.angle_half_deg) < 5.0;
  if (looks_up_deg > 5.0 && !firmware_agrees) return Vec3{chip.x, -chip.y, -chip.z};
  return Vec3{-chip.x, -chip.y, chip.z};
}

TiltState tilt_from_up(const Vec3& up_mps2) {
  TiltState tilt;
  tilt.x = to_counts(-up_mps2.x);
  tilt.y = to_counts(-up_mps2.y);
  tilt.z = to_counts(up_mps2.z);
  const double half_deg = 2.0 * pitch_deg(up_mps2.z, -up_mps2.y);
  tilt.angle_half_deg = static_cast<std::int8_t>(std::clamp(std::nearbyint(half_deg), -127.0, 127.0));
  return tilt;
}

}  // namespace st
