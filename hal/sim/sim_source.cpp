#include "hal/sim/sim_source.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <ctime>
#include <thread>
#include <vector>

#include "hal/clock.hpp"
#include "hal/error.hpp"
#include "hal/sim/camera_rig.hpp"
#include "hal/sim/robot_state_reader.hpp"
#include "hal/sim/sim_recording.hpp"

namespace st {
namespace {

// A colour exposure this long after the depth one, as a Kinect's two cameras stand to each other.
constexpr double kColorDelay_s = 0.0105;

sim::Scene scene_of(const SourceOptions& options) {
  sim::SceneOptions scene;
  const std::size_t colon = options.spec.find(':');
  if (colon != std::string::npos) scene.name = options.spec.substr(colon + 1);
  scene.seed = options.seed;
  return sim::make_scene(scene);
}

struct Slot {
  std::vector<std::uint16_t> depth;
  std::vector<std::uint8_t> color;
  double t_s = 0, device_t_s = 0, color_device_t_s = 0;
  bool has_color = false;
  std::int64_t complete_ns = 0;
  std::uint64_t index = 0;
  Vec3 gravity_mps2{};
};

class SimSource final : public FrameSource {
 public:
  explicit SimSource(const SourceOptions& options) : rig_(scene_of(options)) {
    const sim::Scene& scene = rig_.scene();
    info_.name = "sim:" + scene.name;
    info_.short_name = "sim-" + scene.name;
    info_.calibration = scene.calibration;
    info_.live = true;
    info_.frame_period_s = static_cast<double>(sim::kDepthPeriod_ticks) / sim::kTickRate_hz;
    const Intrinsics &d = scene.calibration.depth, &c = scene.calibration.color;
    for (Slot& slot : slots_) {
      slot.depth.assign(static_cast<std::size_t>(d.width * d.height), sim::DepthSensor::kNoReading);
      slot.color.assign(static_cast<std::size_t>(3 * c.width * c.height), 0);
    }
    color_ = slots_[0].color;
    if (!options.robot_state_path.empty()) follow(options.robot_state_path);
    ready_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (ready_ < 0)
      throw Failure(ExitCode::kDeviceFault,
                    info_.name + ": no file descriptor is left; close other programs");
  }
  ~SimSource() override {
    stop();
    close(ready_);
  }

  const SourceInfo& info() const override { return info_; }

  void start() override {
    if (thread_.joinable()) return;
    stop_ = false;
    start_ns_ = system_clock().monotonic_ns() + 20'000'000;
    timespec wall{};
    clock_gettime(CLOCK_REALTIME, &wall);
    wall_minus_monotonic_s_ = static_cast<double>(wall.tv_sec) + 1e-9 * static_cast<double>(wall.tv_nsec) -
                              1e-9 * static_cast<double>(system_clock().monotonic_ns());
    thread_ = std::thread([this] { render_loop(); });
  }

  Result next(FrameInput& out, int timeout_ms) override {
    // Two rounds at most: the first wake-up may be for a frame that was taken together with the one before.
    for (int round = 0; round < 2; ++round) {
      pollfd wait{ready_, POLLIN, 0};
      if (poll(&wait, 1, timeout_ms) <= 0) return Result::kTimeout;
      std::uint64_t count = 0;
      if (read(ready_, &count, sizeof count) != sizeof count) return Result::kTimeout;
      const int taken = middle_.exchange(reading_, std::memory_order_acq_rel);
      reading_ = taken & ~kFresh;
      if ((taken & kFresh) == 0) continue;
      hand_over(slots_[static_cast<std::size_t>(reading_)], out);
      return Result::kFrame;
    }
    return Result::kTimeout;
  }

  void stop() override {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  static constexpr int kFresh = 4;

  void follow(const std::string& path) {
    reader_ = std::make_unique<sim::RobotStateReader>(path);
    const int part = rig_.scene().first_robot_part;
    if (part < 0) throw Failure(ExitCode::kBadInput, info_.name + ": has no robot to drive; take sim:lab");
    rig_.drive_part(part, [this](double t_s, Pose& T_room_robot) {
      Pose2 at{};  // until its first entry the robot stands at its start
      reader_->pose_at(start_ns_ + static_cast<std::int64_t>(t_s * 1e9), at);
      T_room_robot = {rotation_z(at.yaw), {at.x, at.y, 0}};
      return true;
    });
  }

  void hand_over(const Slot& slot, FrameInput& out) {
    const Intrinsics &d = info_.calibration.depth, &c = info_.calibration.color;
    out.skipped = has_last_ ? static_cast<int>(slot.index - last_index_ - 1) : static_cast<int>(slot.index);
    last_index_ = slot.index;
    has_last_ = true;
    out.index = slot.index;
    out.t_s = slot.t_s;
    out.device_t_s = slot.device_t_s;
    out.depth = {slot.depth.data(), d.width, d.height};
    out.color = slot.has_color ? ImageView<const std::uint8_t>{slot.color.data(), 3 * c.width, c.height}
                               : ImageView<const std::uint8_t>{};
    out.color_device_t_s = slot.color_device_t_s;
    out.color_is_new = slot.has_color;  // one colour frame is made per depth frame
    out.has_gravity = true;
    out.gravity_mps2 = slot.gravity_mps2;
    out.complete_ns = slot.complete_ns;
    out.recorded_level = 0;
    out.odometry.clear();
    out.events.clear();
  }

  static void sleep_until(std::int64_t ns) {
    const timespec until{static_cast<time_t>(ns / 1'000'000'000), static_cast<long>(ns % 1'000'000'000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
  }

  // Frames are due at fixed instants; one that comes too late is left out, and so is its index.
  void render_loop() {
    const double period_s = info_.frame_period_s;
    sim::Random jitter(rig_.scene().seed, 0x1173);
    int writing = 1;
    for (std::uint64_t index = 0; !stop_; ++index) {
      double t_s = static_cast<double>(index) * period_s;
      const double late_s = static_cast<double>(system_clock().monotonic_ns() - start_ns_) * 1e-9 - t_s;
      if (late_s > period_s) {
        index += static_cast<std::uint64_t>(late_s / period_s);
        t_s = static_cast<double>(index) * period_s;
      }
      sleep_until(start_ns_ + static_cast<std::int64_t>(t_s * 1e9));
      Slot& slot = slots_[static_cast<std::size_t>(writing)];
      rig_.depth_frame(t_s, index,
                       {slot.depth.data(), info_.calibration.depth.width, info_.calibration.depth.height});
      slot.color = color_;
      slot.has_color = has_color_;
      slot.color_device_t_s = color_t_s_;
      slot.device_t_s = t_s;
      slot.index = index;
      slot.gravity_mps2 = sim::gravity_reading(rig_.scene(), t_s) +
                          Vec3{jitter.normal(), jitter.normal(), jitter.normal()} * 0.03;
      slot.complete_ns = system_clock().monotonic_ns();
      slot.t_s = static_cast<double>(slot.complete_ns) * 1e-9 + wall_minus_monotonic_s_;
      writing = middle_.exchange(writing | kFresh, std::memory_order_acq_rel) & ~kFresh;
      const std::uint64_t one = 1;
      if (write(ready_, &one, sizeof one) != sizeof one)
        continue;  // full: the reader has enough to wake up for
      color_t_s_ = t_s + kColorDelay_s;
      sleep_until(start_ns_ + static_cast<std::int64_t>(color_t_s_ * 1e9));
      rig_.color_frame(color_t_s_, index, color_.data());
      has_color_ = true;
    }
  }

  SourceInfo info_;
  sim::CameraRig rig_;
  std::unique_ptr<sim::RobotStateReader> reader_;
  std::array<Slot, 3> slots_;
  std::atomic<int> middle_{2};  // slot index, kFresh set until the reader takes it
  int reading_ = 0;
  int ready_ = -1;
  std::atomic<bool> stop_{false};
  std::thread thread_;
  std::int64_t start_ns_ = 0;
  double wall_minus_monotonic_s_ = 0;
  std::uint64_t last_index_ = 0;
  bool has_last_ = false;
  // The render thread's own.
  std::vector<std::uint8_t> color_;
  bool has_color_ = false;
  double color_t_s_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> open_sim_source(const SourceOptions& options) {
  return std::make_unique<SimSource>(options);
}

Pose sim_camera_room(const SourceOptions& options) { return scene_of(options).T_camera_room; }

}  // namespace st
