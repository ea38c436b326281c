// How long something took, over a run of any length, in fixed memory. Bins widen with the value, so that a
// percentile is never understated and overstated by less than 1/64.
#pragma once

#include <cstddef>
#include <cstdint>

namespace st {

class LatencyHistogram {
 public:
  void reset();
  void add(double us);  // negative and not-a-number count as 0

  std::uint64_t count() const { return count_; }
  double max_us() const { return static_cast<double>(max_ns_) * 1e-3; }  // exact to the nanosecond
  // The smallest bin edge that at least `share` (0-1) of the values do not exceed; 0 without values.
  double percentile_us(double share) const;

 private:
  static constexpr int kBinsPerOctave = 64;
  static constexpr int kOctaves =
      34;  // up to 2^40 ns, 18 minutes; longer ones count in the last bin and in max
  static constexpr std::size_t kBins = static_cast<std::size_t>(kBinsPerOctave) * (kOctaves + 1);

  static std::size_t bin_of(std::uint64_t ns);
  static std::uint64_t upper_edge_ns(std::size_t bin);

  std::uint32_t bins_[kBins]{};
  std::uint64_t count_ = 0;
  std::uint64_t max_ns_ = 0;
};

}  // namespace st
