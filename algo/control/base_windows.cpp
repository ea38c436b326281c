#include "algo/control/base_windows.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "algo/control/wheel_motion.hpp"
#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr double kLongestGapS = 0.25;  // a longer one may hide a carried object
constexpr double kWindowExtentM = 0.5, kWindowTurnRad = 2.0, kWindowS = 20.0;
constexpr double kLeastExtentM = 0.05, kLeastTurnRad = 0.2;
constexpr std::int64_t kLeastPoints = 4;
constexpr double kBlockS = 0.24;

double squared(double v) { return v * v; }

struct Motion {
  double a[3] = {0, 0, 0};  // ax, ay, s

  // Adds the arc from p to q, the angle in the measure that makes the chord exact.
  void add(const PlanarSample& p, const PlanarSample& q) {
    BodyMotion step;
    step.add({p.x_m, p.y_m, p.yaw_rad}, {q.x_m, q.y_m, q.yaw_rad});
    a[0] += step.x_m;
    a[1] += step.y_m;
    a[2] += 2.0 * sin_cos(0.5 * step.turn_rad).sin;
  }
};

// Gathers samples into windows.
class WindowFiller {
 public:
  explicit WindowFiller(std::span<BaseWindow> windows) : windows_(windows) {}

  void start(const PlanarSample& sample) {
    current_ = {};
    motion_ = {};
    block_ = {};
    start_t_s_ = sample.t_s;

    add_sample(sample.t_s);
  }
  void move(const PlanarSample& from, const PlanarSample& to) {
    motion_.add(from, to);
    add_sample(to.t_s);
  }
  double extent_m() const { return std::sqrt(squared(high_[0] - low_[0]) + squared(high_[1] - low_[1])); }
  double turn_rad() const { return high_[2] - low_[2]; }
  double duration_s(const PlanarSample& now) const { return now.t_s - start_t_s_; }

  // Keeps the current window when it holds motion worth having.
  void finish(double least_extent_m, double least_turn_rad, bool on_the_spot) {
    close_block();
    const bool worth =
        current_.n >= kLeastPoints && (extent_m() >= least_extent_m || turn_rad() >= least_turn_rad);
    if (worth && used_ < windows_.size()) {
      current_.extent_m = extent_m();
      current_.turn_rad = turn_rad();
      current_.on_the_spot = on_the_spot;
      windows_[used_++] = current_;
    }
    current_ = {};
  }
  std::size_t used() const { return used_; }

 private:
  // Means over short blocks: the noise of the yaw, squared in the sums, pulls c and l towards zero (errors in
  // variables) and a mean has less of it; and what noise there is, is less alike from one point to the next.
  void add_sample(double t_s) {
    if (block_.n > 0 && t_s - block_.start_t_s > kBlockS) close_block();
    if (block_.n == 0) block_.start_t_s = t_s;
    for (int i = 0; i < 3; ++i) block_.sum[i] += motion_.a[i];
    ++block_.n;
  }
  void close_block() {
    if (block_.n == 0) return;
    const double n = static_cast<double>(block_.n);
    add_point({block_.sum[0] / n, block_.sum[1] / n, block_.sum[2] / n});
    current_.samples += block_.n;
    block_ = {};
  }
  void add_point(const std::array<double, 3>& a) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (current_.n == 0) low_[i] = high_[i] = a[i];
      if (current_.n == 0) current_.first[i] = a[i];
      low_[i] = std::min(low_[i], a[i]);
      high_[i] = std::max(high_[i], a[i]);
      current_.sum[i] += a[i];
      for (std::size_t k = 0; k < 3; ++k) {
        current_.outer[i][k] += a[i] * a[k];
        if (current_.n > 0) current_.lag[i][k] += current_.last[i] * a[k];
      }
    }
    for (std::size_t i = 0; i < 3; ++i) current_.last[i] = a[i];
    ++current_.n;
  }

  std::span<BaseWindow> windows_;
  std::size_t used_ = 0;
  BaseWindow current_;
  Motion motion_;
  struct {
    double start_t_s = 0, sum[3] = {0, 0, 0};
    std::int64_t n = 0;
  } block_;
  double start_t_s_ = 0, low_[3]{}, high_[3]{};
};

bool broken(const PlanarSample& p, const PlanarSample& q) {
  return !(q.t_s > p.t_s) || q.t_s - p.t_s > kLongestGapS;
}

}  // namespace

std::size_t fill_windows(std::span<const PlanarSample> samples, std::span<BaseWindow> windows) {
  WindowFiller filler(windows);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool fresh = i == 0 || broken(samples[i - 1], samples[i]);
    const bool full = filler.extent_m() >= kWindowExtentM || filler.turn_rad() >= kWindowTurnRad ||
                      filler.duration_s(samples[i]) >= kWindowS;
    if (fresh || full) {
      if (i > 0) filler.finish(kLeastExtentM, kLeastTurnRad, false);
      filler.start(samples[fresh ? i : i - 1]);
      if (fresh) continue;
    }
    filler.move(samples[i - 1], samples[i]);
  }
  filler.finish(kLeastExtentM, kLeastTurnRad, false);
  return filler.used();
}

std::size_t fill_spot_windows(std::span<const PlanarSample> samples, const SpotGate& gate,
                              std::span<BaseWindow> windows) {
  WindowFiller filler(windows);
  constexpr double kHalfS = 0.2, kLeastStepRad = 0.1, kLeastSpotTurnRad = 0.5;
  const SinCos f = sin_cos(gate.phi_rad);
  const auto on_the_spot = [&](std::size_t i) {
    Motion motion;
    for (std::size_t k = i; k > 0 && samples[i].t_s - samples[k - 1].t_s <= kHalfS; --k)
      motion.add(samples[k - 1], samples[k]);
    for (std::size_t k = i; k + 1 < samples.size() && samples[k + 1].t_s - samples[i].t_s <= kHalfS; ++k)
      motion.add(samples[k], samples[k + 1]);
    const double forward = f.cos * motion.a[0] + f.sin * motion.a[1];
    return std::fabs(motion.a[2]) >= kLeastStepRad &&
           std::fabs(forward - gate.left_m * motion.a[2]) <= gate.gate_m * std::fabs(motion.a[2]);
  };
  bool inside = false;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const bool spot = on_the_spot(i) && (i == 0 || !inside || !broken(samples[i - 1], samples[i]));
    if (spot && inside) filler.move(samples[i - 1], samples[i]);
    if (spot && !inside) filler.start(samples[i]);
    if (!spot && inside) filler.finish(1e9, kLeastSpotTurnRad, true);
    inside = spot;
  }
  if (inside) filler.finish(1e9, kLeastSpotTurnRad, true);
  return filler.used();
}

void scatter(const BaseWindow& w, double (&C)[3][3]) {
  const double n = static_cast<double>(w.n);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) C[i][k] = w.outer[i][k] - w.sum[i] * w.sum[k] / n;
}

double lag_product(const BaseWindow& w, const double (&u)[3]) {
  double raw = 0, mean = 0, first = 0, last = 0;
  for (int i = 0; i < 3; ++i) {
    mean += u[i] * w.sum[i] / static_cast<double>(w.n);
    first += u[i] * w.first[i];
    last += u[i] * w.last[i];
    for (int k = 0; k < 3; ++k) raw += u[i] * w.lag[i][k] * u[k];
  }
  const double total = mean * static_cast<double>(w.n);
  return raw - mean * ((total - first) + (total - last)) + static_cast<double>(w.n - 1) * mean * mean;
}

double point_noise(const BaseWindow& window) {
  return static_cast<double>(window.n - 1) * static_cast<double>(window.n) /
         static_cast<double>(window.samples);
}

Jitter jitter_of(std::span<const PlanarSample> samples) {
  constexpr double kClipM = 0.02, kClipRad = 0.1;
  double sum = 0, yaw_sum = 0;
  std::int64_t count = 0;
  for (std::size_t i = 2; i < samples.size(); ++i) {
    if (broken(samples[i - 2], samples[i - 1]) || broken(samples[i - 1], samples[i])) continue;
    const double dx = samples[i].x_m - 2 * samples[i - 1].x_m + samples[i - 2].x_m;
    const double dy = samples[i].y_m - 2 * samples[i - 1].y_m + samples[i - 2].y_m;
    sum += std::min(dx * dx, kClipM * kClipM) + std::min(dy * dy, kClipM * kClipM);
    const double turn = wrap_angle(wrap_angle(samples[i].yaw_rad - samples[i - 1].yaw_rad) -
                                   wrap_angle(samples[i - 1].yaw_rad - samples[i - 2].yaw_rad));
    yaw_sum += std::min(turn * turn, kClipRad * kClipRad);
    ++count;
  }
  if (count == 0) return {};
  const double n = 6.0 * static_cast<double>(count);
  return {std::sqrt(0.5 * sum / n), std::sqrt(yaw_sum / n)};
}

}  // namespace st
