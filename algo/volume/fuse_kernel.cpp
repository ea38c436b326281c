#include "algo/volume/fuse_kernel.hpp"

#include "algo/volume/evidence.hpp"
#include "algo/volume/voxel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/volume/fuse_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// One row of a brick is one vector of eight. No fused multiply-add: every target gives the same bits.
using D = hn::CappedTag<float, 8>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using D16 = hn::Rebind<std::int16_t, D>;
using D8 = hn::Rebind<std::uint8_t, D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using VU = hn::Vec<DU>;
using M = hn::Mask<D>;

constexpr float kFreeEnough = 0.95f;  // nothing left to carve
constexpr float kDropFrom =
    -0.5f;  // behind half of the truncation weight falls to zero: thin things keep their backs
constexpr float kOutlierSigmas2 = 9.0f;  // squared
constexpr float kSpreadOfMean = 1.15f;  // a standard deviation beside the mean of root-mean-square deviations

HWY_INLINE V bits_to_float(VU x, int shift, std::uint32_t mask) {
  const D d;
  const DI di;
  const DU du;
  return hn::ConvertTo(d, hn::BitCast(di, hn::And(hn::ShiftRightSame(x, shift), hn::Set(du, mask))));
}

// The pixels that the voxels of one row fall on.
struct Pixels {
  M inside;
  VI index;  // of z and meta
  VI u, v;
};

struct Row {
  V x, y, z;  // camera frame, metres
};

HWY_INLINE Pixels project(D d, const FuseKernel& k, const Row& p) {
  const DI di;
  const V per_z = hn::Div(hn::Set(d, 1.0f), p.z);
  // Half a pixel is added so that cutting the fraction off rounds to the nearest centre.
  const V u = hn::Add(hn::Mul(hn::Mul(hn::Set(d, k.fx), p.x), per_z), hn::Set(d, k.cx + 0.5f));
  const V v = hn::Add(hn::Mul(hn::Mul(hn::Set(d, k.fy), p.y), per_z), hn::Set(d, k.cy + 0.5f));
  const V zero = hn::Zero(d);
  // Comparisons are false for NaN, and the index is made only where they hold.
  const M in_u = hn::And(hn::Ge(u, zero), hn::Lt(u, hn::Set(d, static_cast<float>(k.width))));
  const M in_v = hn::And(hn::Ge(v, zero), hn::Lt(v, hn::Set(d, static_cast<float>(k.height))));
  Pixels o;
  o.inside = hn::And(hn::And(in_u, in_v), hn::Gt(p.z, hn::Set(d, 0.05f)));
  o.u = hn::ConvertTo(di, hn::IfThenElseZero(o.inside, u));
  o.v = hn::ConvertTo(di, hn::IfThenElseZero(o.inside, v));
  o.index = hn::Add(hn::Mul(o.v, hn::Set(di, k.stride)), o.u);
  return o;
}

// Distance to the plane through the pixel's surface point: exact for a flat surface at any incidence and any
// place within the pixel, where the plain difference along the ray is off by the cosine and by half a pixel's
// slope.
HWY_INLINE V plane_distance(D d, const FuseKernel& k, const Row& p, const Pixels& px, V depth, VU meta) {
  const DI di;
  const auto signed_ten = [&](VU x) HWY_ATTR {
    return hn::Mul(hn::ConvertTo(d, hn::ShiftRight<22>(hn::BitCast(di, x))),
                   hn::Set(d, 1.0f / kEvidenceNormalScale));
  };
  const V nx = signed_ten(hn::ShiftLeft<22>(meta)), ny = signed_ten(hn::ShiftLeft<12>(meta));
  const V rest = hn::Sub(hn::Set(d, 1.0f), hn::Add(hn::Mul(nx, nx), hn::Mul(ny, ny)));
  const V minus_nz = hn::Sqrt(hn::Max(rest, hn::Zero(d)));
  const V rx = hn::Mul(hn::Sub(hn::ConvertTo(d, px.u), hn::Set(d, k.cx)), hn::Set(d, k.per_fx));
  const V ry = hn::Mul(hn::Sub(hn::ConvertTo(d, px.v), hn::Set(d, k.cy)), hn::Set(d, k.per_fy));
  const V ex = hn::Sub(p.x, hn::Mul(rx, depth)), ey = hn::Sub(p.y, hn::Mul(ry, depth));
  return hn::Add(hn::Add(hn::Mul(nx, ex), hn::Mul(ny, ey)), hn::Mul(minus_nz, hn::Sub(depth, p.z)));
}

// New mean and spread of a colour word; what disagrees lowers the trust, and at zero the next sample starts
// afresh.
HWY_INLINE void update_color(D d, FuseKernel& k, std::size_t at, const Pixels& px, M lanes) {
  const DI di;
  const DU du;
  const VI index = hn::Add(hn::Mul(px.v, hn::Set(di, k.color_stride)), px.u);
  const VU seen = hn::BitCast(du, hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(k.pixel_color),
                                                  hn::IfThenElseZero(hn::RebindMask(di, lanes), index)));
  lanes = hn::And(lanes, hn::RebindMask(d, hn::Ne(hn::ShiftRight<24>(seen), hn::Zero(du))));
  if (hn::AllFalse(d, lanes)) return;
  const VU old = hn::LoadU(du, k.color + at);
  const V trust = bits_to_float(old, 28, 15u);
  const V spread = hn::Mul(hn::Add(bits_to_float(old, 24, 15u), hn::Set(d, 1.0f)), hn::Set(d, kSpreadStep));
  V mean[3], difference[3];
  V square = hn::Zero(d);
  for (int c = 0; c < 3; ++c) {
    mean[c] = bits_to_float(old, 8 * c, 255u);
    difference[c] = hn::Sub(bits_to_float(seen, 8 * c, 255u), mean[c]);
    square = hn::Add(square, hn::Mul(difference[c], difference[c]));
  }
  square = hn::Div(square, hn::Set(d, 3.0f));
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d);
  const M first = hn::Eq(trust, zero);
  const M agrees =
      hn::Or(first, hn::Le(square, hn::Mul(hn::Set(d, kOutlierSigmas2), hn::Mul(spread, spread))));
  const V gain = hn::IfThenElseZero(
      agrees, hn::Div(one, hn::Add(hn::Mul(hn::Mul(trust, trust), hn::Set(d, 0.4f)), one)));
  VU word = hn::Zero(du);
  for (int c = 0; c < 3; ++c) {
    // Cutting off after adding a dither below one rounds without bias, and leaves a mean that does not change
    // as it is.
    const V next = hn::Add(hn::Add(mean[c], hn::Mul(gain, difference[c])), hn::Set(d, k.dither[c]));
    word = hn::Or(word, hn::ShiftLeftSame(hn::BitCast(du, hn::ConvertTo(di, next)), 8 * c));
  }
  const V deviation = hn::Mul(hn::Sqrt(square), hn::Set(d, kSpreadOfMean));
  V next_spread = hn::Add(spread, hn::Mul(gain, hn::Sub(deviation, spread)));
  next_spread = hn::IfThenElse(first, hn::Set(d, kFirstSpread), next_spread);
  const V above_first = hn::Sub(hn::Div(next_spread, hn::Set(d, kSpreadStep)), one);
  const V steps = hn::Min(hn::Max(hn::Add(above_first, hn::Set(d, k.dither[0])), zero), hn::Set(d, 15.0f));
  const V up = hn::Min(hn::Add(trust, one), hn::Set(d, k.color_cap));
  const V next_trust = hn::IfThenElse(agrees, up, hn::Max(hn::Sub(trust, one), zero));
  word = hn::Or(word, hn::ShiftLeft<24>(hn::BitCast(du, hn::ConvertTo(di, steps))));
  word = hn::Or(word, hn::ShiftLeft<28>(hn::BitCast(du, hn::ConvertTo(di, next_trust))));
  hn::StoreU(hn::IfThenElse(hn::RebindMask(du, lanes), word, old), du, k.color + at);
  k.colored += static_cast<int>(hn::CountTrue(d, lanes));
  k.color_refused += static_cast<int>(hn::CountTrue(d, hn::AndNot(agrees, lanes)));
}

// True when something was written.
HWY_INLINE bool update_row(D d, FuseKernel& k, std::size_t at, const Row& p, bool carve) {
  const DI di;
  const DU du;
  const D16 d16;
  const D8 d8;
  const Pixels px = project(d, k, p);
  if (hn::AllFalse(d, px.inside)) return false;
  const V depth = hn::IfThenElseZero(px.inside, hn::GatherIndex(d, k.z, px.index));
  const V ahead = hn::Sub(depth, p.z);
  const M has = hn::Gt(depth, hn::Zero(d));
  const M close = hn::And(has, hn::Lt(hn::Abs(ahead), hn::Set(d, k.reach)));
  const VI stored = hn::PromoteTo(di, hn::LoadU(d16, k.tsdf + at));
  const M seen = hn::RebindMask(d, hn::Ne(stored, hn::Set(di, kUnseen)));
  M before = hn::FirstN(d, 0);  // emptied, if the pixel says so and the distance is enough
  if (carve) {
    const M matter =
        hn::RebindMask(d, hn::Lt(stored, hn::Set(di, static_cast<std::int32_t>(kFreeEnough * kTsdfScale))));
    before = hn::And(hn::And(has, hn::Gt(ahead, hn::Zero(d))), hn::And(seen, matter));
  }
  if (hn::AllFalse(d, hn::Or(close, before))) return false;
  const VU meta =
      hn::BitCast(du, hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(k.meta), px.index));
  const V t = hn::Mul(plane_distance(d, k, p, px, depth, meta), hn::Set(d, k.per_truncation));
  const V one = hn::Set(d, 1.0f);
  const M surface =
      hn::RebindMask(d, hn::TestBit(meta, hn::Set(du, static_cast<std::uint32_t>(kEvidenceSurface))));
  const M near = hn::And(hn::And(close, surface), hn::Lt(hn::Abs(t), one));
  const M free = hn::RebindMask(d, hn::TestBit(meta, hn::Set(du, static_cast<std::uint32_t>(kEvidenceFree))));
  const M emptied = hn::And(hn::And(before, free), hn::Ge(t, one));
  const M changes = hn::Or(near, emptied);
  if (hn::AllFalse(d, changes)) return false;

  const V old = hn::IfThenElseZero(seen, hn::Mul(hn::ConvertTo(d, stored), hn::Set(d, 1.0f / kTsdfScale)));
  const VI old_weight = hn::PromoteTo(di, hn::LoadU(d8, k.weight + at));
  const V held = hn::Mul(hn::ConvertTo(d, old_weight), hn::Set(d, 1.0f / kWeightUnits));
  const V sample_weight = hn::Mul(bits_to_float(meta, 20, 255u), hn::Set(d, 1.0f / kEvidenceWeightUnits));
  const V drop = hn::Min(one, hn::Div(hn::Add(one, t), hn::Set(d, 1.0f + kDropFrom)));
  const V w = hn::IfThenElse(emptied, hn::Set(d, k.carve_weight), hn::Mul(sample_weight, drop));
  const V target = hn::IfThenElse(emptied, one, t);
  const V trusted = hn::IfThenElseZero(seen, held);
  const V mean = hn::Add(
      old, hn::Div(hn::Mul(w, hn::Sub(target, old)), hn::Max(hn::Add(trusted, w), hn::Set(d, 1e-6f))));
  const V limited = hn::Min(hn::Max(mean, hn::Set(d, -1.0f)), one);
  const VI next = hn::NearestInt(hn::Mul(limited, hn::Set(d, kTsdfScale)));

  // Emptying a voxel takes trust away instead of adding it, so that what left is forgotten as fast as it was
  // learned.
  const V sum = hn::IfThenElse(emptied, hn::Sub(trusted, w), hn::Min(hn::Add(trusted, w), hn::Set(d, k.cap)));
  V units = hn::Add(hn::Mul(sum, hn::Set(d, kWeightUnits)), hn::Set(d, k.dither[0]));
  units = hn::Min(hn::Max(units, one), hn::Set(d, k.cap * kWeightUnits));
  const auto lanes_i = hn::RebindMask(di, changes);
  const VI old_count = hn::PromoteTo(di, hn::LoadU(d8, k.observations + at));
  const VI count = hn::Min(hn::Add(old_count, hn::Set(di, 1)), hn::Set(di, 255));
  hn::StoreU(hn::DemoteTo(d16, hn::IfThenElse(lanes_i, next, stored)), d16, k.tsdf + at);
  hn::StoreU(hn::DemoteTo(d8, hn::IfThenElse(lanes_i, hn::ConvertTo(di, units), old_weight)), d8,
             k.weight + at);
  hn::StoreU(hn::DemoteTo(d8, hn::IfThenElse(hn::RebindMask(di, near), count, old_count)), d8,
             k.observations + at);
  k.updated += static_cast<int>(hn::CountTrue(d, near));
  k.carved += static_cast<int>(hn::CountTrue(d, emptied));

  if (k.pixel_color != nullptr) {
    const M colored =
        hn::RebindMask(d, hn::TestBit(meta, hn::Set(du, static_cast<std::uint32_t>(kEvidenceColor))));
    const M at_surface = hn::Lt(hn::Abs(t), hn::Set(d, k.color_band));
    const M lanes = hn::And(hn::And(near, colored), at_surface);
    if (!hn::AllFalse(d, lanes)) update_color(d, k, at, px, lanes);
  }
  return true;
}

// Whether a row of eight holds anything that could be emptied.
HWY_INLINE bool has_matter(const std::int16_t* row) {
  const hn::CappedTag<std::int16_t, 8> d;
  const auto x = hn::LoadU(d, row);
  const auto seen = hn::Ne(x, hn::Set(d, kUnseen));
  return !hn::AllFalse(
      d, hn::And(seen, hn::Lt(x, hn::Set(d, static_cast<std::int16_t>(kFreeEnough * kTsdfScale)))));
}

// Which octants of the brick at `first` hold a voxel behind the surface.
HWY_INLINE std::uint8_t solid_octants(const FuseKernel& k, std::size_t first) {
  const hn::CappedTag<std::int16_t, 8> d;
  const std::size_t n = static_cast<std::size_t>(k.side);
  unsigned bits = 0;
  for (std::size_t quarter = 0; quarter < 4; ++quarter) {
    auto solid = hn::FirstN(d, 0);
    for (std::size_t i = 0; i < 16; ++i) {
      const std::size_t y = 4 * (quarter & 1) + i % 4, z = 4 * (quarter >> 1) + i / 4;
      const auto row = hn::LoadU(d, k.tsdf + first + (z * n + y) * n);
      solid = hn::Or(solid, hn::And(hn::Lt(row, hn::Zero(d)), hn::Ne(row, hn::Set(d, kUnseen))));
    }
    std::uint8_t lanes[8];
    hn::StoreMaskBits(d, solid, lanes);
    bits |= ((lanes[0] & 15u) != 0 ? 1u : 0u) << (2 * quarter) | (lanes[0] > 15u ? 1u : 0u)
                                                                     << (2 * quarter + 1);
  }
  return static_cast<std::uint8_t>(bits);
}

void bricks(FuseKernel& work) {
  // A copy that no store through a pointer can change: its values stay in registers.
  FuseKernel k = work;
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const std::size_t n = static_cast<std::size_t>(k.side);
  // Offsets from the row's first voxel, so that narrow and wide vectors add the same numbers.
  Row along[8];
  for (int x = 0; x < 8; x += lanes) {
    const V ramp = hn::Iota(d, static_cast<float>(x));
    along[x] = {hn::Mul(ramp, hn::Set(d, k.step_x[0])), hn::Mul(ramp, hn::Set(d, k.step_x[1])),
                hn::Mul(ramp, hn::Set(d, k.step_x[2]))};
  }
  for (std::size_t i = 0; i < k.listed; ++i) {
    const FuseBrick& brick = k.list[i];
    const int x0 = brick.x * 8, y0 = brick.y * 8, z0 = brick.z * 8;
    const std::size_t first =
        (static_cast<std::size_t>(z0) * n + static_cast<std::size_t>(y0)) * n + static_cast<std::size_t>(x0);
    bool written = false;
    for (int z = 0; z < 8; ++z)
      for (int y = 0; y < 8; ++y) {
        float at[3];
        for (int a = 0; a < 3; ++a)
          at[a] = ((k.first[a] + k.step_z[a] * static_cast<float>(z0 + z)) +
                   k.step_y[a] * static_cast<float>(y0 + y)) +
                  k.step_x[a] * static_cast<float>(x0);
        const std::size_t row = first + (static_cast<std::size_t>(z) * n + static_cast<std::size_t>(y)) * n;
        const float other_end = at[2] + 7.0f * k.step_x[2];
        const bool off_band = (at[2] < brick.near_m && other_end < brick.near_m) ||
                              (at[2] > brick.far_m && other_end > brick.far_m);
        if (off_band && !(brick.carve && has_matter(k.tsdf + row))) continue;
        for (int x = 0; x < 8; x += lanes) {
          const Row p{hn::Add(hn::Set(d, at[0]), along[x].x), hn::Add(hn::Set(d, at[1]), along[x].y),
                      hn::Add(hn::Set(d, at[2]), along[x].z)};
          written = update_row(d, k, row + static_cast<std::size_t>(x), p, brick.carve) || written;
        }
      }
    if (!written) continue;
    const std::size_t b = n / 8, place = (static_cast<std::size_t>(brick.z) * b + brick.y) * b + brick.x;
    k.octants[place] = solid_octants(k, first);
    k.bricks[place] = static_cast<std::uint8_t>(kBrickTouched | (k.octants[place] != 0 ? kBrickSolid : 0));
  }
  work = k;
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(bricks);

void fuse_bricks(FuseKernel& work) { HWY_DYNAMIC_DISPATCH(bricks)(work); }

}  // namespace st
#endif
