#include "algo/control/wheel_trail.hpp"

#include <algorithm>

namespace st {
namespace {

constexpr double kCrystalDrift = 1e-4;  // both clocks' together, at most
constexpr double kLongestGap_s = 0.12;  // between two reports: a longer one tells only of the sum
constexpr double kOutlook_s = 0.08;     // the newest speed is carried on for so long
constexpr double kBurst_s = 0.005;
constexpr double kSpeedOver_s = 0.04;  // reports come in bursts: a speed is taken over several

}  // namespace

void ExposureClock::take(double host_t_s, double device_t_s) {
  const double offset_s = host_t_s - device_t_s;
  const double elapsed_s = device_t_s - last_device_t_s_;
  // A counter that restarted begins anew.
  if (!started_ || elapsed_s < 0)
    offset_s_ = offset_s;
  else
    offset_s_ = std::min(offset_s, offset_s_ + kCrystalDrift * elapsed_s);
  started_ = true;
  last_device_t_s_ = device_t_s;
}

void WheelTrail::add(const OdometrySample& sample) {
  Mark next = count_ > 0 ? mark(0) : Mark{};
  next.t_s = count_ > 0 ? std::max(next.t_s, sample.t_s) : sample.t_s;
  if (count_ > 0) {  // the first report's travel began before anything that is known
    next.forward_m += 0.5 * (sample.left_m + sample.right_m);
    next.turn_rad += (sample.right_m - sample.left_m) / wheel_base_m_;
  }
  // Reports that came in one burst are one mark: between them there is no time in which to roll.
  const bool burst = count_ > 1 && next.t_s - mark(0).t_s < kBurst_s;
  if (!burst) ++count_;
  marks_[(count_ - 1) % kMarks] = next;
}

// Linear between two marks, and a little beyond the newest.
bool WheelTrail::at(double t_s, Mark& out) const {
  const std::size_t known = std::min(count_, kMarks);
  if (known < 2) return false;
  std::size_t older = 0;  // the newest mark not later than t_s
  while (older < known && mark(older).t_s > t_s) ++older;
  if (older == known) return false;
  std::size_t newer = older == 0 ? 0 : older - 1;
  if (older == 0) {
    if (t_s - mark(0).t_s > kOutlook_s) return false;
    for (older = 1; older + 1 < known && mark(0).t_s - mark(older).t_s < kSpeedOver_s;) ++older;
  }
  const Mark &a = mark(older), &b = mark(newer);
  const double span_s = b.t_s - a.t_s;
  if (!(span_s > 0) || span_s > kLongestGap_s) return false;
  const double share = (t_s - a.t_s) / span_s;
  out = {t_s, a.forward_m + share * (b.forward_m - a.forward_m),
         a.turn_rad + share * (b.turn_rad - a.turn_rad)};
  return true;
}

WheelOdometry WheelTrail::between(double from_s, double until_s) const {
  WheelOdometry motion;
  motion.dt_s = until_s - from_s;
  Mark a, b;
  motion.valid = until_s > from_s && at(from_s, a) && at(until_s, b);
  if (!motion.valid) return motion;
  motion.forward_m = b.forward_m - a.forward_m;
  motion.turn_rad = b.turn_rad - a.turn_rad;
  return motion;
}

// Both exposures by what is known now of the clocks: a better offset is no motion.
void WheelTrail::take(FrameInput& frame) {
  for (const OdometrySample& sample : frame.odometry) add(sample);
  clock_.take(frame.t_s, frame.device_t_s);
  const double before_s = exposure_s();
  device_t_s_ = frame.device_t_s;
  frame.wheels = has_frame_ ? between(before_s, exposure_s()) : WheelOdometry{};
  has_frame_ = true;
}

}  // namespace st
