#include "firmware_like/latency_histogram.hpp"

#include <bit>
#include <cmath>

namespace st {

void LatencyHistogram::reset() { *this = LatencyHistogram{}; }

// Below 64 ns a bin each; above, 64 bins between a power of two and the next.
std::size_t LatencyHistogram::bin_of(std::uint64_t ns) {
  if (ns < kBinsPerOctave) return static_cast<std::size_t>(ns);
  const int octave = static_cast<int>(std::bit_width(ns)) - 7;  // 64 to 127 ns is octave 0
  if (octave >= kOctaves) return kBins - 1;
  return static_cast<std::size_t>(kBinsPerOctave) * static_cast<std::size_t>(octave) +
         static_cast<std::size_t>(ns >> octave);
}

std::uint64_t LatencyHistogram::upper_edge_ns(std::size_t bin) {
  if (bin < kBinsPerOctave) return bin;
  const std::size_t octave = bin / kBinsPerOctave - 1;
  return ((static_cast<std::uint64_t>(bin % kBinsPerOctave) + kBinsPerOctave + 1) << octave) - 1;
}

void LatencyHistogram::add(double us) {
  constexpr double kLongest_us = 1e12;
  const double clamped = us > 0 ? (us < kLongest_us ? us : kLongest_us) : 0.0;
  const auto ns = static_cast<std::uint64_t>(std::llround(clamped * 1e3));
  ++bins_[bin_of(ns)];
  ++count_;
  if (ns > max_ns_) max_ns_ = ns;
}

double LatencyHistogram::percentile_us(double share) const {
  if (count_ == 0) return 0;
  // Nearest rank: the value with at least `share` of all values at or below it.
  auto rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  if (rank < 1) rank = 1;
  std::uint64_t seen = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    seen += bins_[bin];
    if (seen < rank) continue;
    const std::uint64_t edge = bin + 1 == kBins ? max_ns_ : upper_edge_ns(bin);
    return static_cast<double>(edge < max_ns_ ? edge : max_ns_) * 1e-3;
  }
  return max_us();
}

}  // namespace st
