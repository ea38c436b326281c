#include "algo/tracking/color_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/tracking/color_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "algo/tracking/pairing-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace pairing;

struct ColorPair {
  V model;   // luminance at the sub-pixel place, shift included
  V du, dv;  // its gradient
  M on;
};

HWY_INLINE ColorPair color_pair(D d, const ColorKernel& work, const Pair& pair, V luminance) {
  const DI di;
  const Pairing& k = work.pairing;
  ColorPair o;
  const VI slopes = word<3>(k, pair.record);
  const VI du = hn::ShiftRight<16>(hn::ShiftLeft<16>(slopes));
  const M known = hn::RebindMask(d, hn::Ne(du, hn::Set(di, kNoColor)));
  const M near = hn::Le(hn::Abs(hn::Sub(pair.q.z, pair.z)), hn::Set(d, work.gate_m));
  o.on = hn::And(hn::And(pair.on, hn::Ge(luminance, hn::Zero(d))), hn::And(known, near));
  const V per_slope = hn::Set(d, 1.0f / kGradientScale);
  o.du = hn::Mul(hn::ConvertTo(d, du), per_slope);
  o.dv = hn::Mul(high_half(d, slopes), per_slope);
  const V here = hn::Mul(high_half(d, word<2>(k, pair.record)), hn::Set(d, 1.0f / kLuminanceScale));
  o.model = hn::MulAdd(o.du, hn::Add(pair.du, hn::Set(d, work.shift_u)),
                       hn::MulAdd(o.dv, hn::Add(pair.dv, hn::Set(d, work.shift_v)), here));
  return o;
}

void color_sums(ColorKernel& work) {
  const D d;
  const Pairing& k = work.pairing;
  const V gain = hn::Set(d, work.gain), fx = hn::Set(d, k.fx), fy = hn::Set(d, k.fy);
  const int lanes = static_cast<int>(hn::Lanes(d));
  Sums<8> sums;
  sums.clear(d);
  for (int start = 0; start < k.count; start += kBlock) {
    const int end = start + kBlock < k.count ? start + kBlock : k.count;
    for (int i = start; i < end; i += lanes) {
      const Pair pair = pair_at(d, k, i);
      const V luminance = hn::LoadU(d, k.luminance + i);
      const ColorPair color = color_pair(d, work, pair, luminance);
      const V steep2 = hn::MulAdd(color.du, color.du, hn::Mul(color.dv, color.dv));
      const M on = hn::And(color.on, hn::Ge(steep2, hn::Set(d, work.least_gradient2)));
      if (hn::AllFalse(d, on)) continue;
      const V expected = hn::MulAdd(gain, color.model, hn::Set(d, work.offset));
      const V r = hn::IfThenElseZero(on, hn::Sub(luminance, expected));
      const V keep = hn::NegMulAdd(hn::Mul(r, r), hn::Set(d, work.per_cut2), hn::Set(d, 1.0f));
      const M used = hn::And(on, hn::Gt(keep, hn::Zero(d)));
      work.used += static_cast<int>(hn::CountTrue(d, used));
      const V w = hn::IfThenElseZero(used, hn::Mul(hn::Mul(keep, keep), hn::Set(d, work.weight)));
      // d(luminance of the model at q)/dq through the projection; q moves by -R_D^T (v + w x (p - c)).
      const V gu = hn::Mul(gain, color.du), gv = hn::Mul(gain, color.dv);
      const V x = hn::Mul(hn::Mul(gu, fx), pair.per_z), y = hn::Mul(hn::Mul(gv, fy), pair.per_z);
      const V z = hn::Neg(hn::Mul(hn::MulAdd(x, pair.q.x, hn::Mul(y, pair.q.y)), pair.per_z));
      V J[8];
      pose_jacobian(d, k, pair, {x, y, z}, J);
      J[6] = hn::Neg(gu);
      J[7] = hn::Neg(gv);
      sums.add(J, r, w);
    }
    sums.empty_into(d, work.triangle, work.gradient);
  }
}

void model_luminance(const ColorKernel& work, float* out) {
  const D d;
  const Pairing& k = work.pairing;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < k.count; i += lanes) {
    const ColorPair color = color_pair(d, work, pair_at(d, k, i), hn::LoadU(d, k.luminance + i));
    // A gradient may carry the value below nought; that is still a value.
    hn::StoreU(hn::IfThenElse(color.on, hn::Max(color.model, hn::Zero(d)), hn::Set(d, -1.0f)), d, out + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(color_sums);
HWY_EXPORT(model_luminance);

void accumulate_color(ColorKernel& work) { HWY_DYNAMIC_DISPATCH(color_sums)(work); }
void sample_luminance(const ColorKernel& work, float* out) {
  HWY_DYNAMIC_DISPATCH(model_luminance)(work, out);
}

}  // namespace st
#endif
