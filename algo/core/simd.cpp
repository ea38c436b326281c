#include "algo/core/simd.hpp"

#include <hwy/targets.h>

#include <cstdint>
#include <cstring>

namespace st {
namespace {

struct Target {
  const char* name;
  std::int64_t bit;
};

constexpr Target kTargets[kSimdTargets] = {
    {"SSSE3", HWY_SSSE3}, {"SSE4", HWY_SSE4}, {"AVX2", HWY_AVX2}, {"AVX3", HWY_AVX3}};

// What the CPU itself has, whatever was selected before.
std::int64_t cpu_targets() {
  hwy::SetSupportedTargetsForTest(0);
  return hwy::SupportedTargets();
}

// The named set and all narrower ones: a kernel that was not compiled for the first falls back to the next.
void use_up_to(int index) {
  std::int64_t mask = 0;
  for (int i = 0; i <= index; ++i) mask |= kTargets[i].bit;
  hwy::SetSupportedTargetsForTest(mask);
  hwy::GetChosenTarget().Update(
      hwy::SupportedTargets());  // now, so that no kernel asks the CPU inside the loop
}

int index_in_use(std::int64_t mask) {
  int best = 0;
  for (int i = 0; i < kSimdTargets; ++i)
    if ((mask & kTargets[i].bit) != 0) best = i;
  return best;
}

}  // namespace

FixedVector<const char*, kSimdTargets> all_simd() {
  FixedVector<const char*, kSimdTargets> names;
  for (const Target& target : kTargets) names.push_back(target.name);
  return names;
}

FixedVector<const char*, kSimdTargets> supported_simd() {
  const int in_use = index_in_use(hwy::SupportedTargets());
  const std::int64_t cpu = cpu_targets();
  use_up_to(in_use);
  FixedVector<const char*, kSimdTargets> names;
  for (const Target& target : kTargets)
    if ((cpu & target.bit) != 0) names.push_back(target.name);
  return names;
}

SimdChoice select_simd(const char* name) {
  const FixedVector<const char*, kSimdTargets> supported = supported_simd();
  const bool best = name == nullptr || name[0] == '\0';
  for (int i = kSimdTargets - 1; i >= 0; --i) {
    if (!best && std::strcmp(name, kTargets[i].name) != 0) continue;
    bool on_this_cpu = false;
    for (const char* have : supported) on_this_cpu = on_this_cpu || have == kTargets[i].name;
    if (!on_this_cpu && best) continue;
    if (!on_this_cpu) return SimdChoice::kNotOnThisCpu;
    use_up_to(i);
    return SimdChoice::kDone;
  }
  return SimdChoice::kUnknownName;
}

const char* simd_name() { return kTargets[index_in_use(hwy::SupportedTargets())].name; }

}  // namespace st
