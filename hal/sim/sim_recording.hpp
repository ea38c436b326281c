// A scene as a recording with ground truth: what fakenect-record would have written, and beside it
// camera.toml, the true poses and shapes, what was visible, and the preset path.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "hal/sim/camera_rig.hpp"

namespace st::sim {

// The Kinect's own clocks, as real ones run: 60 MHz ticks; depth every 2,002,155, colour every 2,000,288 of
// them.
inline constexpr double kTickRate_hz = 60e6;
inline constexpr std::int64_t kDepthPeriod_ticks = 2'002'155;
inline constexpr std::int64_t kColorPeriod_ticks = 2'000'288;

// Removes from `folder` what simulate writes and nothing else. True when nothing remains in it.
bool clear_recording(const std::string& folder);

// Writes into `folder`, which must exist, until the scene ends or `stop` is set; in both cases every file is
// whole. `progress(depth frames written, depth frames in all)` is called after each. The same scene gives the
// same bytes. Returns the depth frames written. Throws Failure (kBadInput) where a file cannot be written.
std::uint64_t write_recording(CameraRig& rig, const std::string& folder, const std::atomic<bool>& stop,
                              const std::function<void(std::uint64_t, std::uint64_t)>& progress);

// What the accelerometer reads in this scene, m/s^2, camera optical frame: at rest it points up; a hand's
// pushes add to it.
Vec3 gravity_reading(const Scene& scene, double t_s);

}  // namespace st::sim
