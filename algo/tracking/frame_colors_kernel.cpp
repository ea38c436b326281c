#include "algo/tracking/frame_colors_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/tracking/frame_colors_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using DI = hn::RebindToSigned<D>;
using DU = hn::RebindToUnsigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;

constexpr std::uint32_t kKnown = 255u << 24;

// distort() of calibration.hpp, for a vector of rays (x, y, 1).
HWY_INLINE void distort_rays(D d, const float (&k)[5], V& x, V& y) {
  const V xx = hn::Mul(x, x), yy = hn::Mul(y, y), xy = hn::Mul(x, y), r2 = hn::Add(xx, yy);
  const V inner = hn::MulAdd(r2, hn::MulAdd(r2, hn::Set(d, k[4]), hn::Set(d, k[1])), hn::Set(d, k[0]));
  const V radial = hn::MulAdd(r2, inner, hn::Set(d, 1.0f));
  const V two_xy = hn::Add(xy, xy);
  const V across =
      hn::MulAdd(hn::Set(d, k[2]), two_xy, hn::Mul(hn::Set(d, k[3]), hn::Add(r2, hn::Add(xx, xx))));
  const V down =
      hn::MulAdd(hn::Set(d, k[3]), two_xy, hn::Mul(hn::Set(d, k[2]), hn::Add(r2, hn::Add(yy, yy))));
  x = hn::MulAdd(x, radial, across);
  y = hn::MulAdd(y, radial, down);
}

void colors(const FrameColorsKernel& k) {
  const D d;
  const DI di;
  const DU du;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int v = 0; v < k.height; ++v) {
    const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(v) * k.width;
    const float ry = (static_cast<float>(v) - k.cy) * k.per_fy;
    for (int u = 0; u < k.width; u += lanes) {
      const std::size_t left = static_cast<std::size_t>(k.width - u);
      const V z = hn::LoadU(d, k.z + row + u);
      const V rx =
          hn::Mul(hn::Sub(hn::Iota(d, static_cast<float>(u)), hn::Set(d, k.cx)), hn::Set(d, k.per_fx));
      V p[3];
      for (int a = 0; a < 3; ++a)
        p[a] = hn::MulAdd(
            hn::MulAdd(hn::Set(d, k.R[3 * a]), rx, hn::Set(d, k.R[3 * a + 1] * ry + k.R[3 * a + 2])), z,
            hn::Set(d, k.t[a]));
      const M before =
          hn::And(hn::And(hn::FirstN(d, left), hn::Gt(z, hn::Zero(d))), hn::Gt(p[2], hn::Set(d, 0.05f)));
      const V per_z = hn::Div(hn::Set(d, 1.0f), hn::IfThenElse(before, p[2], hn::Set(d, 1.0f)));
      V x = hn::Mul(p[0], per_z), y = hn::Mul(p[1], per_z);
      if (k.distorted) distort_rays(d, k.k, x, y);
      const V fu = hn::MulAdd(x, hn::Set(d, k.color_fx), hn::Set(d, k.color_cx + 0.5f));
      const V fv = hn::MulAdd(y, hn::Set(d, k.color_fy), hn::Set(d, k.color_cy + 0.5f));
      // A pixel is read as four bytes: the last one of the image would reach beyond it.
      const M across =
          hn::And(hn::Ge(fu, hn::Zero(d)), hn::Lt(fu, hn::Set(d, static_cast<float>(k.color_width - 1))));
      const M down =
          hn::And(hn::Ge(fv, hn::Zero(d)), hn::Lt(fv, hn::Set(d, static_cast<float>(k.color_height))));
      const M inside = hn::And(before, hn::And(across, down));
      const VI iu = hn::ConvertTo(di, hn::IfThenElseZero(inside, fu)),
               iv = hn::ConvertTo(di, hn::IfThenElseZero(inside, fv));
      const VI at = hn::Mul(hn::Add(hn::Mul(iv, hn::Set(di, k.color_width)), iu), hn::Set(di, 3));
      const auto word =
          hn::BitCast(du, hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(k.rgb), at));
      const auto rgb = hn::Or(hn::And(word, hn::Set(du, 0xffffffu)), hn::Set(du, kKnown));
      const auto out = hn::IfThenElseZero(hn::RebindMask(du, inside), rgb);
      if (left >= static_cast<std::size_t>(lanes)) {
        hn::StoreU(out, du, k.out + row + u);
      } else {
        hn::BlendedStore(out, hn::FirstN(du, left), du, k.out + row + u);
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(colors);

void sample_colors(const FrameColorsKernel& work) { HWY_DYNAMIC_DISPATCH(colors)(work); }

}  // namespace st
#endif
