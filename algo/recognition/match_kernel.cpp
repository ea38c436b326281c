#include "algo/recognition/match_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "algo/recognition/match_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Whole numbers: the order of the sum does not matter, every target gives the same.
std::uint32_t distance(const std::uint8_t* HWY_RESTRICT a, const std::uint8_t* HWY_RESTRICT b,
                       std::size_t count) {
  const hn::ScalableTag<std::int16_t> d16;
  const hn::Rebind<std::uint8_t, decltype(d16)> d8;
  const hn::RepartitionToWide<decltype(d16)> d32;
  auto even = hn::Zero(d32), odd = hn::Zero(d32);
  const std::size_t lanes = hn::Lanes(d16);
  for (std::size_t i = 0; i < count; i += lanes) {
    const auto difference =
        hn::Sub(hn::PromoteTo(d16, hn::LoadU(d8, a + i)), hn::PromoteTo(d16, hn::LoadU(d8, b + i)));
    even = hn::ReorderWidenMulAccumulate(d32, difference, difference, even, odd);
  }
  return static_cast<std::uint32_t>(hn::GetLane(hn::SumOfLanes(d32, hn::Add(even, odd))));
}

}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace st {

HWY_EXPORT(distance);

std::uint32_t squared_distance(const std::uint8_t* a, const std::uint8_t* b, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(distance)(a, b, count);
}

}  // namespace st
#endif
