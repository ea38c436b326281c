// timing.csv and events.csv: what the loop did and what happened to the data.
#pragma once

#include <string>

#include "algo/core/records.hpp"
#include "hal/results/duration_histogram.hpp"

namespace st {

std::string timing_columns();  // t,frame,<stage>_us...,frame_us,cpu_us,level,age_us
inline constexpr const char* kEventColumns = "t,event,object,a,b,c";

void append_timing_row(std::string& out, const FrameReport& report);
void append_event_row(std::string& out, const Event& event);

// The distribution of every column of timing.csv that is a duration of the loop.
struct TimingSummary {
  DurationSummary frame, cpu, stages[kStageCount];
};

class TimingStatistics {
 public:
  void take(const FrameReport& report);
  TimingSummary summary() const;

 private:
  DurationHistogram frame_, cpu_, stages_[kStageCount];
};

}  // namespace st
