#include "hal/create/sim/odometer.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "hal/sim/random.hpp"

namespace st::sim {

Odometer::Odometer(const RobotGeometry& geometry, std::uint64_t seed, bool keeps_fraction)
    : geometry_(geometry), keeps_fraction_(keeps_fraction) {
  // Close before the wrap and before the sign change, so that every drive of a few metres passes both.
  Random random(seed, 0xe2c0);
  counts_[0] = static_cast<std::uint16_t>(65536 - 200 - random.below(400));
  counts_[1] = static_cast<std::uint16_t>(32768 - 200 - random.below(400));
}

void Odometer::advance(const double wheel_mps[2], const double commanded_mps[2], double dt_s) {
  const double metres_per_count = kPi * geometry_.wheel_diameter_m / geometry_.counts_per_turn;
  double travel_m[2] = {0, 0};
  for (int i = 0; i < 2; ++i) {
    // Counts come from the edges of a slotted wheel: where it truly turns back, the edge it passed last is
    // the next one.
    if (wheel_mps[i] * turned_mps_[i] < 0) fraction_[i] = 1 - fraction_[i];
    if (wheel_mps[i] != 0) turned_mps_[i] = wheel_mps[i];
    if (commanded_mps[i] != 0)
      direction_[i] = commanded_mps[i] > 0 ? 1 : -1;
    else if (wheel_mps[i] == 0)
      direction_[i] = 1;  // pushed from rest: counts up, whichever way
    fraction_[i] += std::fabs(wheel_mps[i]) * dt_s / metres_per_count;
    const double whole = std::floor(fraction_[i]);
    fraction_[i] -= whole;
    const int counted = direction_[i] * static_cast<int>(whole);
    counts_[i] = static_cast<std::uint16_t>(counts_[i] + counted);
    travel_m[i] = counted * metres_per_count;
  }
  distance_mm_ += 500.0 * (travel_m[0] + travel_m[1]);
  angle_deg_ += (travel_m[1] - travel_m[0]) / geometry_.wheel_base_m * 180.0 / kPi;
}

int Odometer::read(double& sum) const {
  const double whole = std::clamp(std::trunc(sum), -32768.0, 32767.0);
  sum = keeps_fraction_ ? sum - whole : 0.0;
  return static_cast<int>(whole);
}

}  // namespace st::sim
