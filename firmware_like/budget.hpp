// What every stage may take, and how often it took more. Two words, as ArduPilot's scheduler has them: an
// overrun took too long; a slip began too late, which is the fault of something else.
#pragma once

#include <cstdint>

#include "algo/core/records.hpp"

namespace st {

struct StageBudget {
  Stage stage;
  float object_us, scan_us;
};

// In the order of the stages. The columns add up to no more than the frame budgets below.
extern const StageBudget kStageBudgets[kStageCount];
inline constexpr float kObjectFrameBudget_us = 16000, kScanFrameBudget_us = 33000;

// A frame that waits longer than this between complete and taken up has slipped.
inline constexpr float kSlipLimit_us = 5000;

enum class BudgetColumn { kObject, kScan };

struct BudgetCounts {
  std::uint64_t frames = 0;
  std::uint64_t stage_overruns[kStageCount]{};
  std::uint64_t frame_overruns = 0;   // cpu_us beyond the frame budget
  std::uint64_t slips = 0;            // age_us beyond kSlipLimit_us
  std::uint64_t deadline_misses = 0;  // not done when the next frame was due
};

// Deadlines are judged on CPU time: a PC that is overloaded by something else would be blamed on the loop.
class BudgetMonitor {
 public:
  BudgetMonitor(BudgetColumn column, double period_s) : column_(column), period_us_(period_s * 1e6) {}

  // Counts the frame and sets report.deadline_missed. Takes the times of stages from the report. No heap.
  void count(FrameReport& report);

  const BudgetCounts& counts() const { return counts_; }

 private:
  BudgetColumn column_;
  double period_us_;
  BudgetCounts counts_;
};

}  // namespace st
