// Slopes of a depth image, shared by the kernels that need normals. Included once per target, inside of their
// namespaces.
#if defined(ST_VOLUME_SLOPE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ST_VOLUME_SLOPE_INL
#undef ST_VOLUME_SLOPE_INL
#else
#define ST_VOLUME_SLOPE_INL
#endif

#include <hwy/highway.h>

#include "algo/depth/edge_step.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace slope {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 8>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

// edge_step_m(). `scale`: coarse().
HWY_INLINE V gap_of(D d, V z, float scale) {
  return hn::Mul(hn::Set(d, scale), hn::Add(hn::Set(d, kEdgeStep_m),
                                            hn::Mul(hn::Set(d, kEdgeStepPerSquare_per_m), hn::Mul(z, z))));
}
// How much coarser a camera's pixels are than a Kinect's.
HWY_INLINE float coarse(float fx) { return fx < 575.0f ? 575.0f / fx : 1.0f; }

struct Slope {
  V value;  // metres of depth per pixel
  M known;  // some pixel two away lies on the same surface
};

// Along one image axis (element step `step`): least squares over the pairs of pixels at two and at `wide`
// pixels that lie on the same surface; at an outline from the side that does.
HWY_INLINE Slope along(D d, const float* p, int step, int wide, V z, V gap) {
  const V reach = hn::Mul(gap, hn::Set(d, 0.5f * static_cast<float>(wide)));
  const V after_2 = hn::LoadU(d, p + 2 * step), before_2 = hn::LoadU(d, p - 2 * step);
  const V after = hn::LoadU(d, p + wide * step), before = hn::LoadU(d, p - wide * step);
  const M has_after = hn::Lt(hn::AbsDiff(after_2, z), gap),
          has_before = hn::Lt(hn::AbsDiff(before_2, z), gap);
  const M inner = hn::And(has_after, has_before);
  const M outer =
      hn::And(inner, hn::And(hn::Lt(hn::AbsDiff(after, z), reach), hn::Lt(hn::AbsDiff(before, z), reach)));
  const float w = static_cast<float>(wide);
  const V inner_sum = hn::Mul(hn::Set(d, 2.0f), hn::Sub(after_2, before_2));
  const V both_sum = hn::Add(inner_sum, hn::Mul(hn::Set(d, w), hn::Sub(after, before)));
  const V both = hn::Mul(both_sum, hn::Set(d, 1.0f / (8.0f + 2.0f * w * w)));
  // With both sides a quarter of the whole difference, with one a half of its own.
  const V one_sided = hn::Add(hn::IfThenElseZero(has_after, hn::Sub(after_2, z)),
                              hn::IfThenElseZero(has_before, hn::Sub(z, before_2)));
  const V narrow = hn::Mul(one_sided, hn::IfThenElse(inner, hn::Set(d, 0.25f), hn::Set(d, 0.5f)));
  return {hn::IfThenElse(outer, both, narrow), hn::Or(has_after, has_before)};
}

// Normal towards the camera of P(u, v) = z ((u - cx) / fx, (v - cy) / fy, 1): its tangents crossed. (x, y,
// -z), not unit; n . P = -z^2.
struct Normal {
  V x, y, minus_z;
  V per_length;
};
HWY_INLINE Normal normal_of(D d, V du, V dv, float fx, float fy, V z, V su, V sv) {
  const V x = hn::Mul(hn::Set(d, fx), su), y = hn::Mul(hn::Set(d, fy), sv);
  const V minus_z = hn::Add(z, hn::Add(hn::Mul(du, su), hn::Mul(dv, sv)));
  const V square = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(minus_z, minus_z));
  return {x, y, minus_z, hn::Div(hn::Set(d, 1.0f), hn::Sqrt(hn::Max(square, hn::Set(d, 1e-12f))))};
}

}  // namespace slope
}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();
#endif
