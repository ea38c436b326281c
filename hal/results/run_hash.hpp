// The fingerprint of what a run computed.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace st {

// 64-bit FNV-1a, continued from `hash`.
inline constexpr std::uint64_t kFnvStart = 0xcbf29ce484222325ull;
std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = kFnvStart);

// Over the contents of the run's result files that end in .tum, .csv (but timing.csv) and .ply, one after the
// other in the byte order of their names; the names themselves do not count. 16 hexadecimal digits. Throws
// Failure.
std::string deterministic_hash(const std::string& run_folder);

}  // namespace st
