// Which instruction set the vector kernels run on. Highway compiles every kernel for all of them and picks at
// run time; results may differ in the last bit between two sets, so `--simd NAME` is part of what makes a
// replay repeatable. The choice is one per process and is made before the loop starts.
#pragma once

#include "algo/core/fixed_vector.hpp"

namespace st {

inline constexpr int kSimdTargets = 4;

enum class SimdChoice { kDone, kUnknownName, kNotOnThisCpu };

// "SSSE3", "SSE4", "AVX2", "AVX3": all of them, and those that this CPU runs; narrowest first.
FixedVector<const char*, kSimdTargets> all_simd();
FixedVector<const char*, kSimdTargets> supported_simd();

// From now on kernels use the named set; nullptr or "": the best that this CPU has. Without a call kernels
// use the best, but the first kernel then pays for asking the CPU.
SimdChoice select_simd(const char* name);

// The set that kernels use now.
const char* simd_name();

}  // namespace st
