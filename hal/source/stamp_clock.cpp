#include "hal/source/stamp_clock.hpp"

#include <cmath>

namespace st {
namespace {

constexpr double kWrapTicks = 4294967296.0;

}  // namespace

std::int64_t StampClock::ticks_between(const Stamp& a, const Stamp& b) {
  const auto residue = static_cast<double>(b.ticks - a.ticks);
  const double expected = (b.host_s - a.host_s) * kKinectTicksPerSecond;
  const double wraps = std::nearbyint((expected - residue) / kWrapTicks);
  return static_cast<std::int64_t>(residue + wraps * kWrapTicks);
}

bool StampClock::follows(const Stamp& a, const Stamp& b, std::int64_t& elapsed_ticks) {
  if (!(b.host_s > a.host_s)) return false;
  const double host_elapsed_s = b.host_s - a.host_s;
  if (host_elapsed_s > 1e9) return false;
  elapsed_ticks = ticks_between(a, b);
  if (elapsed_ticks <= 0) return false;
  const double off_s = static_cast<double>(elapsed_ticks) / kKinectTicksPerSecond - host_elapsed_s;
  return std::fabs(off_s) < kTolerance_s + 1e-3 * host_elapsed_s;
}

bool StampClock::accept(double host_s, std::uint32_t ticks) {
  const Stamp now{host_s, ticks};
  std::int64_t elapsed = 0;
  if (!started_) {
    started_ = true;
    device_ticks_ = ticks;
  } else if (follows(last_, now, elapsed)) {
    device_ticks_ += elapsed;
  } else if (host_s > last_.host_s && restarted(now)) {
    device_ticks_ += std::llround((host_s - last_.host_s) * kKinectTicksPerSecond);
  } else {
    return false;
  }
  last_ = now;
  refused_in_a_row_ = 0;
  return true;
}

bool StampClock::restarted(const Stamp& now) {
  std::int64_t elapsed = 0;
  const bool chained = refused_in_a_row_ > 0 && follows(refused_, now, elapsed);
  refused_in_a_row_ = chained ? refused_in_a_row_ + 1 : 1;
  refused_ = now;
  return refused_in_a_row_ > kRestartFrames;
}

double StampClock::device_time_of(double host_s, std::uint32_t ticks) const {
  return static_cast<double>(device_ticks_ + ticks_between(last_, {host_s, ticks})) / kKinectTicksPerSecond;
}

}  // namespace st
