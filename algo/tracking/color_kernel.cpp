#include "algo/tracking/color_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/tracking/color_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "algo/tracking/sums-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace sums;

// A point of the model, and what the image shows where it falls.
struct Sight {
  Vec then, q;          // in the depth camera's frame then, and in the colour camera's
  V per_z;              // 1 / q.z; 0 for lanes that are off
  V luminance, du, dv;  // at the sub-pixel place, shift included; slopes per pixel
  M on;
};

HWY_INLINE VI word(const ColorKernel& k, VI record, int w) {
  const DI di;
  return hn::GatherIndex(di, reinterpret_cast<const std::int32_t*>(k.frame) + w, hn::ShiftLeft<1>(record));
}
HWY_INLINE V low_half(D d, VI w) { return hn::ConvertTo(d, hn::ShiftRight<16>(hn::ShiftLeft<16>(w))); }
HWY_INLINE V high_half(D d, VI w) { return hn::ConvertTo(d, hn::ShiftRight<16>(w)); }

// Points first .. first + lanes; those from count on are off.
HWY_INLINE Sight sight_of(D d, const ColorKernel& k, int first) {
  const DI di;
  Sight o;
  const Vec p{hn::LoadU(d, k.x + first), hn::LoadU(d, k.y + first), hn::LoadU(d, k.z + first)};
  o.then = moved(d, k.to_then, k.then_at, p);
  o.q = moved(d, k.to_color, k.color_at, o.then);
  const M there =
      hn::And(hn::Gt(o.q.z, hn::Set(d, 0.1f)), hn::FirstN(d, static_cast<std::size_t>(k.count - first)));
  o.per_z = hn::IfThenElseZero(there, hn::Div(hn::Set(d, 1.0f), o.q.z));
  const V u = hn::MulAdd(hn::Mul(hn::Set(d, k.fx), o.q.x), o.per_z, hn::Set(d, k.cx + k.shift_u));
  const V v = hn::MulAdd(hn::Mul(hn::Set(d, k.fy), o.q.y), o.per_z, hn::Set(d, k.cy + k.shift_v));
  const V pu = hn::Floor(hn::Add(u, hn::Set(d, 0.5f))), pv = hn::Floor(hn::Add(v, hn::Set(d, 0.5f)));
  const V zero = hn::Zero(d);
  const M across = hn::And(hn::Ge(pu, zero), hn::Lt(pu, hn::Set(d, static_cast<float>(k.width))));
  const M down = hn::And(hn::Ge(pv, zero), hn::Lt(pv, hn::Set(d, static_cast<float>(k.height))));
  const M inside = hn::And(there, hn::And(across, down));
  // Exact in float: an image has far fewer than 2^24 pixels.
  const V at = hn::Add(hn::MulAdd(pv, hn::Set(d, static_cast<float>(k.width)), pu), hn::Set(d, 1.0f));
  const VI record = hn::ConvertTo(di, hn::IfThenElseZero(inside, at));
  const V scale = hn::Set(d, 1.0f / kLuminanceScale);
  const VI grey = hn::ShiftRight<16>(hn::ShiftLeft<16>(word(k, record, 0))), slopes = word(k, record, 1);
  o.on = hn::RebindMask(d, hn::Ne(grey, hn::Set(di, kNoColor)));
  o.du = hn::Mul(low_half(d, slopes), scale);
  o.dv = hn::Mul(high_half(d, slopes), scale);
  o.luminance = hn::MulAdd(o.du, hn::Sub(u, pu),
                           hn::MulAdd(o.dv, hn::Sub(v, pv), hn::Mul(hn::ConvertTo(d, grey), scale)));
  return o;
}

void color_sums(ColorKernel& k) {
  const D d;
  const V fx = hn::Set(d, k.fx), fy = hn::Set(d, k.fy);
  const int lanes = static_cast<int>(hn::Lanes(d));
  Sums<8> sums;
  sums.clear(d);
  for (int start = 0; start < k.count; start += kBlock) {
    const int end = start + kBlock < k.count ? start + kBlock : k.count;
    for (int i = start; i < end; i += lanes) {
      const Sight s = sight_of(d, k, i);
      const V steep2 = hn::MulAdd(s.du, s.du, hn::Mul(s.dv, s.dv));
      const M on = hn::And(s.on, hn::Ge(steep2, hn::Set(d, k.least_gradient2)));
      if (hn::AllFalse(d, on)) continue;
      const V expected = hn::MulAdd(hn::Set(d, k.gain), hn::LoadU(d, k.luminance + i), hn::Set(d, k.offset));
      const V r = hn::IfThenElseZero(on, hn::Sub(s.luminance, expected));
      const V keep = hn::NegMulAdd(hn::Mul(r, r), hn::Set(d, k.per_cut2), hn::Set(d, 1.0f));
      const M used = hn::And(on, hn::Gt(keep, hn::Zero(d)));
      k.used += static_cast<int>(hn::CountTrue(d, used));
      const V w = hn::IfThenElseZero(used, hn::Mul(hn::Mul(keep, keep), hn::Set(d, k.weight)));
      // d(luminance)/dq through the projection; then is moved by v + w x (then - pivot).
      const V x = hn::Mul(hn::Mul(s.du, fx), s.per_z), y = hn::Mul(hn::Mul(s.dv, fy), s.per_z);
      const V z = hn::Neg(hn::Mul(hn::MulAdd(x, s.q.x, hn::Mul(y, s.q.y)), s.per_z));
      const Vec N = turned_back(d, k.to_color, {x, y, z});
      const Vec arm{hn::Sub(s.then.x, hn::Set(d, k.pivot[0])), hn::Sub(s.then.y, hn::Set(d, k.pivot[1])),
                    hn::Sub(s.then.z, hn::Set(d, k.pivot[2]))};
      const Vec moment = crossed(arm, N);
      const V J[8] = {N.x, N.y, N.z, moment.x, moment.y, moment.z, s.du, s.dv};
      sums.add(J, r, w);
    }
    sums.empty_into(d, k.triangle, k.gradient);
  }
}

void image_luminance(const ColorKernel& k, float* out) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < k.count; i += lanes) {
    const Sight s = sight_of(d, k, i);
    // A slope may carry the value below nought; that is still a value.
    hn::StoreU(hn::IfThenElse(s.on, hn::Max(s.luminance, hn::Zero(d)), hn::Set(d, -1.0f)), d, out + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(color_sums);
HWY_EXPORT(image_luminance);

void accumulate_color(ColorKernel& work) { HWY_DYNAMIC_DISPATCH(color_sums)(work); }
void sample_luminance(const ColorKernel& work, float* out) {
  HWY_DYNAMIC_DISPATCH(image_luminance)(work, out);
}

}  // namespace st
#endif
