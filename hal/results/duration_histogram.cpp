#include "hal/results/duration_histogram.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace st {
namespace {

// Floating point with kBits of mantissa over whole tenths of a microsecond.
constexpr std::size_t kBits = 11;
constexpr std::uint64_t kLinear = std::uint64_t{1} << kBits;
constexpr std::uint64_t kHalf = kLinear / 2;
constexpr int kOctaves = 16;
constexpr double kUnitsPerUs = 10.0;

std::size_t bin_of(std::uint64_t units) {
  if (units < kLinear) return units;
  const std::size_t shift = std::bit_width(units) - kBits;
  return std::min<std::size_t>(kLinear + kHalf * (shift - 1) + ((units >> shift) - kHalf),
                               kLinear + kHalf * kOctaves - 1);
}

double value_of(std::size_t bin) {
  if (bin < kLinear) return static_cast<double>(bin) / kUnitsPerUs;
  const std::size_t shift = (bin - kLinear) / kHalf + 1;
  const double units = static_cast<double>((kHalf + (bin - kLinear) % kHalf) << shift);
  return (units + 0.5 * static_cast<double>(std::uint64_t{1} << shift)) / kUnitsPerUs;
}

}  // namespace

DurationHistogram::DurationHistogram() : bins_(kLinear + kHalf * kOctaves) {}

void DurationHistogram::add(double duration_us) {
  if (!(duration_us >= 0) || !std::isfinite(duration_us)) return;
  ++bins_[bin_of(static_cast<std::uint64_t>(std::min(duration_us, 1e8) * kUnitsPerUs + 0.5))];
  ++count_;
  max_us_ = std::max(max_us_, duration_us);
}

double DurationHistogram::percentile(double share) const {
  const std::uint64_t rank = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    below += bins_[bin];
    if (below >= rank && below > 0) return std::min(value_of(bin), max_us_);
  }
  return max_us_;
}

DurationSummary DurationHistogram::summary() const {
  return {percentile(0.50), percentile(0.99), percentile(0.999), max_us_};
}

}  // namespace st
