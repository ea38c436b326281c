#include "algo/tracking/align_beside.hpp"

namespace st {
namespace {

constexpr int kSteps = 3;                      // to each side
constexpr int kTryStride = 2, kTryLevels = 2;  // enough to tell them apart
constexpr float kBetter = 0.8f;                // of the residuals of a heading that is worth a change

}  // namespace

double look_score(const AlignResult& result) {
  if (!result.solved || result.depth.tried == 0) return 0;
  const double explained = static_cast<double>(result.depth.inliers) / result.depth.tried;
  const double sigma = result.color.sigma;
  return explained / (1.0 + sigma * sigma / 400.0);
}

bool align_beside(const AlignInput& in, const Habit& habit, const Vec3& up, AlignScratch& scratch,
                  AlignResult& result, Mat3& turn) {
  if (!result.solved || !habit.wondered_at_by_color(result)) return false;
  AlignInput best = in;
  float least = kBetter * result.color.sigma;
  bool found = false;
  for (int i = -kSteps; i <= kSteps; ++i) {
    if (i == 0) continue;
    AlignInput other = in;
    other.prior.mean.R = rotation_from_vector(up * (i * kBesideReach_rad / kSteps)) * in.prior.mean.R;
    other.start = other.prior.mean;
    other.heading.on = false;
    other.point_stride = kTryStride;
    other.levels = kTryLevels;
    const AlignResult tried = align_again(other, scratch);
    if (!tried.solved || tried.color.used < kLeastColored || tried.color.sigma >= least) continue;
    least = tried.color.sigma;
    best = other;
    found = true;
  }
  if (!found) return false;
  best.point_stride = in.point_stride;
  best.levels = in.levels;
  const AlignResult beside = align_again(best, scratch);
  if (look_score(beside) <= look_score(result) || habit.wondered_at_by_color(beside)) return false;
  const Mat3 all = beside.T_camera_object.R * in.prior.mean.R.transposed();
  turn = rotation_from_vector(up * dot(rotation_to_vector(all), up));
  result = beside;
  return true;
}

}  // namespace st
