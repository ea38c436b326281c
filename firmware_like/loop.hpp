// What the loops of both modes share: one depth frame in, its stages timed, its report out. Everything a loop
// calls stands in algo or behind a seam of hal; everything it touches was bound and populated before run().
#pragma once

#include "algo/control/wheel_trail.hpp"
#include "firmware_like/budget.hpp"
#include "firmware_like/config.hpp"
#include "firmware_like/degradation.hpp"
#include "firmware_like/robot_driver.hpp"
#include "firmware_like/stage_clock.hpp"
#include "hal/clock.hpp"
#include "hal/recording/recorder.hpp"
#include "hal/results/result_writer.hpp"
#include "hal/results/telemetry.hpp"
#include "hal/serve/pose_server.hpp"
#include "hal/source/frame_source.hpp"

namespace st {

// What the loop works with; all outlive it. Without a robot `driver` is null, without clients `server`, when
// nothing is recorded `recorder`.
struct LoopParts {
  FrameSource& source;
  Telemetry& telemetry;
  BudgetMonitor& budget;
  const Clock& clock;
  const ResultWriter& results;  // a disk that is full ends the run
  RobotDriver* driver;
  PoseServer* server;
  Recorder* recorder;
};

// Why run() came back.
enum class LoopEnd { kSourceEnded, kTimeUp, kPathDriven, kSignal, kSourceFault, kRobotFault, kResultsFailed };

class Loop {
 public:
  Loop(const LoopParts& parts, const LoopConfig& config);
  virtual ~Loop() = default;
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  // On the compute thread, inside of a SealedSection.
  virtual LoopEnd run() = 0;

  std::uint64_t frames() const { return frames_; }
  std::uint64_t skipped() const { return skipped_; }
  double last_t_s() const { return report_.t_s; }

 protected:
  bool acquire();  // false: the run is over, for the reason `end_`
  void publish();
  double now_s() const;

  LoopParts parts_;
  StageClock stages_;
  FrameInput input_;
  WheelTrail wheels_;
  FrameReport report_;
  LoopEnd end_ = LoopEnd::kSourceEnded;
  int level_ = 0;  // of degradation

 private:
  bool stop(LoopEnd why);

  LoopConfig config_;
  Degradation degradation_;
  ServedFrame served_;
  std::uint64_t frames_ = 0, skipped_ = 0;
  double first_t_s_ = 0;
};

}  // namespace st
