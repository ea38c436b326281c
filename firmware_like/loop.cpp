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
      config_(config),
      stages_(parts.clock),
      degradation_(parts.source.info().frame_period_s),
      wheels_(wheel_base_m(parts), config.camera_lag_s) {}

// STAR, Listing 1: segment, align with the model, judge, fuse into the model; for every object, every frame.
LoopEnd Loop::run() {
  ObjectTracker& tracker = parts_.tracker;
  while (acquire()) {
    tracker.preprocess(input_, report_);
    stages_.done(Stage::kPreprocess);
    tracker.segment();
    stages_.done(Stage::kSegment);
    tracker.predict();
    stages_.done(Stage::kPredict);
    tracker.render();
    stages_.done(Stage::kRender);
    tracker.associate_pixels();
    stages_.done(Stage::kAssociate);
    tracker.align_all(ladder_step(level_));
    stages_.done(Stage::kAlign);
    tracker.judge_all();
    stages_.done(Stage::kJudge);
    tracker.integrate_all(ladder_step(level_));
    stages_.done(Stage::kIntegrate);
    tracker.decide_lives(ladder_step(level_));
    stages_.done(Stage::kDecide);
    drive();
    stages_.done(Stage::kSend);
    publish();
  }
  if (parts_.driver != nullptr) parts_.driver->stop();
  return end_;
}

double Loop::now_s() const { return static_cast<double>(parts_.clock.monotonic_ns()) * 1e-9; }

DriverView Loop::driver_view() const {
  DriverView view;
  view.sight.watched = true;
  for (const Track& track : parts_.tracker.tracks())
    view.sight.sees = view.sight.sees || (track.active() && track.state == TrackState::kGood);
  if (input_.complete_ns != 0)
    view.sight.age_s = static_cast<double>(parts_.clock.monotonic_ns() - input_.complete_ns) * 1e-9;
  view.wheels = input_.wheels;
  parts_.tracker.see(view.objects);
  view.trail = &wheels_;
  view.t_s = input_.t_s;
  view.host_now_s = input_.t_s + view.sight.age_s;
  return view;
}

void Loop::drive() {
  if (parts_.driver == nullptr) return;
  const RobotFault before = parts_.driver->held_by();
  const bool knew_robot = parts_.driver->picked().id != 0;
  parts_.driver->decide(now_s(), driver_view());
  parts_.driver->send();
  const Obedience& picked = parts_.driver->picked();
  if (!knew_robot && picked.id != 0)
    report_.events.push_back({report_.t_s, EventKind::kSteeringObject, picked.id, picked.misfit_m,
                              picked.lag_s, picked.base.gain});
  const RobotFault now = parts_.driver->held_by();
  if (now == before || now == RobotFault::kNone) return;
  report_.events.push_back({report_.t_s, EventKind::kRobotFault, 0, static_cast<double>(now), 0, 0});
}

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
  parts_.tracker.publish(report_);
  ++frames_;
  stages_.done(Stage::kPublish);
  stages_.end_frame();
  parts_.budget.count(report_);
  if (parts_.source.info().live) degradation_.next(report_.cpu_us);
  parts_.telemetry.offer(report_);
  if (parts_.server == nullptr) return;
  served_.report = report_;
  if (parts_.driver != nullptr) served_.robot = parts_.driver->served();
  parts_.server->offer(served_);
}

}  // namespace st
