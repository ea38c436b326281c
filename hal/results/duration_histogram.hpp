// Percentiles of durations in fixed memory, however long the run.
#pragma once

#include <cstdint>
#include <vector>

namespace st {

struct DurationSummary {
  double p50_us = 0, p99_us = 0, p999_us = 0, max_us = 0;
};

// Bins of 0.1 us up to 200 us, then of 0.05 to 0.1 % of the value, up to 13 s; the maximum is exact.
class DurationHistogram {
 public:
  DurationHistogram();
  void add(double duration_us);
  std::uint64_t count() const { return count_; }
  DurationSummary summary() const;

 private:
  double percentile(double share) const;

  std::vector<std::uint32_t> bins_;
  std::uint64_t count_ = 0;
  double max_us_ = 0;
};

}  // namespace st
