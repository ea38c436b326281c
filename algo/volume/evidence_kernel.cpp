#include "algo/volume/evidence_kernel.hpp"

#include <cstring>

#include "algo/volume/evidence.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/volume/evidence_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "algo/volume/slope-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Multiplications and additions stay apart (no fused ones) in these kernels: every target gives the same
// bits.
using D = hn::CappedTag<float, 8>;
using DU = hn::RebindToUnsigned<D>;
using D8 = hn::Rebind<std::uint8_t, D>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr float kGrazing = 0.17f;       // cosine of 80 degrees: beyond it a sample says little about distance
constexpr float kColorGrazing = 0.35f;  // and colour smears over too much surface before that
constexpr float kLeastWeight = 0.125f, kMostWeight = 8.0f;

struct Edges {
  M beside;  // a step right beside the pixel: its own depth may be of either surface
  M near;    // a step or a hole within two pixels: colour and free space are not to be trusted
};
HWY_INLINE void look(D d, const float* p, int step, V z, V gap, Edges& edges) {
  const V one = hn::LoadU(d, p + step), two = hn::LoadU(d, p + 2 * step);
  const M step_one = hn::Gt(hn::AbsDiff(one, z), gap);
  edges.beside = hn::Or(edges.beside, hn::And(step_one, hn::Gt(one, hn::Zero(d))));
  edges.near = hn::Or(edges.near, hn::Or(step_one, hn::Gt(hn::AbsDiff(two, z), gap)));
}

// Counts surface samples outside of the box and widens the extent that was seen.
HWY_INLINE void locate(D d, EvidenceKernel& k, V x, V y, V z, M surface, V (&low)[3], V (&high)[3]) {
  M inside = surface;
  for (int a = 0; a < 3; ++a) {
    const V q = hn::Add(hn::Add(hn::Mul(hn::Set(d, k.R[3 * a]), x), hn::Mul(hn::Set(d, k.R[3 * a + 1]), y)),
                        hn::Add(hn::Mul(hn::Set(d, k.R[3 * a + 2]), z), hn::Set(d, k.t[a])));
    low[a] = hn::IfThenElse(surface, hn::Min(low[a], q), low[a]);
    high[a] = hn::IfThenElse(surface, hn::Max(high[a], q), high[a]);
    inside = hn::And(inside, hn::And(hn::Ge(q, hn::Set(d, k.low[a])), hn::Le(q, hn::Set(d, k.high[a]))));
  }
  k.outside += static_cast<int>(hn::CountTrue(d, hn::AndNot(inside, surface)));
}

HWY_INLINE hn::Vec<DU> bit_if(M mask, std::uint32_t bit) {
  const DU du;
  return hn::IfThenElseZero(hn::RebindMask(du, mask), hn::Set(du, bit));
}

struct Extent {
  V low[3], high[3];
};

HWY_INLINE void pixel_group(D d, EvidenceKernel& k, const float* p, int u, int v, M is_object,
                            M is_background, std::size_t at, Extent& extent) {
  const DU du;
  const V one = hn::Set(d, 1.0f);
  const V z = hn::LoadU(d, p);
  const M has = hn::And(hn::Gt(z, hn::Zero(d)), hn::Or(is_object, is_background));
  if (hn::AllFalse(d, has)) {
    hn::StoreU(hn::Zero(d), d, k.z + at);
    hn::StoreU(hn::Zero(du), du, k.meta + at);
    return;
  }
  const V gap = slope::gap_of(d, z, slope::coarse(k.fx));
  Edges edges{hn::FirstN(d, 0), hn::FirstN(d, 0)};
  look(d, p, 1, z, gap, edges);
  look(d, p, -1, z, gap, edges);
  look(d, p, k.depth_stride, z, gap, edges);
  look(d, p, -k.depth_stride, z, gap, edges);
  const M object = hn::And(has, is_object);
  if (hn::AllFalse(d,
                   object)) {  // background: only where it ends matters, and the normal stays along the axis
    const M empties = hn::AndNot(edges.near, has);
    hn::StoreU(hn::IfThenElseZero(empties, z), d, k.z + at);
    hn::StoreU(bit_if(empties, kEvidenceFree), du, k.meta + at);
    return;
  }
  const V su = slope::along(d, p, 1, k.wide, z, gap).value,
          sv = slope::along(d, p, k.depth_stride, k.wide, z, gap).value;
  const V du_px = hn::Sub(hn::Add(hn::Set(d, static_cast<float>(u)), hn::Iota(d, 0.0f)), hn::Set(d, k.cx));
  const V dv_px = hn::Set(d, static_cast<float>(v) - k.cy);
  const slope::Normal n = slope::normal_of(d, du_px, dv_px, k.fx, k.fy, z, su, sv);
  const V rx = hn::Mul(du_px, hn::Set(d, 1.0f / k.fx)), ry = hn::Mul(dv_px, hn::Set(d, 1.0f / k.fy));
  const V ray = hn::Sqrt(hn::Add(one, hn::Add(hn::Mul(rx, rx), hn::Mul(ry, ry))));
  const V cosine = hn::Div(hn::Mul(z, n.per_length), ray);

  V weight = one;
  if (k.noise_aware) {
    const V sigma = hn::Add(hn::Set(d, k.sigma_floor), hn::Mul(hn::Set(d, k.sigma_quadratic), hn::Mul(z, z)));
    const V ratio = hn::Div(hn::Set(d, k.nominal_sigma), sigma);
    weight = hn::Min(hn::Max(hn::Mul(cosine, hn::Mul(ratio, ratio)), hn::Set(d, kLeastWeight)),
                     hn::Set(d, kMostWeight));
  }
  // A fit that turns away from the camera is none.
  const M faces = hn::And(hn::Gt(cosine, hn::Set(d, kGrazing)), hn::Gt(n.minus_z, hn::Zero(d)));
  const M surface = hn::And(hn::AndNot(edges.beside, object), faces);
  const M clear = hn::AndNot(edges.near, has);
  const M empties = hn::And(clear, hn::Or(surface, is_background));
  const M color = hn::And(hn::And(clear, surface), hn::Gt(cosine, hn::Set(d, kColorGrazing)));

  const auto ten_bits = [&](V c) HWY_ATTR {
    return hn::And(
        hn::BitCast(du, hn::NearestInt(hn::Mul(hn::Mul(c, n.per_length), hn::Set(d, kEvidenceNormalScale)))),
        hn::Set(du, 1023u));
  };
  const auto weight_bits = hn::BitCast(du, hn::NearestInt(hn::Mul(weight, hn::Set(d, kEvidenceWeightUnits))));
  // Background keeps the axis for a normal here as well.
  auto meta =
      hn::IfThenElseZero(hn::RebindMask(du, object), hn::Or(ten_bits(n.x), hn::ShiftLeft<10>(ten_bits(n.y))));
  meta = hn::Or(meta, hn::ShiftLeft<20>(weight_bits));
  meta = hn::Or(meta, hn::Or(bit_if(color, kEvidenceColor),
                             hn::Or(bit_if(surface, kEvidenceSurface), bit_if(empties, kEvidenceFree))));
  const M says = hn::Or(surface, empties);
  hn::StoreU(hn::IfThenElseZero(says, z), d, k.z + at);
  hn::StoreU(hn::IfThenElseZero(hn::RebindMask(du, says), meta), du, k.meta + at);
  k.surface += static_cast<int>(hn::CountTrue(d, surface));
  k.refused += static_cast<int>(hn::CountTrue(d, hn::AndNot(surface, object)));
  locate(d, k, hn::Mul(rx, z), hn::Mul(ry, z), z, surface, extent.low, extent.high);
}

void pixels(EvidenceKernel& work) {
  // A copy that no store through a pointer can change: its values stay in registers.
  EvidenceKernel k = work;
  const D d;
  const DU du;
  const D8 d8;
  const int lanes = static_cast<int>(hn::Lanes(d));
  Extent extent;
  for (int a = 0; a < 3; ++a) {
    extent.low[a] = hn::Set(d, 1e9f);
    extent.high[a] = hn::Set(d, -1e9f);
  }
  alignas(16) std::uint8_t tail[16];
  for (int v = 0; v < k.height; ++v) {
    const float* p = k.depth + static_cast<std::ptrdiff_t>(v) * k.depth_stride;
    const std::uint8_t* owners =
        k.owners == nullptr ? nullptr : k.owners + static_cast<std::ptrdiff_t>(v) * k.owners_stride;
    for (int u = 0; u < k.width; u += lanes) {
      const int left = k.width - u;
      M is_object = hn::FirstN(d, static_cast<std::size_t>(left)), is_background = hn::FirstN(d, 0);
      if (owners != nullptr) {
        const std::uint8_t* from = owners + u;
        if (left < lanes) {  // the image may end here: nothing behind it is read
          std::memset(tail, 0, sizeof tail);
          std::memcpy(tail, from, static_cast<std::size_t>(left));
          from = tail;
        }
        const auto owner = hn::PromoteTo(du, hn::LoadU(d8, from));
        const M in_image = is_object;
        is_object = hn::And(in_image, hn::RebindMask(d, hn::Eq(owner, hn::Set(du, k.object))));
        is_background = hn::And(in_image, hn::RebindMask(d, hn::Eq(owner, hn::Set(du, k.background))));
      }
      pixel_group(
          d, k, p + u, u, v, is_object, is_background,
          static_cast<std::size_t>(v) * static_cast<std::size_t>(k.stride) + static_cast<std::size_t>(u),
          extent);
    }
  }
  for (int a = 0; a < 3; ++a) {
    k.seen_low[a] = hn::GetLane(hn::MinOfLanes(d, extent.low[a]));
    k.seen_high[a] = hn::GetLane(hn::MaxOfLanes(d, extent.high[a]));
  }
  work = k;
}

void cells(const float* z, const std::uint32_t* meta, int stride, int height, int cells_wide,
           float* triples) {
  const D d;
  const DU du;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const int rows = (height + Evidence::kCell - 1) / Evidence::kCell;
  for (int cv = 0; cv < rows; ++cv) {
    const int end = (cv + 1) * Evidence::kCell < height ? (cv + 1) * Evidence::kCell : height;
    for (int cu = 0; cu < cells_wide; ++cu) {
      V nearest = hn::Set(d, 1e9f), farthest = hn::Zero(d), empty_to = hn::Zero(d);
      for (int v = cv * Evidence::kCell; v < end; ++v)
        for (int u = 0; u < Evidence::kCell; u += lanes) {
          const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(v) * stride + cu * Evidence::kCell + u;
          const V here = hn::LoadU(d, z + at);
          const auto bits = hn::LoadU(du, meta + at);
          const M surface =
              hn::RebindMask(d, hn::TestBit(bits, hn::Set(du, static_cast<std::uint32_t>(kEvidenceSurface))));
          const M empties =
              hn::RebindMask(d, hn::TestBit(bits, hn::Set(du, static_cast<std::uint32_t>(kEvidenceFree))));
          nearest = hn::IfThenElse(surface, hn::Min(nearest, here), nearest);
          farthest = hn::IfThenElse(surface, hn::Max(farthest, here), farthest);
          empty_to = hn::IfThenElse(empties, hn::Max(empty_to, here), empty_to);
        }
      *triples++ = hn::GetLane(hn::MinOfLanes(d, nearest));
      *triples++ = hn::GetLane(hn::MaxOfLanes(d, farthest));
      *triples++ = hn::GetLane(hn::MaxOfLanes(d, empty_to));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(pixels);
HWY_EXPORT(cells);

void evaluate_pixels(EvidenceKernel& work) { HWY_DYNAMIC_DISPATCH(pixels)(work); }

void reduce_cells(const float* z, const std::uint32_t* meta, int stride, int height, int cells_wide,
                  float* triples) {
  HWY_DYNAMIC_DISPATCH(cells)(z, meta, stride, height, cells_wide, triples);
}

}  // namespace st
#endif
