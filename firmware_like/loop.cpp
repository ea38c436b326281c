#include "firmware_like/loop.hpp"

#include "hal/system/stop_signal.hpp"

namespace st {
namespace {

constexpr int kWait_ms = 100;     // how often a waiting loop looks for a signal
constexpr int kSilentWaits = 50;  // five seconds without a frame from a live source: it is gone

double wheel_base_m(const LoopParts& parts) {
  return parts.driver != nullptr ? parts.driver->wheel_base_m() : parts.source.info().wheel_base_m;
}

}  // namespace

Loop::Loop(const LoopParts& parts, const LoopConfig& config)
    : parts_(parts),
      stages_(parts.clock),
      wheels_(wheel_base_m(parts), config.camera_lag_s),
      config_(config),
      degradation_(parts.source.info().frame_period_s) {}

double Loop::now_s() const { return static_cast<double>(parts_.clock.monotonic_ns()) * 1e-9; }

// The one place that waits: for the next frame, and in a replay for room in the ring of reports.
bool Loop::acquire() {
  if (!parts_.source.info().live) parts_.telemetry.wait_for_room();
  for (int waits = 0;; ++waits) {
    if (stop_signal() != 0) return stop(LoopEnd::kSignal);
    if (parts_.results.failed()) return stop(LoopEnd::kResultsFailed);
    if (parts_.driver != nullptr && parts_.driver->fault() != RobotFault::kNone)
      return stop(LoopEnd::kRobotFault);
    if (parts_.driver != nullptr && parts_.driver->finished(now_s())) return stop(LoopEnd::kPathDriven);
    switch (parts_.source.next(input_, kWait_ms)) {
      case FrameSource::Result::kEnd:
        return stop(LoopEnd::kSourceEnded);
      case FrameSource::Result::kFault:
        return stop(LoopEnd::kSourceFault);
      case FrameSource::Result::kTimeout:
        if (parts_.driver != nullptr) parts_.driver->wait_without_frame(now_s());
        if (parts_.source.info().live && waits >= kSilentWaits) return stop(LoopEnd::kSourceFault);
        continue;
      case FrameSource::Result::kFrame:
        break;
    }
    break;
  }
  if (parts_.driver != nullptr) parts_.driver->listen(input_.odometry);
  if (wheel_base_m(parts_) > 0) wheels_.take(input_);
  if (frames_ == 0) first_t_s_ = input_.t_s;
  if (config_.seconds > 0 && input_.t_s - first_t_s_ > config_.seconds) return stop(LoopEnd::kTimeUp);
  report_ = FrameReport{};
  report_.index = input_.index;
  report_.t_s = input_.t_s;
  report_.device_t_s = input_.device_t_s;
  level_ = parts_.source.info().live ? degradation_.level() : input_.recorded_level;
  report_.level = level_;
  for (const Event& event : input_.events) report_.events.push_back(event);
  skipped_ += static_cast<std::uint64_t>(input_.skipped);
  stages_.start_frame(report_);
  if (input_.complete_ns != 0)
    report_.age_us =
        static_cast<float>(static_cast<double>(parts_.clock.monotonic_ns() - input_.complete_ns) * 1e-3);
  stages_.done(Stage::kAcquire);
  return true;
}

bool Loop::stop(LoopEnd why) {
  end_ = why;
  return false;
}

void Loop::publish() {
  ++frames_;
  stages_.done(Stage::kPublish);
  stages_.end_frame();
  parts_.budget.count(report_);
  if (parts_.source.info().live) degradation_.next(report_.cpu_us);
  parts_.telemetry.offer(report_);
  if (parts_.recorder != nullptr)
    parts_.recorder->add(input_, level_, parts_.driver != nullptr ? parts_.driver->status().log_bytes : 0);
  if (parts_.server == nullptr) return;
  served_.report = report_;
  if (parts_.driver != nullptr) served_.robot = parts_.driver->served();
  parts_.server->offer(served_);
}

}  // namespace st
