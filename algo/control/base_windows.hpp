// A run cut into windows, each reduced to the sums that the base estimate needs
// (algo/control/base_estimate.hpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace st {

// The object's origin and yaw on the floor. Metres, radians (wrapped or not), seconds, in order of time.
struct PlanarSample {
  double t_s = 0, x_m = 0, y_m = 0, yaw_rad = 0;
};

// A stretch of the run, reduced to the sums that the fit needs. Memory for the estimate, owned by the caller.
struct BaseWindow {
  std::int64_t n = 0, samples = 0;  // points: means over blocks of samples
  double sum[3]{}, outer[3][3]{}, lag[3][3]{}, first[3]{}, last[3]{};
  double extent_m = 0, turn_rad = 0;
  double weight = 1;
  bool on_the_spot = false;
};

// Windows of half a metre of travel or a third of a turn, over all of the motion. Returns how many of
// `windows` it filled.
std::size_t fill_windows(std::span<const PlanarSample> samples, std::span<BaseWindow> windows);

// Windows over turns on the spot only: stretches where the point that stands still lies within `gate_m` of
// where the shape puts the turning centre, `left_m` to the left of the object's origin as seen along phi. A
// wider arc has it elsewhere.
struct SpotGate {
  double phi_rad = 0, left_m = 0, gate_m = 0;
};
std::size_t fill_spot_windows(std::span<const PlanarSample> samples, const SpotGate& gate,
                              std::span<BaseWindow> windows);

// Sum of the products of a's deviations from its mean.
void scatter(const BaseWindow& window, double (&C)[3][3]);
// Sum of the products of neighbouring deviations of u.a from its mean.
double lag_product(const BaseWindow& window, const double (&u)[3]);
// What white noise of variance one on the samples adds to the scatter of the window's points.
double point_noise(const BaseWindow& window);

// Noise from sample to sample, whatever the motion: from second differences.
struct Jitter {
  double position_m = 0, yaw_rad = 0;
};
Jitter jitter_of(std::span<const PlanarSample> samples);

}  // namespace st
