// Random numbers that are the same on every machine: xoshiro128++ seeded by SplitMix64, no <random>
// distributions (their sequences are left to the library).
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "algo/core/scalar_math.hpp"

namespace st::sim {

// One step of SplitMix64; also a good hash of a 64-bit number.
constexpr std::uint64_t mix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

class Random {
 public:
  // `stream` tells apart generators of one seed, so that one more draw in one place shifts nothing elsewhere.
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0) {
    std::uint64_t x = mix64(seed ^ mix64(stream + 0x51ed2701));
    for (int i = 0; i < 4; i += 2) {
      x = mix64(x);
      state_[i] = static_cast<std::uint32_t>(x);
      state_[i + 1] = static_cast<std::uint32_t>(x >> 32) | 1u;
    }
  }

  std::uint32_t bits() {
    const std::uint32_t result = std::rotl(state_[0] + state_[3], 7) + state_[0];
    const std::uint32_t t = state_[1] << 9;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= t;
    state_[3] = std::rotl(state_[3], 11);
    return result;
  }
  double uniform() { return bits() * (1.0 / 4294967296.0); }  // [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  int below(int n) {
    return static_cast<int>((static_cast<std::uint64_t>(bits()) * static_cast<std::uint64_t>(n)) >> 32);
  }
  // Standard normal, by Box and Muller.
  double normal() {
    const double u = (bits() + 1.0) * (1.0 / 4294967297.0);
    return std::sqrt(-2.0 * natural_log(u)) * sin_cos(2 * kPi * uniform()).cos;
  }

 private:
  std::uint32_t state_[4];
};

}  // namespace st::sim
