// Analytic trajectories of a differential-drive base, and how a tracker would see an object on it.
#pragma once

#include <random>
#include <vector>

#include "algo/control/base_estimate.hpp"
#include "algo/core/pose.hpp"
#include "algo/core/scalar_math.hpp"

namespace st {

struct BaseSampleTruth {
  double t_s = 0;
  Pose2 pose;
};

// Drives with piecewise constant speeds, sampled at 30 Hz.
class MotionScript {
 public:
  explicit MotionScript(Pose2 start = {}) : pose_(start) { out_.push_back({0, pose_}); }

  MotionScript& drive(double v_mps, double w_rps, double seconds) {
    constexpr double kRateHz = 30.0;
    constexpr int kSubsteps = 20;
    const int frames = static_cast<int>(seconds * kRateHz + 0.5);
    const double dt = 1.0 / (kRateHz * kSubsteps);
    for (int i = 0; i < frames; ++i) {
      for (int k = 0; k < kSubsteps; ++k) {
        const SinCos h = sin_cos(pose_.yaw + 0.5 * w_rps * dt);
        pose_ = {pose_.x + h.cos * v_mps * dt, pose_.y + h.sin * v_mps * dt, pose_.yaw + w_rps * dt};
      }
      out_.push_back({out_.back().t_s + 1.0 / kRateHz, pose_});
    }
    return *this;
  }
  const std::vector<BaseSampleTruth>& samples() const { return out_; }

 private:
  Pose2 pose_;
  std::vector<BaseSampleTruth> out_;
};

// The object whose base stands at `base` in its frame, with white noise on its pose.
inline std::vector<PlanarSample> seen_object(const std::vector<BaseSampleTruth>& truth, const Pose2& base,
                                             double sigma_m, double sigma_rad, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<PlanarSample> seen;
  for (const BaseSampleTruth& sample : truth) {
    const Pose2 object = compose(sample.pose, inverse(base));
    seen.push_back({sample.t_s, object.x + sigma_m * normal(random), object.y + sigma_m * normal(random),
                    wrap_angle(object.yaw + sigma_rad * normal(random))});
  }
  return seen;
}

}  // namespace st
