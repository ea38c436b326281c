#include "algo/volume/march_kernel.hpp"

#include "algo/volume/raycast.hpp"
#include "algo/volume/voxel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/volume/march_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "algo/volume/slope-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
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

constexpr int kMostSteps = 512;
constexpr float kTrusting = 0.9f;     // of the distance that a sample promises to be free
constexpr float kUnseenStep = 0.75f;  // truncations: the band before a surface cannot be jumped over
constexpr float kLeastStep = 0.75f;   // voxels
constexpr float kSeedBand = 0.9f;     // truncations: beyond it a value says only that the surface is far

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

// What either way found, onto the images.
HWY_INLINE void settle(D d, MarchKernel& k, const Hit& seeded, const Hit& marched, float* depth,
                       std::size_t at) {
  const DI di;
  const DU du;
  const D8 d8;
  const auto by_seed = hn::Ne(seeded.weight, hn::Zero(du));
  const VU weight = hn::IfThenElse(by_seed, seeded.weight, marched.weight);
  hn::StoreU(hn::IfThenElse(hn::RebindMask(d, by_seed), seeded.z, marched.z), d, depth);
  hn::StoreU(hn::DemoteTo(d8, hn::BitCast(di, weight)), d8, k.out_weight + at);
  if (k.color != nullptr)
    hn::StoreU(hn::IfThenElse(by_seed, seeded.color, marched.color), du, k.out_color + at);
}

// A row's rays, and what they still have to look for.
struct RayRow {
  Ray ray;
  Hit seeded;
  March march;
  V end;
};
HWY_INLINE RayRow begin_row(D d, const MarchKernel& k, int u, int v, M lanes, float from, float to) {
  RayRow row{ray_of(d, k, u, v), no_hit(d), start(d, hn::Set(d, from), lanes), hn::Set(d, to)};
  if (k.seed == nullptr) return row;
  const V seed = hn::LoadU(d, k.seed + static_cast<std::ptrdiff_t>(v) * k.seed_stride + u);
  row.seeded = from_seed(d, k, row.ray, seed, lanes);
  const M missed = hn::And(lanes, hn::RebindMask(d, hn::Eq(row.seeded.weight, hn::Zero(DU()))));
  const V reach = hn::Set(d, k.seed_reach);
  row.march.z = hn::Max(row.march.z, hn::Sub(seed, reach));
  row.end = hn::Min(row.end, hn::Add(seed, reach));
  row.march.active = hn::And(hn::And(missed, hn::Gt(seed, hn::Zero(d))), hn::Lt(row.march.z, row.end));
  return row;
}

// Two rows of a tile at once: a march waits for its loads, and the other row's work fills the gaps.
HWY_INLINE void pixel_groups(D d, MarchKernel& k, int u, int v, float from, float to, float* depth,
                             std::size_t at) {
  const bool both = v + 1 < k.height;
  const M lanes = hn::FirstN(d, static_cast<std::size_t>(k.width - u));
  RayRow a = begin_row(d, k, u, v, lanes, from, to);
  RayRow b = a;
  b.march.active = hn::FirstN(d, 0);
  if (both) b = begin_row(d, k, u, v + 1, lanes, from, to);
  for (int i = 0; i < kMostSteps; ++i) {
    if (hn::AllFalse(d, hn::Or(a.march.active, b.march.active))) break;
    advance(d, k, a.ray, a.end, a.march);
    advance(d, k, b.ray, b.end, b.march);
  }
  const int rays = static_cast<int>(hn::CountTrue(d, lanes));
  k.rays += both ? 2 * rays : rays;
  settle(d, k, a.seeded, from_march(d, k, a.ray, a.march), depth, at);
  if (both)
    settle(d, k, b.seeded, from_march(d, k, b.ray, b.march), depth + k.padded_stride,
           at + static_cast<std::size_t>(k.stride));
}

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

void rays(MarchKernel& work) {
  // A copy that no store through a pointer can change: its values stay in registers.
  MarchKernel k = work;
  const D d;
  const DU du;
  const D8 d8;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int tiles_wide = k.stride / kRayTile;
  for (int v = 0; v < k.height; v += 2)
    for (int u = 0; u < k.stride; u += lanes) {
      const std::size_t at =
          static_cast<std::size_t>(v) * static_cast<std::size_t>(k.stride) + static_cast<std::size_t>(u);
      const int tile = v / kRayTile * tiles_wide + u / kRayTile;
      if (u < k.width && k.nearest[tile] < k.farthest[tile]) {
        float* depth = k.depth + static_cast<std::ptrdiff_t>(v) * k.padded_stride + u;
        pixel_groups(d, k, u, v, k.nearest[tile], k.farthest[tile], depth, at);
        continue;
      }
      for (int row = v; row < v + 2 && row < k.height; ++row) {  // the padded image is zero already
        const std::size_t empty = at + static_cast<std::size_t>(row - v) * static_cast<std::size_t>(k.stride);
        if (k.color != nullptr) hn::StoreU(hn::Zero(du), du, k.out_color + empty);
        hn::StoreU(hn::Zero(d8), d8, k.out_weight + empty);
      }
    }
  for (int v = 0; v < k.height; ++v)
    for (int u = 0; u < k.stride; u += lanes)
      shade(d, k, k.depth + static_cast<std::ptrdiff_t>(v) * k.padded_stride + u, u, v,
            static_cast<std::size_t>(v) * static_cast<std::size_t>(k.stride) + static_cast<std::size_t>(u));
  work = k;
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(rays);

void march_rays(MarchKernel& work) { HWY_DYNAMIC_DISPATCH(rays)(work); }

}  // namespace st
#endif
