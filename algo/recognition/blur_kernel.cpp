#include "algo/recognition/blur_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/recognition/blur_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// No fused multiply-add: every target gives the same bits.
void blur(const float* const* rows, const float* taps, int radius, std::size_t count, float* out) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    auto sum = hn::Mul(hn::Set(d, taps[0]), hn::LoadU(d, rows[0] + i));
    for (int k = 1; k <= radius; ++k)
      sum = hn::Add(
          sum, hn::Mul(hn::Set(d, taps[k]), hn::Add(hn::LoadU(d, rows[-k] + i), hn::LoadU(d, rows[k] + i))));
    hn::StoreU(sum, d, out + i);
  }
  for (; i < count; ++i) {
    float sum = taps[0] * rows[0][i];
    for (int k = 1; k <= radius; ++k) sum += taps[k] * (rows[-k][i] + rows[k][i]);
    out[i] = sum;
  }
}

float largest(const float* a, const float* b, std::size_t count) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  auto most = hn::Zero(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes)
    most = hn::Max(most, hn::Abs(hn::Sub(hn::LoadU(d, b + i), hn::LoadU(d, a + i))));
  float m = hn::GetLane(hn::MaxOfLanes(d, most));
  for (; i < count; ++i) {
    const float difference = b[i] > a[i] ? b[i] - a[i] : a[i] - b[i];
    if (difference > m) m = difference;
  }
  return m;
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(blur);
HWY_EXPORT(largest);

void blur_row(const float* const* rows, const float* taps, int radius, std::size_t count, float* out) {
  HWY_DYNAMIC_DISPATCH(blur)(rows, taps, radius, count, out);
}

float largest_difference(const float* a, const float* b, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(largest)(a, b, count);
}

}  // namespace st
#endif
