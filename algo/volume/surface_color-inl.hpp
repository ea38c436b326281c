// Colour of the surface in a cell of the volume. Included once per target, inside of their namespaces.
#if defined(ST_VOLUME_SURFACE_COLOR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ST_VOLUME_SURFACE_COLOR_INL
#undef ST_VOLUME_SURFACE_COLOR_INL
#else
#define ST_VOLUME_SURFACE_COLOR_INL
#endif

#include <hwy/highway.h>

#include "algo/volume/field-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace march {
// Bilinear colour in the plane of the two axes that the surface runs along: across it colour does not change.
HWY_INLINE VU color_at(D d, const MarchKernel& k, const Field& f, M lanes) {
  const DI di;
  const DU du;
  const V ax = hn::Abs(f.gx), ay = hn::Abs(f.gy), az = hn::Abs(f.gz);
  const M across_x = hn::And(hn::Ge(ax, ay), hn::Ge(ax, az));
  const M across_y = hn::AndNot(across_x, hn::Ge(ay, az));
  const M across_z = hn::AndNot(hn::Or(across_x, across_y), lanes);
  const VI n = hn::Set(di, k.side), nn = hn::Set(di, k.side * k.side), one_i = hn::Set(di, 1);
  const auto far_half = [&](M across, V fraction, VI stride) HWY_ATTR {
    const M far = hn::And(across, hn::Ge(fraction, hn::Set(d, 0.5f)));
    return hn::IfThenElseZero(hn::RebindMask(di, far), stride);
  };
  const VI base = hn::IfThenElseZero(
      hn::RebindMask(di, lanes), hn::Add(hn::Add(f.cell, far_half(across_x, f.fx, one_i)),
                                         hn::Add(far_half(across_y, f.fy, n), far_half(across_z, f.fz, nn))));
  const V a = hn::IfThenElse(across_x, f.fy, f.fx), b = hn::IfThenElse(across_z, f.fy, f.fz);
  const VI step_a =
      hn::IfThenElseZero(hn::RebindMask(di, lanes), hn::IfThenElse(hn::RebindMask(di, across_x), n, one_i));
  const VI step_b =
      hn::IfThenElseZero(hn::RebindMask(di, lanes), hn::IfThenElse(hn::RebindMask(di, across_z), n, nn));
  const V one = hn::Set(d, 1.0f);
  V sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)}, known = hn::Zero(d);
  for (int i = 0; i < 4; ++i) {
    VI at = base;
    if ((i & 1) != 0) at = hn::Add(at, step_a);
    if ((i & 2) != 0) at = hn::Add(at, step_b);
    const VU c = hn::BitCast(du, hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(k.color), at));
    const V share = hn::Mul((i & 1) != 0 ? a : hn::Sub(one, a), (i & 2) != 0 ? b : hn::Sub(one, b));
    const M trusted = hn::RebindMask(d, hn::Ne(hn::ShiftRight<28>(c), hn::Zero(du)));
    const V w = hn::IfThenElseZero(trusted, share);
    known = hn::Add(known, w);
    for (int j = 0; j < 3; ++j) {
      const VU channel = hn::And(hn::ShiftRightSame(c, 8 * j), hn::Set(du, 255u));
      sum[j] = hn::Add(sum[j], hn::Mul(w, hn::ConvertTo(d, hn::BitCast(di, channel))));
    }
  }
  const V per_known = hn::Div(one, hn::Max(known, hn::Set(d, 0.01f)));
  VU word = hn::Set(du, 255u << 24);
  for (int j = 0; j < 3; ++j)
    word =
        hn::Or(word, hn::ShiftLeftSame(hn::BitCast(du, hn::NearestInt(hn::Mul(sum[j], per_known))), 8 * j));
  const M enough = hn::And(lanes, hn::Ge(known, hn::Set(d, 0.25f)));
  return hn::IfThenElseZero(hn::RebindMask(du, enough), word);
}

}  // namespace march
}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();
#endif
