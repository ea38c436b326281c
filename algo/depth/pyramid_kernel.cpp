#include "algo/depth/pyramid_kernel.hpp"

#include "algo/depth/edge_step.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/depth/pyramid_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr float kNothing = 1e9f;

// Any width of vector, also one lane for the end of a row: the same arithmetic.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V mean_of_surface(D d, V a, V b, V c, V e) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), far = hn::Set(d, kNothing);
  const auto or_far = [&](V x) HWY_ATTR { return hn::IfThenElse(hn::Gt(x, zero), x, far); };
  const V four[4] = {or_far(a), or_far(b), or_far(c), or_far(e)};
  const V nearest = hn::Min(hn::Min(four[0], four[1]), hn::Min(four[2], four[3]));
  const V limit =
      hn::Add(nearest, hn::Add(hn::Set(d, kEdgeStep_m),
                               hn::Mul(hn::Set(d, kEdgeStepPerSquare_per_m), hn::Mul(nearest, nearest))));
  V sum = zero, count = zero;
  for (const V& x : four) {
    const auto same = hn::And(hn::Lt(x, far), hn::Le(x, limit));
    sum = hn::Add(sum, hn::IfThenElseZero(same, x));
    count = hn::Add(count, hn::IfThenElseZero(same, one));
  }
  return hn::IfThenElseZero(hn::Gt(count, zero), hn::Div(sum, hn::Max(count, one)));
}

void halve(const float* HWY_RESTRICT fine, int fine_width, float* HWY_RESTRICT coarse, int width,
           int height) {
  const hn::ScalableTag<float> d;
  const hn::CappedTag<float, 1> d1;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int v = 0; v < height; ++v) {
    const float* upper = fine + static_cast<std::ptrdiff_t>(2 * v) * fine_width;
    const float* lower = upper + fine_width;
    float* out = coarse + static_cast<std::ptrdiff_t>(v) * width;
    int u = 0;
    for (; u + lanes <= width; u += lanes) {
      hn::Vec<decltype(d)> a, b, c, e;
      hn::LoadInterleaved2(d, upper + 2 * u, a, b);
      hn::LoadInterleaved2(d, lower + 2 * u, c, e);
      hn::StoreU(mean_of_surface(d, a, b, c, e), d, out + u);
    }
    for (; u < width; ++u) {
      const auto at = [&](const float* p) HWY_ATTR { return hn::Set(d1, *p); };
      hn::StoreU(mean_of_surface(d1, at(upper + 2 * u), at(upper + 2 * u + 1), at(lower + 2 * u),
                                 at(lower + 2 * u + 1)),
                 d1, out + u);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(halve);

void halve_depth(const float* fine, int fine_width, float* coarse, int coarse_width, int coarse_height) {
  HWY_DYNAMIC_DISPATCH(halve)(fine, fine_width, coarse, coarse_width, coarse_height);
}

}  // namespace st
#endif
