#include "algo/tracking/depth_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/tracking/depth_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "algo/tracking/pairing-inl.hpp"
#include "algo/tracking/point_plane-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace pairing;

// Vector from the model's vertex to the point, in the view's frame.
HWY_INLINE Vec gap_to_model(D d, const Pairing& k, const Pair& pair) {
  const V x = hn::Mul(hn::Mul(hn::Sub(pair.u, hn::Set(d, k.cx)), hn::Set(d, 1.0f / k.fx)), pair.z);
  const V y = hn::Mul(hn::Mul(hn::Sub(pair.v, hn::Set(d, k.cy)), hn::Set(d, 1.0f / k.fy)), pair.z);
  return {hn::Sub(pair.q.x, x), hn::Sub(pair.q.y, y), hn::Sub(pair.q.z, pair.z)};
}

void depth_sums(DepthKernel& work) {
  const D d;
  const Pairing& k = work.pairing;
  const V per_scale = hn::Set(d, 1.0f / kNormalScale), half_pixel = hn::Set(d, 0.5f / k.fx);
  const int lanes = static_cast<int>(hn::Lanes(d));
  Sums<6> sums;
  sums.clear(d);
  for (int start = 0; start < k.count; start += kBlock) {
    V square = hn::Zero(d);
    const int end = start + kBlock < k.count ? start + kBlock : k.count;
    for (int i = start; i < end; i += lanes) {
      const Pair pair = pair_at(d, k, i);
      const Vec gap = gap_to_model(d, k, pair);
      const V distance2 = hn::MulAdd(gap.x, gap.x, hn::MulAdd(gap.y, gap.y, hn::Mul(gap.z, gap.z)));
      const V sigma = point_plane::axial_sigma(d, pair.q.z);
      const M on = hn::And(pair.on, point_plane::in_reach(d, distance2, sigma, work.gate2_m2));
      if (hn::AllFalse(d, on)) continue;
      work.paired += static_cast<int>(hn::CountTrue(d, on));

      const VI xy = word<1>(k, pair.record);
      const Vec n{hn::Mul(low_half(d, xy), per_scale), hn::Mul(high_half(d, xy), per_scale),
                  hn::Mul(low_half(d, word<2>(k, pair.record)), per_scale)};
      const V r = hn::IfThenElseZero(on, hn::MulAdd(n.x, gap.x, hn::MulAdd(n.y, gap.y, hn::Mul(n.z, gap.z))));
      const auto weighed = point_plane::weigh(d, r, n.z, pair.q.z, sigma, half_pixel, work.robust2, on);
      work.inliers += static_cast<int>(hn::CountTrue(d, weighed.inlier));
      square = hn::Add(square, hn::IfThenElseZero(weighed.inlier, weighed.r2));
      const V w =
          hn::IfThenElseZero(on, hn::Mul(hn::Mul(weighed.keep, weighed.keep),
                                         hn::Mul(weighed.per_variance, hn::Set(d, work.information))));
      V J[6];
      pose_jacobian(d, k, pair, n, J);  // the object moves, the point stands: J is minus this, as is r here
      sums.add(J, hn::Neg(r), w);
    }
    work.square_sum += sum(d, square);
    sums.empty_into(d, work.triangle, work.gradient);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(depth_sums);

void accumulate_depth(DepthKernel& work) { HWY_DYNAMIC_DISPATCH(depth_sums)(work); }

}  // namespace st
#endif
