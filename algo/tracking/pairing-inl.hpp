// Pairs of points and view pixels, a vector at a time, for the kernels of the residual terms. Included once
// per target, inside of their namespaces.
#if defined(ST_TRACKING_PAIRING_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ST_TRACKING_PAIRING_INL
#undef ST_TRACKING_PAIRING_INL
#else
#define ST_TRACKING_PAIRING_INL
#endif

#include <hwy/highway.h>

#include "algo/tracking/sums-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace pairing {
namespace hn = hwy::HWY_NAMESPACE;

using namespace sums;

// Word w of the records, as integers.
template <int w>
HWY_INLINE VI word(const Pairing& k, VI record) {
  const DI di;
  return hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(k.view) + w,
                         hn::Add(record, hn::Add(record, record)));
}
HWY_INLINE V low_half(D d, VI w) { return hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(w))); }
HWY_INLINE V high_half(D d, VI w) { return hn::ConvertTo(d, hn::ShiftRight<16>(w)); }

struct Pair {
  Vec p, q;  // the point in the camera's frame and in the view's
  V per_z;   // 1 / q.z; 0 for lanes that are off
  V u, v;    // the pixel it falls on, from the rectangle's first one
  V du, dv;  // from there to the exact place
  V z;       // of the view there
  VI record;
  M on;  // there is a surface
};

// Points first .. first + lanes; those from k.count on are off.
HWY_INLINE Pair pair_at(D d, const Pairing& k, int first) {
  const DI di;
  Pair o;
  o.p = {hn::LoadU(d, k.x + first), hn::LoadU(d, k.y + first), hn::LoadU(d, k.z + first)};
  o.q = moved(d, k.to_view, k.at, o.p);
  const M there =
      hn::And(hn::Gt(o.q.z, hn::Set(d, 0.1f)), hn::FirstN(d, static_cast<std::size_t>(k.count - first)));
  o.per_z = hn::IfThenElseZero(there, hn::Div(hn::Set(d, 1.0f), o.q.z));
  const V u = hn::MulAdd(hn::Mul(hn::Set(d, k.fx), o.q.x), o.per_z, hn::Set(d, k.cx));
  const V v = hn::MulAdd(hn::Mul(hn::Set(d, k.fy), o.q.y), o.per_z, hn::Set(d, k.cy));
  o.u = hn::Floor(hn::Add(u, hn::Set(d, 0.5f)));
  o.v = hn::Floor(hn::Add(v, hn::Set(d, 0.5f)));
  o.du = hn::Sub(u, o.u);
  o.dv = hn::Sub(v, o.v);
  const V zero = hn::Zero(d);
  const M across = hn::And(hn::Ge(o.u, zero), hn::Lt(o.u, hn::Set(d, static_cast<float>(k.width))));
  const M down = hn::And(hn::Ge(o.v, zero), hn::Lt(o.v, hn::Set(d, static_cast<float>(k.height))));
  const M inside = hn::And(there, hn::And(across, down));
  // Exact in float: an image has far fewer than 2^24 pixels.
  const V at = hn::Add(hn::MulAdd(o.v, hn::Set(d, static_cast<float>(k.width)), o.u), hn::Set(d, 1.0f));
  o.record = hn::ConvertTo(di, hn::IfThenElseZero(inside, at));
  o.z = hn::BitCast(d, word<0>(k, o.record));
  o.on = hn::Gt(o.z, zero);
  return o;
}

HWY_INLINE V from_pivot(D d, const Pairing& k, V coordinate, int axis) {
  return hn::Sub(coordinate, hn::Set(d, k.pivot[axis]));
}

// N = back * gradient and its moment about the pivot: the first six entries of the Jacobian.
HWY_INLINE void pose_jacobian(D d, const Pairing& k, const Pair& pair, const Vec& gradient, V* J) {
  const Vec N = turned(d, k.back, gradient);
  const Vec moment = crossed(
      {from_pivot(d, k, pair.p.x, 0), from_pivot(d, k, pair.p.y, 1), from_pivot(d, k, pair.p.z, 2)}, N);
  J[0] = N.x, J[1] = N.y, J[2] = N.z, J[3] = moment.x, J[4] = moment.y, J[5] = moment.z;
}

}  // namespace pairing
}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();
#endif
