// Studies that take too long for a test and are printed for a person: startrack_campaign NAME.
#pragma once

#include <cstdint>

namespace st::campaign {

inline constexpr std::uint64_t kSeeds = 2;  // rooms, cameras and noises that every figure is taken over

void print_convergence();
void print_fusion();

}  // namespace st::campaign
