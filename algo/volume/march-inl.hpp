// From a pixel's ray to the surface that it meets: by marching, or at once from a guess of its depth.
// Included once per target, inside of their namespaces.
#if defined(ST_VOLUME_MARCH_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ST_VOLUME_MARCH_INL
#undef ST_VOLUME_MARCH_INL
#else
#define ST_VOLUME_MARCH_INL
#endif

#include <hwy/highway.h>

#include "algo/volume/field-inl.hpp"
#include "algo/volume/surface_color-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace march {
constexpr int kMostSteps = 512;
constexpr float kTrusting = 0.9f;     // of the distance that a sample promises to be free
constexpr float kUnseenStep = 0.75f;  // truncations: the band before a surface cannot be jumped over
constexpr float kLeastStep = 0.75f;   // voxels
constexpr float kSeedBand = 0.9f;     // truncations: beyond it a value says only that the surface is far

// A group of rays on their way to where the field turns from seen and positive to negative.
struct March {
  V z, step;
  V before;  // the last value in free space; negative: the last sample was none
  V after;   // the value behind the crossing; 0: not met
  M active;
};

HWY_INLINE March start(D d, V from, M lanes) {
  return {from, hn::Zero(d), hn::Set(d, -1.0f), hn::Zero(d), lanes};
}

HWY_INLINE void advance(D d, const MarchKernel& k, const Ray& r, V end, March& m) {
  const DI di;
  const V zero = hn::Zero(d);
  const VI stored = nearest_value(d, k, point_at(d, k, r, m.z), m.active);
  const M unseen = hn::RebindMask(d, hn::Eq(stored, hn::Set(di, kUnseen)));
  const V value = hn::Mul(hn::ConvertTo(d, stored), hn::Set(d, 1.0f / kTsdfScale));
  const M solid = hn::And(m.active, hn::AndNot(unseen, hn::Lt(value, zero)));
  m.after = hn::IfThenElse(hn::And(solid, hn::Ge(m.before, zero)), value, m.after);
  m.active = hn::AndNot(solid, m.active);  // solid without free space before it: the back of a surface
  const V promised =
      hn::Max(hn::Mul(value, hn::Set(d, kTrusting * k.truncation_voxels)), hn::Set(d, kLeastStep));
  const V voxels = hn::IfThenElse(unseen, hn::Set(d, kUnseenStep * k.truncation_voxels), promised);
  m.step = hn::IfThenElse(m.active, hn::Mul(voxels, r.metres_per_voxel), m.step);
  m.before = hn::IfThenElse(m.active, hn::IfThenElse(unseen, hn::Set(d, -1.0f), value), m.before);
  m.z = hn::IfThenElse(m.active, hn::Add(m.z, m.step), m.z);
  m.active = hn::And(m.active, hn::Lt(m.z, end));
}

// Between the last two samples by their values.
HWY_INLINE V crossing(D d, const March& m) {
  const V share = hn::Div(m.before, hn::Max(hn::Sub(m.before, m.after), hn::Set(d, 1e-6f)));
  return hn::Sub(m.z, hn::Mul(m.step, hn::Sub(hn::Set(d, 1.0f), share)));
}

// Surface that rays met: depth, weight of the nearest voxel (0: none) and colour.
struct Hit {
  V z;
  VU weight, color;
};
HWY_INLINE Hit no_hit(D d) {
  const DU du;
  return {hn::Zero(d), hn::Zero(du), hn::Zero(du)};
}

// From a first guess z0, no more than two voxels off, to the surface.
HWY_INLINE Hit refine(D d, const MarchKernel& k, const Ray& ray, Field f, V z0, M found) {
  const DI di;
  const DU du;
  Hit hit = no_hit(d);
  const V z1 = newton(d, f, ray, z0, hn::Mul(hn::Set(d, 2.0f), ray.metres_per_voxel));
  f = moved_to(d, k, point_at(d, k, ray, z1), f);
  const VI nearest = hn::Add(f.cell, hn::ConvertTo(di, hn::Add(f.fx, hn::Set(d, 0.5f))));
  const VI safe = hn::IfThenElseZero(hn::RebindMask(di, f.valid), nearest);
  const VU four =
      hn::BitCast(du, hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(k.weight), safe));
  const M on = hn::And(found, f.valid);
  hit.weight = hn::IfThenElseZero(hn::RebindMask(du, on), hn::And(four, hn::Set(du, 255u)));
  const M met = hn::RebindMask(d, hn::Ne(hit.weight, hn::Zero(du)));
  hit.z = hn::IfThenElseZero(met, z1);
  if (k.color != nullptr) hit.color = color_at(d, k, f, met);
  return hit;
}

// Without a march, where a guess of the depth lies within the surface's band already: its value says how far
// the surface is, and the gradient there that it is the front of one.
HWY_INLINE Hit from_seed(D d, const MarchKernel& k, const Ray& ray, V seed, M lanes) {
  const M has = hn::And(lanes, hn::Gt(seed, hn::Zero(d)));
  const VI stored = nearest_value(d, k, point_at(d, k, ray, seed), has);
  const V value = hn::Mul(hn::ConvertTo(d, stored), hn::Set(d, 1.0f / kTsdfScale));
  const M in_band = hn::And(has, hn::Lt(hn::Abs(value), hn::Set(d, kSeedBand)));
  if (hn::AllFalse(d, in_band)) return no_hit(d);
  const V ahead = hn::Mul(hn::Mul(value, hn::Set(d, k.truncation_voxels)), ray.metres_per_voxel);
  const V z0 = hn::Add(seed, hn::IfThenElseZero(in_band, ahead));
  const Field f = field_at(d, k, point_at(d, k, ray, z0), in_band);
  const V along = hn::Add(hn::Add(hn::Mul(f.gx, ray.x), hn::Mul(f.gy, ray.y)), hn::Mul(f.gz, ray.z));
  // Within a voxel of the zero level by the slope there, which has to fall.
  const M near = hn::Le(hn::Abs(f.value), hn::Mul(hn::Neg(along), ray.metres_per_voxel));
  return refine(d, k, ray, f, z0, hn::And(in_band, hn::And(f.valid, near)));
}

HWY_INLINE Hit from_march(D d, const MarchKernel& k, const Ray& ray, const March& m) {
  const M found = hn::Lt(m.after, hn::Zero(d));
  if (hn::AllFalse(d, found)) return no_hit(d);
  const V z0 = crossing(d, m);
  return refine(d, k, ray, field_at(d, k, point_at(d, k, ray, z0), found), z0, found);
}

}  // namespace march
}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();
#endif
