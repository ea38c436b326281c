#include "hal/sim/robot_state_reader.hpp"

#include <algorithm>

namespace st::sim {
namespace {

constexpr double kCarryOn_s = 0.05;

Pose2 pose_between(const SimStateEntry& a, const SimStateEntry& b, std::int64_t ns) {
  const double f =
      static_cast<double>(ns - a.monotonic_ns) / static_cast<double>(b.monotonic_ns - a.monotonic_ns);
  return between(Pose2{a.x_m, a.y_m, a.yaw_rad}, Pose2{b.x_m, b.y_m, b.yaw_rad}, f);
}

}  // namespace

bool RobotStateReader::pose_at(std::int64_t ns, Pose2& pose) const {
  // The robot may come round and write over an entry on the way back: then once more from the newest.
  for (int attempt = 0; attempt < 8; ++attempt) {
    std::uint64_t i = ring_.written();
    if (i == 0) return false;
    SimStateEntry before;
    bool there = ring_.entry(--i, before);
    SimStateEntry after = before;
    const std::uint64_t oldest = i > SimStateRing::kEntries / 2 ? i - SimStateRing::kEntries / 2 : 0;
    while (there && i > oldest && before.monotonic_ns > ns) {
      after = before;
      there = ring_.entry(--i, before);
    }
    if (!there) continue;
    pose = {before.x_m, before.y_m, before.yaw_rad};
    const double past_s = static_cast<double>(ns - before.monotonic_ns) * 1e-9;
    if (after.monotonic_ns > before.monotonic_ns && past_s > 0)
      pose = pose_between(before, after, ns);
    else if (past_s > 0)
      pose = compose(pose, {before.v_mps * std::min(past_s, kCarryOn_s), 0,
                            before.w_rps * std::min(past_s, kCarryOn_s)});
    return true;
  }
  return false;
}

}  // namespace st::sim
