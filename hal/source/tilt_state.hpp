// The Kinect's accelerometer: what libfreenect keeps as raw tilt state, and the vector that the loop uses.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "algo/core/linear.hpp"

namespace st {

struct TiltState {
  std::int16_t x = 0, y = 0, z = 0;  // counts, 819 per g
  std::int8_t angle_half_deg = 0;    // the firmware's own pitch, positive: the camera looks up
  std::int32_t motor_status = 0;     // 4: moving
};

inline constexpr int kTiltStateBytes = 12;  // struct freenect_raw_tilt_state as fakenect-record dumps it

// Nothing when there are not exactly kTiltStateBytes.
std::optional<TiltState> parse_tilt_state(std::span<const std::uint8_t> bytes);
void format_tilt_state(const TiltState& tilt, std::span<std::uint8_t, kTiltStateBytes> bytes);

// What the accelerometer measures, in the camera's optical frame (x right, y down, z forward), m/s^2: points
// up at rest. Nothing while the motor turns the head, or when the length is not that of gravity (no motor
// unit, or being carried).
//
// On Kinects the chip's axes are x left, y up, z forward: in real recordings the firmware's own pitch has the
// sign of z. Simulated recordings are met that have x right, y up, z backward. They are told apart where it
// matters: a camera that would look up by more than 5 degrees, while the firmware's pitch does not say so,
// looks down.
std::optional<Vec3> up_from_tilt(const TiltState& tilt);

// The inverse, in the axes of a Kinect, firmware pitch included.
TiltState tilt_from_up(const Vec3& up_mps2);

}  // namespace st
