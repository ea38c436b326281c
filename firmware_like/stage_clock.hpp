// Times the stages of a frame: wall time of each, wall and CPU time of the whole.
#pragma once

#include "algo/core/records.hpp"
#include "hal/clock.hpp"

namespace st {

class StageClock {
 public:
  explicit StageClock(const Clock& clock) : clock_(clock) {}

  // The frame is here: the stages that follow are its cost. What went before was waiting.
  void start_frame(FrameReport& report) {
    report_ = &report;
    frame_ns_ = last_ns_ = clock_.monotonic_ns();
    cpu_ns_ = clock_.thread_cpu_ns();
  }
  // The stage ends here, and the next one begins.
  void done(Stage stage) {
    const std::int64_t now = clock_.monotonic_ns();
    report_->stage_us[static_cast<int>(stage)] = microseconds(now - last_ns_);
    last_ns_ = now;
  }
  void end_frame() {
    report_->frame_us = microseconds(clock_.monotonic_ns() - frame_ns_);
    report_->cpu_us = microseconds(clock_.thread_cpu_ns() - cpu_ns_);
  }

 private:
  static float microseconds(std::int64_t ns) { return static_cast<float>(static_cast<double>(ns) * 1e-3); }

  const Clock& clock_;
  FrameReport* report_ = nullptr;
  std::int64_t frame_ns_ = 0, last_ns_ = 0, cpu_ns_ = 0;
};

}  // namespace st
