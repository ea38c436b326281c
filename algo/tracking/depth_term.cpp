#include "algo/tracking/depth_term.hpp"

#include <cmath>

#include "algo/tracking/depth_kernel.hpp"

namespace st {

DepthTermResult add_depth_term(const PointTable& points, std::size_t count, const ViewTable& view,
                               const Pinhole& camera, const Pose& D, const Vec3& pivot,
                               const DepthTermOptions& options, NormalEquations& into) {
  DepthKernel k{};
  k.pairing = pairing_of(points, count, view, camera, D, pivot);
  k.gate2_m2 = options.gate_m * options.gate_m;
  k.robust2 = options.robust_sigmas * options.robust_sigmas;
  const float information = points.thinning(count) / options.correlated_pixels;
  k.information = information < 1.0f ? information : 1.0f;
  accumulate_depth(k);
  into.add_sums(k.triangle, k.gradient, NormalEquations::kPose);
  DepthTermResult result;
  result.tried = static_cast<int>(count);
  result.paired = k.paired;
  result.inliers = k.inliers;
  if (k.inliers > 0) result.rms_m = std::sqrt(k.square_sum / k.inliers);
  return result;
}

}  // namespace st
