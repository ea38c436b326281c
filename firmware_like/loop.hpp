// The loop: one depth frame in, poses out, and a wheel command while a path is driven. Everything it calls
// stands in algo or behind a seam of hal; everything it touches was bound and populated before run().
#pragma once

#include "algo/control/wheel_trail.hpp"
#include "firmware_like/budget.hpp"
#include "firmware_like/config.hpp"
#include "firmware_like/degradation.hpp"
#include "firmware_like/object_tracker.hpp"
#include "firmware_like/robot_driver.hpp"
#include "firmware_like/stage_clock.hpp"
#include "hal/clock.hpp"
#include "hal/results/result_writer.hpp"
#include "hal/results/telemetry.hpp"
#include "hal/serve/pose_server.hpp"
#include "hal/source/frame_source.hpp"

namespace st {

// What the loop works with; all outlive it. Without a robot `driver` is null, without clients `server`.
struct LoopParts {
  FrameSource& source;
  ObjectTracker& tracker;
  Telemetry& telemetry;
  BudgetMonitor& budget;
  const Clock& clock;
  const ResultWriter& results;  // a disk that is full ends the run
  RobotDriver* driver;
  PoseServer* server;
};

// Why run() came back.
enum class LoopEnd { kSourceEnded, kTimeUp, kPathDriven, kSignal, kSourceFault, kRobotFault, kResultsFailed };

class Loop {
 public:
  Loop(const LoopParts& parts, const LoopConfig& config);

  // On the compute thread, inside of a SealedSection.
  LoopEnd run();

  std::uint64_t frames() const { return frames_; }
  std::uint64_t skipped() const { return skipped_; }
  double last_t_s() const { return report_.t_s; }

 private:
  bool acquire();
  bool stop(LoopEnd why);
  double now_s() const;
  void drive();
  DriverView driver_view() const;
  void publish();

  LoopParts parts_;
  LoopConfig config_;
  StageClock stages_;
  Degradation degradation_;
  FrameInput input_;
  WheelTrail wheels_;
  FrameReport report_;
  LoopEnd end_ = LoopEnd::kSourceEnded;
  ServedFrame served_;
  int level_ = 0;
  std::uint64_t frames_ = 0, skipped_ = 0;
  double first_t_s_ = 0;
};

}  // namespace st
