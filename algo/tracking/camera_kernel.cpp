#include "algo/tracking/camera_kernel.hpp"

#include "algo/tracking/model_view.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/tracking/camera_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "algo/tracking/point_plane-inl.hpp"
#include "algo/tracking/sums-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;
using Vec = sums::VecOf<V>;

constexpr int kRows = 4;  // of the image between two emptyings of the float sums into double ones

// What the rows of the Jacobian need of the present pixels: the point and the normal of its partner, and the
// residual along it.
struct Pairs {
  Vec p;    // the point, view frame
  Vec n;    // normal of the surface
  V r;      // n . (p - q), metres
  V sigma;  // axial noise of a reading at that depth
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
  o.p.x = hn::MulAdd(hn::MulAdd(along_x[0], rx, origin[0]), depth, hn::Set(d, k.t[0]));
  o.p.y = hn::MulAdd(hn::MulAdd(along_x[1], rx, origin[1]), depth, hn::Set(d, k.t[1]));
  o.p.z = hn::MulAdd(hn::MulAdd(along_x[2], rx, origin[2]), depth, hn::Set(d, k.t[2]));
  const M before = hn::And(has, hn::Gt(o.p.z, hn::Set(d, 0.1f)));
  const V per_z = hn::Div(hn::Set(d, 1.0f), hn::IfThenElse(before, o.p.z, hn::Set(d, 1.0f)));
  const V pu = hn::MulAdd(hn::Mul(o.p.x, per_z), hn::Set(d, k.view_fx), hn::Set(d, k.view_cx + 0.5f));
  const V pv = hn::MulAdd(hn::Mul(o.p.y, per_z), hn::Set(d, k.view_fy), hn::Set(d, k.view_cy + 0.5f));
  // Comparisons are false for NaN, and the index is made only where they hold.
  const M across = hn::And(hn::Ge(pu, hn::Zero(d)), hn::Lt(pu, hn::Set(d, static_cast<float>(k.view_width))));
  const M down = hn::And(hn::Ge(pv, hn::Zero(d)), hn::Lt(pv, hn::Set(d, static_cast<float>(k.view_height))));
  const M inside = hn::And(before, hn::And(across, down));
  const VI iu = hn::ConvertTo(di, hn::IfThenElseZero(inside, pu)),
           iv = hn::ConvertTo(di, hn::IfThenElseZero(inside, pv));
  const VI at = hn::Add(hn::Mul(iv, hn::Set(di, k.view_stride)), iu);
  const V qz = hn::GatherIndex(d, k.view_z, at);
  const V gx = hn::NegMulAdd(
      hn::Mul(hn::Sub(hn::ConvertTo(d, iu), hn::Set(d, k.view_cx)), hn::Set(d, 1.0f / k.view_fx)), qz, o.p.x);
  const V gy = hn::NegMulAdd(
      hn::Mul(hn::Sub(hn::ConvertTo(d, iv), hn::Set(d, k.view_cy)), hn::Set(d, 1.0f / k.view_fy)), qz, o.p.y);
  const V gz = hn::Sub(o.p.z, qz);
  const V distance2 = hn::MulAdd(gx, gx, hn::MulAdd(gy, gy, hn::Mul(gz, gz)));
  o.sigma = point_plane::axial_sigma(d, o.p.z);
  const M facing = hn::And(inside, hn::Gt(qz, hn::Zero(d)));
  k.facing += static_cast<int>(hn::CountTrue(d, facing));
  o.on = hn::And(facing, point_plane::in_reach(d, distance2, o.sigma, k.gate2_m2));
  const VI packed = hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(k.view_normal), at);
  const V unit = hn::Set(d, 1.0f / kNormalScale);
  o.n.x = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(packed))), unit);
  o.n.y = hn::Mul(hn::ConvertTo(d, hn::ShiftRight<16>(packed)), unit);
  const V rest = hn::NegMulAdd(o.n.x, o.n.x, hn::NegMulAdd(o.n.y, o.n.y, hn::Set(d, 1.0f)));
  o.n.z = hn::Neg(hn::Sqrt(hn::Max(rest, hn::Zero(d))));
  o.r = hn::IfThenElseZero(o.on, hn::MulAdd(o.n.x, gx, hn::MulAdd(o.n.y, gy, hn::Mul(o.n.z, gz))));
  return o;
}

void camera_sums(CameraKernel& work) {
  // A copy that no store through a pointer can change: its values stay in registers.
  CameraKernel k = work;
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const V half_pixel = hn::Set(d, 0.5f / k.view_fx);
  V square = hn::Zero(d);
  sums::SumsOf<D, 6> all;
  all.clear(d);
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
      const auto weighed = point_plane::weigh(d, p.r, p.n.z, p.p.z, p.sigma, half_pixel, k.robust2, p.on);
      const V w =
          hn::IfThenElseZero(p.on, hn::Mul(hn::Mul(weighed.keep, weighed.keep), weighed.per_variance));
      // d r / d (v, w) for p' = p + v + w x p.
      const Vec moment = sums::crossed(p.p, p.n);
      const V J[6] = {p.n.x, p.n.y, p.n.z, moment.x, moment.y, moment.z};
      k.inliers += static_cast<int>(hn::CountTrue(d, weighed.inlier));
      square = hn::Add(square, hn::IfThenElseZero(weighed.inlier, weighed.r2));
      all.add(J, p.r, w);
    }
    if (v % kRows == kRows - 1 || v == k.height - 1) {
      all.empty_into(d, k.triangle, k.gradient);
      k.square_sum += sums::sum(d, square);
      square = hn::Zero(d);
    }
  }
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
