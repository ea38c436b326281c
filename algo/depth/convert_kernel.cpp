// The pattern for vector kernels: one file each, plain arrays in and out, nothing from Eigen or the standard
// library inside HWY_NAMESPACE (an inline function instantiated there would be compiled wide and could be the
// copy that the linker keeps for everybody), a scalar tail with the same arithmetic.
#include "algo/depth/convert_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/depth/convert_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Saturation does not change the outcome: a sum beyond 65535 is larger than any code.
void classify(const std::uint16_t* HWY_RESTRICT q, const std::uint16_t* HWY_RESTRICT background,
              const std::uint16_t* HWY_RESTRICT threshold, std::size_t count,
              std::uint8_t* HWY_RESTRICT out) {
  const hn::ScalableTag<std::uint16_t> d;
  const hn::RebindToSigned<decltype(d)> d_signed;
  const hn::Rebind<std::uint8_t, decltype(d)> d_byte;
  const auto zero = hn::Zero(d);
  const auto nearer_code = hn::Set(d, 1), farther_code = hn::Set(d, 2);
  const auto invalid_code = hn::Set(d, 3), no_background_code = hn::Set(d, 4);
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto now = hn::LoadU(d, q + i), b = hn::LoadU(d, background + i), t = hn::LoadU(d, threshold + i);
    // x > y for unsigned x, y is "x - y, stopped at zero, is not zero".
    const auto not_nearer = hn::Eq(hn::SaturatedSub(now, hn::SaturatedAdd(b, t)), zero);
    const auto not_farther = hn::Eq(hn::SaturatedSub(b, hn::SaturatedAdd(now, t)), zero);
    auto code = hn::IfThenElse(not_nearer, hn::IfThenElse(not_farther, zero, farther_code), nearer_code);
    code = hn::IfThenElse(hn::Eq(b, zero), no_background_code, code);
    code = hn::IfThenElse(hn::Eq(now, zero), invalid_code, code);
    hn::StoreU(hn::DemoteTo(d_byte, hn::BitCast(d_signed, code)), d_byte, out + i);
  }
  for (; i < count; ++i) {
    const int now = q[i], b = background[i], t = threshold[i];
    out[i] = now == 0 ? 3 : b == 0 ? 4 : now > b + t ? 1 : now + t < b ? 2 : 0;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(classify);

void classify_against_background(const std::uint16_t* q, const std::uint16_t* background,
                                 const std::uint16_t* threshold, std::size_t count, std::uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(classify)(q, background, threshold, count, out);
}

}  // namespace st
#endif
