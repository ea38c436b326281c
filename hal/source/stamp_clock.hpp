// The stamps of one stream: is a frame newer than the one before, and when was it on the device's clock?
// The Kinect counts 60 MHz ticks in 32 bits, which wrap every 71.58 s; host stamps jitter by up to 20 ms but
// never wrap. The wrap is found by the difference in 32 bits, and over gaps longer than half a wrap by the
// host stamps.
#pragma once

#include <cstdint>

namespace st {

inline constexpr double kKinectTicksPerSecond = 60e6;

class StampClock {
 public:
  // True when the frame is newer than the last good one by both stamps and the two agree to kTolerance_s;
  // then device_t_s() is its time. A stream whose counter restarted is taken up again after kRestartFrames
  // frames that agree among themselves; single bad stamps are only refused.
  bool accept(double host_s, std::uint32_t ticks);

  double host_s() const { return last_.host_s; }
  std::uint32_t ticks() const { return last_.ticks; }
  // Unwrapped: starts at the first frame's ticks / 60e6, so that llround(device_t_s * 60e6) gives the ticks
  // back (mod 2^32) as long as the counter did not restart.
  double device_t_s() const { return static_cast<double>(device_ticks_) / kKinectTicksPerSecond; }

  // Time on this stream's device clock of another stream's stamp from the same device.
  double device_time_of(double host_s, std::uint32_t ticks) const;

 private:
  static constexpr double kTolerance_s = 2.0;
  static constexpr int kRestartFrames = 30;

  struct Stamp {
    double host_s = 0;
    std::uint32_t ticks = 0;
  };
  // Ticks from a to b: the residue of the 32-bit difference nearest to what the host stamps say.
  static std::int64_t ticks_between(const Stamp& a, const Stamp& b);
  static bool follows(const Stamp& a, const Stamp& b, std::int64_t& elapsed_ticks);
  bool restarted(const Stamp& now);

  bool started_ = false;
  Stamp last_{};
  std::int64_t device_ticks_ = 0;
  Stamp refused_{};
  int refused_in_a_row_ = 0;
};

}  // namespace st
