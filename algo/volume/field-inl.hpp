// A volume's distance field along rays: values, gradients and Newton steps, a vector of rays at a time.
// Included once per target, inside of their namespaces.
#if defined(ST_VOLUME_FIELD_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ST_VOLUME_FIELD_INL
#undef ST_VOLUME_FIELD_INL
#else
#define ST_VOLUME_FIELD_INL
#endif

#include <hwy/highway.h>

#include "algo/volume/march_kernel.hpp"
#include "algo/volume/voxel.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace march {
namespace hn = hwy::HWY_NAMESPACE;

// Eight neighbouring pixels are one vector. No fused multiply-add: every target gives the same bits.
using D = hn::CappedTag<float, 8>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using D8 = hn::Rebind<std::uint8_t, D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;
using M = hn::Mask<D>;

struct Ray {
  V x, y, z;           // direction in voxels per metre of depth
  V metres_per_voxel;  // of depth, along the ray
};
struct Point {
  V x, y, z;
};

HWY_INLINE Point point_at(D d, const MarchKernel& k, const Ray& r, V z) {
  return {hn::Add(hn::Set(d, k.eye[0]), hn::Mul(r.x, z)), hn::Add(hn::Set(d, k.eye[1]), hn::Mul(r.y, z)),
          hn::Add(hn::Set(d, k.eye[2]), hn::Mul(r.z, z))};
}

HWY_INLINE Ray ray_of(D d, const MarchKernel& k, int u, int v) {
  const V x = hn::Mul(hn::Sub(hn::Iota(d, static_cast<float>(u)), hn::Set(d, k.cx)), hn::Set(d, k.per_fx));
  const float y = (static_cast<float>(v) - k.cy) * k.per_fy;
  V a[3];
  for (int i = 0; i < 3; ++i)
    a[i] = hn::Add(hn::Mul(hn::Set(d, k.to_voxels[3 * i]), x),
                   hn::Set(d, k.to_voxels[3 * i + 1] * y + k.to_voxels[3 * i + 2]));
  const V square = hn::Add(hn::Add(hn::Mul(a[0], a[0]), hn::Mul(a[1], a[1])), hn::Mul(a[2], a[2]));
  return {a[0], a[1], a[2], hn::Div(hn::Set(d, 1.0f), hn::Sqrt(square))};
}

// Where 0 <= p < limit in all three axes; false for NaN.
HWY_INLINE M within(D d, const Point& p, float limit) {
  const V zero = hn::Zero(d), end = hn::Set(d, limit);
  const M x = hn::And(hn::Ge(p.x, zero), hn::Lt(p.x, end)), y = hn::And(hn::Ge(p.y, zero), hn::Lt(p.y, end));
  return hn::And(hn::And(x, y), hn::And(hn::Ge(p.z, zero), hn::Lt(p.z, end)));
}

HWY_INLINE VI index_of(const MarchKernel& k, VI x, VI y, VI z) {
  const DI di;
  const VI n = hn::Set(di, k.side);
  return hn::Add(hn::Mul(hn::Add(hn::Mul(z, n), y), n), x);
}

// The stored values at index and index + 1, in the low and high halves.
HWY_INLINE VI pair_at(const MarchKernel& k, VI index) {
  const DI di;
  return hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(k.tsdf), hn::ShiftLeft<1>(index));
}

// Nearest voxel's value in units of the truncation; kUnseen outside of the volume and for lanes that are off.
HWY_INLINE VI nearest_value(D d, const MarchKernel& k, const Point& p, M lanes) {
  const DI di;
  const V half = hn::Set(d, 0.5f);
  const Point q{hn::Add(p.x, half), hn::Add(p.y, half), hn::Add(p.z, half)};
  const M in = hn::And(lanes, within(d, q, static_cast<float>(k.side)));
  const VI x = hn::ConvertTo(di, hn::IfThenElseZero(in, q.x)),
           y = hn::ConvertTo(di, hn::IfThenElseZero(in, q.y)),
           z = hn::ConvertTo(di, hn::IfThenElseZero(in, q.z));
  const VI low = hn::ShiftRight<16>(hn::ShiftLeft<16>(pair_at(k, index_of(k, x, y, z))));
  return hn::IfThenElse(hn::RebindMask(di, in), low, hn::Set(di, kUnseen));
}

struct Field {
  V value;       // in truncations
  V gx, gy, gz;  // per voxel
  M valid;
  VI cell;       // index of the cell's first voxel
  V fx, fy, fz;  // place within the cell
};

// Trilinear value and its gradient.
HWY_INLINE Field field_at(D d, const MarchKernel& k, const Point& p, M lanes) {
  const DI di;
  Field f;
  const M in = hn::And(lanes, within(d, p, static_cast<float>(k.side - 1)));
  const VI x = hn::ConvertTo(di, hn::IfThenElseZero(in, p.x)),
           y = hn::ConvertTo(di, hn::IfThenElseZero(in, p.y)),
           z = hn::ConvertTo(di, hn::IfThenElseZero(in, p.z));
  f.fx = hn::Sub(p.x, hn::ConvertTo(d, x));
  f.fy = hn::Sub(p.y, hn::ConvertTo(d, y));
  f.fz = hn::Sub(p.z, hn::ConvertTo(d, z));
  f.cell = index_of(k, x, y, z);
  const VI unseen = hn::Set(di, kUnseen);
  auto hole = hn::FirstN(di, 0);
  V at[4], slope[4];
  for (int i = 0; i < 4; ++i) {
    const VI row = hn::Add(f.cell, hn::Set(di, (i & 1) * k.side + (i >> 1) * k.side * k.side));
    const VI both = pair_at(k, row);
    const VI low = hn::ShiftRight<16>(hn::ShiftLeft<16>(both)), high = hn::ShiftRight<16>(both);
    hole = hn::Or(hole, hn::Or(hn::Eq(low, unseen), hn::Eq(high, unseen)));
    const V a = hn::ConvertTo(d, low);
    slope[i] = hn::Sub(hn::ConvertTo(d, high), a);
    at[i] = hn::Add(a, hn::Mul(f.fx, slope[i]));
  }
  const V y0 = hn::Add(at[0], hn::Mul(f.fy, hn::Sub(at[1], at[0]))),
          y1 = hn::Add(at[2], hn::Mul(f.fy, hn::Sub(at[3], at[2])));
  const V s0 = hn::Add(slope[0], hn::Mul(f.fy, hn::Sub(slope[1], slope[0])));
  const V s1 = hn::Add(slope[2], hn::Mul(f.fy, hn::Sub(slope[3], slope[2])));
  const V t0 = hn::Sub(at[1], at[0]), t1 = hn::Sub(at[3], at[2]);
  const V unit = hn::Set(d, 1.0f / kTsdfScale);
  f.value = hn::Mul(unit, hn::Add(y0, hn::Mul(f.fz, hn::Sub(y1, y0))));
  f.gx = hn::Mul(unit, hn::Add(s0, hn::Mul(f.fz, hn::Sub(s1, s0))));
  f.gy = hn::Mul(unit, hn::Add(t0, hn::Mul(f.fz, hn::Sub(t1, t0))));
  f.gz = hn::Mul(unit, hn::Sub(y1, y0));
  f.valid = hn::AndNot(hn::RebindMask(d, hole), in);
  return f;
}

// The field's place (not its values) at p; no longer valid where p left the volume.
HWY_INLINE Field moved_to(D d, const MarchKernel& k, const Point& p, Field f) {
  const DI di;
  f.valid = hn::And(f.valid, within(d, p, static_cast<float>(k.side - 1)));
  const VI x = hn::ConvertTo(di, hn::IfThenElseZero(f.valid, p.x)),
           y = hn::ConvertTo(di, hn::IfThenElseZero(f.valid, p.y)),
           z = hn::ConvertTo(di, hn::IfThenElseZero(f.valid, p.z));
  f.fx = hn::Sub(p.x, hn::ConvertTo(d, x));
  f.fy = hn::Sub(p.y, hn::ConvertTo(d, y));
  f.fz = hn::Sub(p.z, hn::ConvertTo(d, z));
  f.cell = index_of(k, x, y, z);
  return f;
}

// A Newton step along the ray towards the zero level, at most `most` metres of depth.
HWY_INLINE V newton(D d, const Field& f, const Ray& r, V z, V most) {
  const V along = hn::Add(hn::Add(hn::Mul(f.gx, r.x), hn::Mul(f.gy, r.y)), hn::Mul(f.gz, r.z));
  const M falling = hn::And(f.valid, hn::Lt(along, hn::Set(d, -1e-6f)));
  const V step = hn::Div(hn::Neg(f.value), hn::IfThenElse(falling, along, hn::Set(d, -1.0f)));
  const V bounded = hn::Max(hn::Min(step, most), hn::Neg(most));
  return hn::Add(z, hn::IfThenElseZero(falling, bounded));
}

}  // namespace march
}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();
#endif
