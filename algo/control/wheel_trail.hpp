// From the wheels' reports and the camera's stamps to the base's motion between two exposures. Both sides are
// brought onto the host's clock: a report bears the time at which it came; an exposure is the camera's own
// clock plus the least delay with which its frames came, since USB only ever makes a stamp later.
#pragma once

#include <array>
#include <cstddef>

#include "algo/core/records.hpp"

namespace st {

// The camera's clock on the host's: t_host = t_device + offset. Follows a drift of the crystals.
class ExposureClock {
 public:
  // A frame's stamps, in order.
  void take(double host_t_s, double device_t_s);
  double host_s(double device_t_s) const { return device_t_s + offset_s_; }

 private:
  bool started_ = false;
  double offset_s_ = 0, last_device_t_s_ = 0;
};

class WheelTrail {
 public:
  // `lag_s`: by how much the camera's least delay, from exposure to stamp, is longer than that of the wheels'
  // reports; calibrated from a run. 0: not known.
  WheelTrail(double wheel_base_m, double lag_s) : wheel_base_m_(wheel_base_m), lag_s_(lag_s) {}

  // A report, in order of time.
  void add(const OdometrySample& sample);

  // Sets frame.wheels from the frame's own reports and those before: the motion since the frame that was
  // given last. Call it once for every processed frame. Not valid for the first frame, over a silence of the
  // wheels, and when the newest report is too old to tell of the exposure.
  void take(FrameInput& frame);

  // Between two times of the host's clock.
  WheelOdometry between(double from_s, double until_s) const;

  // When the frame that was taken last was exposed, in host seconds.
  double exposure_s() const { return clock_.host_s(device_t_s_) - lag_s_; }

 private:
  struct Mark {  // summed up from the start
    double t_s = 0, forward_m = 0, turn_rad = 0;
  };
  static constexpr std::size_t kMarks = 128;  // two seconds of a Create's stream

  const Mark& mark(std::size_t age) const { return marks_[(count_ - 1 - age) % kMarks]; }
  bool at(double t_s, Mark& out) const;

  double wheel_base_m_, lag_s_;
  std::array<Mark, kMarks> marks_{};
  std::size_t count_ = 0;  // ever added
  ExposureClock clock_;
  bool has_frame_ = false;
  double device_t_s_ = 0;  // of the frame that was taken last
};

}  // namespace st
