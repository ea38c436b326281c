#include "algo/tracking/camera_kernel.hpp"

#include "algo/tracking/model_view.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/tracking/camera_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;

constexpr int kRows = 4;  // of the image between two emptyings of the float sums into double ones

HWY_INLINE double sum(D d, V v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, v))); }

// What the rows of the Jacobian need of the present pixels: the point and the normal of its partner, and the
// residual along it.
struct Pairs {
  V x, y, z;     // the point, view frame
  V nx, ny, nz;  // of the surface
  V r;           // n . (p - q), metres
  V sigma;       // axial noise of a reading at that depth
  M on;
};

HWY_INLINE Pairs pair_pixels(D d, CameraKernel& k, const float* row, int u, const V (&origin)[3],
                             const V (&along_x)[3]) {
  const DI di;
  Pairs o;
  const V depth = hn::LoadU(d, row + u);
  const M in_row = hn::FirstN(d, static_cast<std::size_t>(k.width - u));
  const M has = hn::And(in_row, hn::Gt(depth, hn::Zero(d)));
  k.readings += static_cast<int>(hn::CountTrue(d, has));
  const V rx = hn::Mul(hn::Sub(hn::Iota(d, static_cast<float>(u)), hn::Set(d, k.cx)), hn::Set(d, k.per_fx));
  o.x = hn::MulAdd(hn::MulAdd(along_x[0], rx, origin[0]), depth, hn::Set(d, k.t[0]));
  o.y = hn::MulAdd(hn::MulAdd(along_x[1], rx, origin[1]), depth, hn::Set(d, k.t[1]));
  o.z = hn::MulAdd(hn::MulAdd(along_x[2], rx, origin[2]), depth, hn::Set(d, k.t[2]));
  const M before = hn::And(has, hn::Gt(o.z, hn::Set(d, 0.1f)));
  const V per_z = hn::Div(hn::Set(d, 1.0f), hn::IfThenElse(before, o.z, hn::Set(d, 1.0f)));
  const V pu = hn::MulAdd(hn::Mul(o.x, per_z), hn::Set(d, k.view_fx), hn::Set(d, k.view_cx + 0.5f));
  const V pv = hn::MulAdd(hn::Mul(o.y, per_z), hn::Set(d, k.view_fy), hn::Set(d, k.view_cy + 0.5f));
  // Comparisons are false for NaN, and the index is made only where they hold.
  const M across = hn::And(hn::Ge(pu, hn::Zero(d)), hn::Lt(pu, hn::Set(d, static_cast<float>(k.view_width))));
  const M down = hn::And(hn::Ge(pv, hn::Zero(d)), hn::Lt(pv, hn::Set(d, static_cast<float>(k.view_height))));
  const M inside = hn::And(before, hn::And(across, down));
  const VI iu = hn::ConvertTo(di, hn::IfThenElseZero(inside, pu)),
           iv = hn::ConvertTo(di, hn::IfThenElseZero(inside, pv));
  const VI at = hn::Add(hn::Mul(iv, hn::Set(di, k.view_stride)), iu);
  const V qz = hn::GatherIndex(d, k.view_z, at);
  const V gx = hn::NegMulAdd(
      hn::Mul(hn::Sub(hn::ConvertTo(d, iu), hn::Set(d, k.view_cx)), hn::Set(d, 1.0f / k.view_fx)), qz, o.x);
  const V gy = hn::NegMulAdd(
      hn::Mul(hn::Sub(hn::ConvertTo(d, iv), hn::Set(d, k.view_cy)), hn::Set(d, 1.0f / k.view_fy)), qz, o.y);
  const V gz = hn::Sub(o.z, qz);
  const V distance2 = hn::MulAdd(gx, gx, hn::MulAdd(gy, gy, hn::Mul(gz, gz)));
  o.sigma = hn::MulAdd(hn::Mul(o.z, o.z), hn::Set(d, kDepthSigmaPerSquare), hn::Set(d, kLeastDepthSigma_m));
  const V reach2 = hn::MulAdd(hn::Mul(o.sigma, o.sigma), hn::Set(d, 16.0f), hn::Set(d, k.gate2_m2));
  const M facing = hn::And(inside, hn::Gt(qz, hn::Zero(d)));
  k.facing += static_cast<int>(hn::CountTrue(d, facing));
  o.on = hn::And(facing, hn::Le(distance2, reach2));
  const VI packed = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(k.view_normal), at);
  const V unit = hn::Set(d, 1.0f / kNormalScale);
  o.nx = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(packed))), unit);
  o.ny = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(packed)), unit);
  const V rest = hn::NegMulAdd(o.nx, o.nx, hn::NegMulAdd(o.ny, o.ny, hn::Set(d, 1.0f)));
  o.nz = hn::Neg(hn::Sqrt(hn::Max(rest, hn::Zero(d))));
  o.r = hn::IfThenElseZero(o.on, hn::MulAdd(o.nx, gx, hn::MulAdd(o.ny, gy, hn::Mul(o.nz, gz))));
  return o;
}

struct Sums {
  V h[21], g[6], square;
  HWY_INLINE void clear(D d) {
    for (V& v : h) v = hn::Zero(d);
    for (V& v : g) v = hn::Zero(d);
    square = hn::Zero(d);
  }
  HWY_INLINE void add(const V (&J)[6], V r, V w) {
    int k = 0;
    for (int i = 0; i < 6; ++i) {
      const V wJ = hn::Mul(w, J[i]);
      g[i] = hn::MulAdd(wJ, r, g[i]);
      for (int j = i; j < 6; ++j, ++k) h[k] = hn::MulAdd(wJ, J[j], h[k]);
    }
  }
  HWY_INLINE void empty_into(D d, CameraKernel& k) {
    for (int i = 0; i < 21; ++i) k.triangle[i] += sum(d, h[i]);
    for (int i = 0; i < 6; ++i) k.gradient[i] += sum(d, g[i]);
    k.square_sum += sum(d, square);
    clear(d);
  }
};

void camera_sums(CameraKernel& work) {
  // A copy that no store through a pointer can change: its values stay in registers.
  CameraKernel k = work;
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V half_pixel = hn::Set(d, 0.5f / k.view_fx);
  Sums sums;
  sums.clear(d);
  for (int v = 0; v < k.height; ++v) {
    const float* row = k.z + static_cast<std::ptrdiff_t>(v) * k.width;
    const float ry = (static_cast<float>(v) - k.cy) * k.per_fy;
    // The ray of a pixel, turned: origin + rx along_x.
    const V origin[3] = {hn::Set(d, k.R[1] * ry + k.R[2]), hn::Set(d, k.R[4] * ry + k.R[5]),
                         hn::Set(d, k.R[7] * ry + k.R[8])};
    const V along_x[3] = {hn::Set(d, k.R[0]), hn::Set(d, k.R[3]), hn::Set(d, k.R[6])};
    for (int u = 0; u < k.width; u += lanes) {
      const Pairs p = pair_pixels(d, k, row, u, origin, along_x);
      if (hn::AllFalse(d, p.on)) continue;
      k.paired += static_cast<int>(hn::CountTrue(d, p.on));
      // Axial noise seen along the normal, plus what a pixel's width leaves open sideways.
      const V axial = hn::Mul(p.sigma, p.nz), lateral = hn::Mul(half_pixel, p.z);
      const V per_variance = hn::Div(hn::Set(d, 1.0f), hn::MulAdd(axial, axial, hn::Mul(lateral, lateral)));
      const V r2 = hn::Mul(p.r, p.r), s2 = hn::Mul(r2, per_variance);
      const M inlier = hn::And(p.on, hn::Lt(s2, hn::Set(d, 9.0f)));
      k.inliers += static_cast<int>(hn::CountTrue(d, inlier));
      sums.square = hn::Add(sums.square, hn::IfThenElseZero(inlier, r2));
      const V keep = hn::Max(hn::NegMulAdd(s2, hn::Set(d, 1.0f / k.robust2), hn::Set(d, 1.0f)), hn::Zero(d));
      const V w = hn::IfThenElseZero(p.on, hn::Mul(hn::Mul(keep, keep), per_variance));
      // d r / d (v, w) for p' = p + v + w x p.
      const V J[6] = {p.nx,
                      p.ny,
                      p.nz,
                      hn::MulSub(p.y, p.nz, hn::Mul(p.z, p.ny)),
                      hn::MulSub(p.z, p.nx, hn::Mul(p.x, p.nz)),
                      hn::MulSub(p.x, p.ny, hn::Mul(p.y, p.nx))};
      sums.add(J, p.r, w);
    }
    if (v % kRows == kRows - 1) sums.empty_into(d, k);
  }
  sums.empty_into(d, k);
  work = k;
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(camera_sums);

void accumulate_camera(CameraKernel& work) { HWY_DYNAMIC_DISPATCH(camera_sums)(work); }

}  // namespace st
#endif
