#include "hal/sim/robot_state_reader.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>

#include "hal/error.hpp"

namespace st::sim {
namespace {

Pose2 pose_between(const SimStateEntry& a, const SimStateEntry& b, std::int64_t ns) {
  const double span = static_cast<double>(b.monotonic_ns - a.monotonic_ns);
  const double f = span > 0 ? static_cast<double>(ns - a.monotonic_ns) / span : 0.0;
  return between(Pose2{a.x_m, a.y_m, a.yaw_rad}, Pose2{b.x_m, b.y_m, b.yaw_rad}, f);
}

}  // namespace

RobotStateReader::RobotStateReader(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat info {};
  const bool large =
      file >= 0 && fstat(file, &info) == 0 && info.st_size >= static_cast<off_t>(sizeof(SimStateRing));
  void* memory = large ? mmap(nullptr, sizeof(SimStateRing), PROT_READ, MAP_SHARED, file, 0) : MAP_FAILED;
  if (file >= 0) close(file);
  if (memory == MAP_FAILED)
    throw Failure(ExitCode::kDeviceFault,
                  path + ": no robot state can be read there; is the simulated Create running?");
  ring_ = static_cast<const SimStateRing*>(memory);
  if (ring_->magic != SimStateRing::kMagic || ring_->version != SimStateRing::kVersion) {
    munmap(memory, sizeof(SimStateRing));
    throw Failure(ExitCode::kDeviceFault, path +
                                              ": is not a state file of the simulated Create of this "
                                              "version; use one program version for both");
  }
}

RobotStateReader::~RobotStateReader() { munmap(const_cast<SimStateRing*>(ring_), sizeof(SimStateRing)); }

bool RobotStateReader::pose_at(std::int64_t ns, Pose2& pose) const {
  // An entry that the writer may have reached again while it was read is worth nothing: look at the count
  // once more.
  for (int attempt = 0; attempt < 8; ++attempt) {
    const std::uint64_t written = ring_->written.load(std::memory_order_acquire);
    if (written == 0) return false;
    const auto entry = [&](std::uint64_t i) { return ring_->entries[i % SimStateRing::kEntries]; };
    const std::uint64_t oldest =
        written > SimStateRing::kEntries / 2 ? written - SimStateRing::kEntries / 2 : 0;
    std::uint64_t i = written - 1;
    SimStateEntry after = entry(i);
    if (ns >= after.monotonic_ns) {
      const double dt = std::min(static_cast<double>(ns - after.monotonic_ns) * 1e-9, 0.05);
      pose = compose({after.x_m, after.y_m, after.yaw_rad}, {after.v_mps * dt, 0, after.w_rps * dt});
    } else {
      SimStateEntry before = after;
      while (i > oldest && before.monotonic_ns > ns) {
        after = before;
        before = entry(--i);
      }
      pose = before.monotonic_ns > ns ? Pose2{before.x_m, before.y_m, before.yaw_rad}
                                      : pose_between(before, after, ns);
    }
    std::atomic_thread_fence(std::memory_order_acquire);
    if (ring_->written.load(std::memory_order_relaxed) - oldest < SimStateRing::kEntries) return true;
  }
  return false;
}

}  // namespace st::sim
