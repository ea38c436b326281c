#include "hal/sim/trajectory.hpp"

#include <algorithm>
#include <cmath>

namespace st::sim {
namespace {

constexpr double kRate_hz = 200;
constexpr double kPreset_s = 0.02;
constexpr double kAcceleration_mps2 = 0.8;

}  // namespace

Trajectory::Trajectory(const Pose2& start, double start_s, double end_s,
                       const std::vector<DriveCommand>& commands, double wheel_base_m,
                       const DiffDriveErrors& errors, std::uint64_t seed) {
  DiffDriveBody body(wheel_base_m, kAcceleration_mps2, errors, seed);
  std::size_t next = 0;
  const int count = static_cast<int>(end_s * kRate_hz) + 2;
  for (int i = 0; i < count; ++i) {
    poses_.push_back(compose(start, body.pose()));
    for (; next < commands.size() && commands[next].t_s + start_s <= i / kRate_hz + 1e-9; ++next) {
      const double half = 0.5 * wheel_base_m * commands[next].w_rps;
      body.command(commands[next].v_mps - half, commands[next].v_mps + half);
    }
    body.step(1 / kRate_hz);
  }
}

Pose2 Trajectory::at(double t_s) const {
  const double at = std::clamp(t_s * kRate_hz, 0.0, static_cast<double>(poses_.size() - 1));
  const auto i = std::min(static_cast<std::size_t>(at), poses_.size() - 2);
  const double f = at - static_cast<double>(i);
  return between(poses_[i], poses_[i + 1], f);
}

std::vector<PresetSample> ideal_path(const std::vector<DriveCommand>& commands) {
  std::vector<PresetSample> samples;
  if (commands.empty()) return samples;
  constexpr double kBase_m = 0.25;  // cancels out: wheel speeds are made from v and w with it
  DiffDriveBody body(kBase_m, 1e9, {}, 1);
  std::size_t next = 0;
  const int count = static_cast<int>(std::ceil(commands.back().t_s / kPreset_s)) + 1;
  for (int i = 0; i < count; ++i) {
    const double t = i * kPreset_s;
    DriveCommand now{};
    // Commands may change between two samples: drive each piece for its own time.
    double from = t;
    const Pose2 pose = body.pose();
    while (from < t + kPreset_s) {
      while (next + 1 < commands.size() && commands[next + 1].t_s <= from + 1e-12) ++next;
      const double until =
          next + 1 < commands.size() ? std::min(commands[next + 1].t_s, t + kPreset_s) : t + kPreset_s;
      if (from == t) now = commands[next];
      const double half = 0.5 * kBase_m * commands[next].w_rps;
      body.command(commands[next].v_mps - half, commands[next].v_mps + half);
      body.step(until - from);
      from = until;
    }
    samples.push_back({t, pose, now.v_mps, now.w_rps});
  }
  return samples;
}

}  // namespace st::sim
