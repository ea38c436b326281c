// Normals of a view from its depth image. Included once per target, inside of their namespaces.
#if defined(ST_VOLUME_SHADE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ST_VOLUME_SHADE_INL
#undef ST_VOLUME_SHADE_INL
#else
#define ST_VOLUME_SHADE_INL
#endif

#include <hwy/highway.h>

#include "algo/volume/field-inl.hpp"
#include "algo/volume/raycast.hpp"
#include "algo/volume/slope-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace march {
// Normals from the finished depth image: over some pixels, where the gradient within one cell of a young
// model is mostly noise (four to seven times the angle). A pixel that has no neighbour on its surface is a
// speck, and taken out.
HWY_INLINE void shade(D d, MarchKernel& k, const float* p, int u, int v, std::size_t at) {
  const DU du;
  const V z = hn::LoadU(d, p);
  const M has = hn::Gt(z, hn::Zero(d));
  M shown = has;
  VU normal = hn::Zero(du);
  if (!hn::AllFalse(d, has)) {
    const V gap = slope::gap_of(d, z, slope::coarse(k.fx));
    slope::Slope su = slope::along(d, p, 1, k.normal_reach, z, gap);
    slope::Slope sv = slope::along(d, p, k.padded_stride, k.normal_reach, z, gap);
    if (k.young_reach > k.normal_reach) {
      const VU weight = hn::PromoteTo(du, hn::LoadU(D8(), k.out_weight + at));
      const M young = hn::And(has, hn::RebindMask(d, hn::Lt(weight, hn::Set(du, k.young_weight))));
      if (!hn::AllFalse(d, young)) {
        const V wide_u = slope::along(d, p, 1, k.young_reach, z, gap).value;
        const V wide_v = slope::along(d, p, k.padded_stride, k.young_reach, z, gap).value;
        su.value = hn::IfThenElse(young, wide_u, su.value);
        sv.value = hn::IfThenElse(young, wide_v, sv.value);
      }
    }
    const V du_px = hn::Sub(hn::Iota(d, static_cast<float>(u)), hn::Set(d, k.cx));
    const V dv_px = hn::Set(d, static_cast<float>(v) - k.cy);
    const slope::Normal n = slope::normal_of(d, du_px, dv_px, k.fx, k.fy, z, su.value, sv.value);
    const V scale = hn::Mul(n.per_length, hn::Set(d, kNormalScale));
    const VU x = hn::BitCast(du, hn::NearestInt(hn::Mul(n.x, scale))),
             y = hn::BitCast(du, hn::NearestInt(hn::Mul(n.y, scale)));
    shown = hn::And(hn::And(has, hn::Gt(n.minus_z, hn::Zero(d))), hn::And(su.known, sv.known));
    normal = hn::IfThenElseZero(hn::RebindMask(du, shown),
                                hn::Or(hn::And(x, hn::Set(du, 0xffffu)), hn::ShiftLeft<16>(y)));
    k.hits += static_cast<int>(hn::CountTrue(d, shown));
  }
  hn::StoreU(hn::IfThenElseZero(shown, z), d, k.z + at);
  hn::StoreU(normal, du, k.normal + at);
}

}  // namespace march
}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();
#endif
