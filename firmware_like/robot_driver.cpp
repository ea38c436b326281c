#include "firmware_like/robot_driver.hpp"

namespace st {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;
// After a longer stall than the guard's patience the robot stood, and the path's time with it.
constexpr double kLongestStep_s = 0.25;
// From now until what is decided now is, in the middle of its time, what the wheels do: half a frame, the
// command's way, the robot's own speed control, and the way of its reports, which are the clock.
constexpr double kAhead_s = 0.045;
constexpr double kLaying_s = 0.6;  // it stands, and its pose settles

}  // namespace

RobotDriver::RobotDriver(DriveBase& robot, Steering steering, const Path* path, NewestCommand* command,
                         Reaction on_bump)
    : robot_(robot), steering_(steering), path_(path), command_(command), supervisor_(on_bump) {}

const SeenObject* RobotDriver::robot_in(const SeenObjects& objects) const {
  for (const SeenObject& object : objects)
    if (object.id != 0 && object.id == picked_.id) return &object;
  return nullptr;
}

// Whatever the robot is doing, its base is followed, or looked for.
void RobotDriver::watch(const DriverView& view, double passed_s) {
  if (phase_ == Phase::kStartMotion) witness_.add(view.wheels, view.objects);
  if (picked_.id == 0) return;
  WheelOdometry wheels = view.wheels;
  if (!wheels.valid) wheels.dt_s = passed_s;
  const double v = 0.5 * (speeds_.left_mps + speeds_.right_mps);
  base_.update(wheels, v, (speeds_.right_mps - speeds_.left_mps) / wheel_base_m(), robot_in(view.objects));
  const double exposed_s = view.trail->exposure_s() - picked_.lag_s;
  const WheelOdometry since = view.trail->between(exposed_s, view.host_now_s + kAhead_s);
  base_now_ = since.valid ? base_.after(since) : base_.base();
}

void RobotDriver::listen(FixedVector<OdometrySample, 64>& odometry) {
  const std::size_t known = odometry.size();
  robot_.poll(odometry, status_);
  if (phase_ != Phase::kStartMotion) return;
  for (std::size_t i = known; i < odometry.size(); ++i) {
    start_forward_m_ += 0.5 * (odometry[i].left_m + odometry[i].right_m);
    start_turn_rad_ += (odometry[i].right_m - odometry[i].left_m) / wheel_base_m();
  }
}

void RobotDriver::decide(double now_s, const DriverView& view) {
  if (phase_since_s_ < 0) phase_since_s_ = last_s_ = now_s;
  const double passed_s = stood_ ? 0 : now_s - last_s_ < kLongestStep_s ? now_s - last_s_ : kLongestStep_s;
  stood_ = false;
  last_s_ = now_s;
  watch(view, passed_s);
  Sight sight = view.sight;
  if (picked_.id != 0) sight.sees = base_.seen();
  held_ = never_obeyed_ ? Reaction::kEnd : supervisor_.judge(now_s, status_, sight, led_);
  if (held_ == Reaction::kNone)
    speeds_ = next_speeds(now_s, view, passed_s);
  else
    hold(passed_s);
  led_ = speeds_;
}

void RobotDriver::hold(double passed_s) {
  speeds_ = {};
  if (open_) open_->hold(passed_s);
}

void RobotDriver::enter(Phase phase, double now_s) {
  phase_ = phase;
  phase_since_s_ = now_s;
  if (phase == Phase::kStartMotion) {
    open_.emplace(start_path_, wheel_base_m());
    if (++start_motions_ % 2 == 1) witness_.clear();  // two motions fit into its memory
  }
  if (phase == Phase::kDriving && steering_ == Steering::kOpenLoop) open_.emplace(*path_, wheel_base_m());
  if (phase == Phase::kDriving && steering_ == Steering::kClosedLoop) {
    T_floor_path_ = base_.base();
    closed_.emplace(*path_, wheel_base_m());
  }
}

WheelSpeeds RobotDriver::next_speeds(double now_s, const DriverView& view, double passed_s) {
  switch (phase_) {
    case Phase::kLearning:
      if (now_s - phase_since_s_ >= kStillBefore_s)
        enter(steering_ == Steering::kOpenLoop ? Phase::kDriving : Phase::kStartMotion, now_s);
      return {};
    case Phase::kStartMotion:
      return start_motion_speeds(now_s, view, passed_s);
    case Phase::kLaying:
      if (now_s - phase_since_s_ >= kLaying_s) enter(Phase::kDriving, now_s);
      return {};
    case Phase::kDriving: {
      if (steering_ == Steering::kClient) return client_speeds(now_s);
      const WheelSpeeds speeds = path_speeds(passed_s);
      if (open_ ? open_->done() : closed_->done()) enter(Phase::kDone, now_s);
      return speeds;
    }
    case Phase::kDone:
      return {};
  }
  return {};
}

// A command holds until the next frame: for as long, it is to be expected, as the one before. Were it taken
// for shorter when frames are late, each command would overshoot by what the one before did, and more.
WheelSpeeds RobotDriver::dead_reckoned(double passed_s) {
  return open_->step(passed_s, passed_s > kFrame_s ? passed_s : kFrame_s);
}

WheelSpeeds RobotDriver::start_motion_speeds(double now_s, const DriverView& view, double passed_s) {
  if (!open_->done()) {
    const WheelSpeeds speeds =
        within_start_allowance(dead_reckoned(passed_s), start_forward_m_, start_turn_rad_, wheel_base_m());
    open_->told(speeds);
    return speeds;
  }
  picked_ = witness_.judge();
  if (const SeenObject* robot = robot_in(view.objects); robot != nullptr && robot->good) {
    base_.start(picked_, robot->pose);
    path_begins_t_s_ = view.t_s;
    open_.reset();
    enter(Phase::kLaying, now_s);
    return {};
  }
  picked_ = {};
  if (start_motions_ < kStartMotions)
    enter(Phase::kStartMotion, now_s);
  else
    never_obeyed_ = true;
  return {};
}

WheelSpeeds RobotDriver::path_speeds(double passed_s) {
  if (open_) return dead_reckoned(passed_s);
  return closed_->step(compose(inverse(T_floor_path_), base_now_), passed_s, base_.extra_turn_rpm());
}

WheelSpeeds RobotDriver::client_speeds(double now_s) {
  const ClientCommand command = command_->take();
  const double age_s = now_s - static_cast<double>(command.monotonic_ns) * 1e-9;
  if (command.monotonic_ns == 0 || age_s > kClientPatience_s) return {};
  return wheel_speeds(command.v_mps, command.w_rps, wheel_base_m());
}

// A start motion is short enough for a frame that is a little late to lead beyond it.
void RobotDriver::wait_without_frame(double now_s) {
  const bool late = phase_ == Phase::kStartMotion || (now_s - last_s_) * 1000 >= kStaleFrame_ms;
  if (phase_since_s_ < 0 || !late) return;
  if (!stood_) hold(now_s - last_s_);
  stood_ = true;
  robot_.stop();
}

ServedRobot RobotDriver::served() const {
  static constexpr const char* kStates[] = {"learning", "start_motion", "standing", "driving", "done"};
  ServedRobot robot;
  robot.object = picked_.id;
  robot.seen = picked_.id != 0 && base_.seen();
  robot.base = base_.base();
  robot.base_now = base_now_;
  robot.told_v_mps = 0.5 * (speeds_.left_mps + speeds_.right_mps);
  robot.told_w_rps = (speeds_.right_mps - speeds_.left_mps) / wheel_base_m();
  robot.state = kStates[static_cast<int>(phase_)];
  robot.held_by = name_of(held_by());
  return robot;
}

bool RobotDriver::finished(double now_s) const {
  return phase_ == Phase::kDone && now_s - phase_since_s_ > kStillAfter_s;
}

}  // namespace st
