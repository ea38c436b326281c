#include "algo/volume/march_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/volume/march_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "algo/volume/march-inl.hpp"
#include "algo/volume/shade-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace march;

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
