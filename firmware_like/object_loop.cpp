#include "firmware_like/object_loop.hpp"

namespace st {

// STAR, Listing 1: segment, align with the model, judge, fuse into the model; for every object, every frame.
LoopEnd ObjectLoop::run() {
  while (acquire()) {
    tracker_.preprocess(input_, report_);
    stages_.done(Stage::kPreprocess);
    tracker_.segment();
    stages_.done(Stage::kSegment);
    tracker_.predict();
    stages_.done(Stage::kPredict);
    tracker_.render();
    stages_.done(Stage::kRender);
    tracker_.associate_pixels();
    stages_.done(Stage::kAssociate);
    tracker_.align_all(ladder_step(level_));
    stages_.done(Stage::kAlign);
    tracker_.judge_all();
    stages_.done(Stage::kJudge);
    tracker_.integrate_all(ladder_step(level_));
    stages_.done(Stage::kIntegrate);
    tracker_.decide_lives(ladder_step(level_));
    stages_.done(Stage::kDecide);
    drive();
    stages_.done(Stage::kSend);
    tracker_.publish(report_);
    publish();
  }
  if (parts_.driver != nullptr) parts_.driver->stop();
  return end_;
}

DriverView ObjectLoop::driver_view() const {
  DriverView view;
  view.sight.watched = true;
  for (const Track& track : tracker_.tracks())
    view.sight.sees = view.sight.sees || (track.active() && track.state == TrackState::kGood);
  if (input_.complete_ns != 0)
    view.sight.age_s = static_cast<double>(parts_.clock.monotonic_ns() - input_.complete_ns) * 1e-9;
  view.wheels = input_.wheels;
  tracker_.see(view.objects);
  view.trail = &wheels_;
  view.t_s = input_.t_s;
  view.host_now_s = input_.t_s + view.sight.age_s;
  return view;
}

void ObjectLoop::drive() {
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

}  // namespace st
