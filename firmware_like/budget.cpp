#include "firmware_like/budget.hpp"

namespace st {

const StageBudget kStageBudgets[kStageCount] = {
    {Stage::kAcquire, 200, 200}, {Stage::kPreprocess, 2000, 800}, {Stage::kSegment, 2500, 0},
    {Stage::kAssociate, 300, 0}, {Stage::kPredict, 100, 100},     {Stage::kRender, 2500, 11500},
    {Stage::kAlign, 4000, 9000}, {Stage::kJudge, 400, 100},       {Stage::kIntegrate, 3000, 10500},
    {Stage::kDecide, 400, 300},  {Stage::kSend, 200, 0},          {Stage::kPublish, 400, 400},
};

namespace {

constexpr float budget_us(const StageBudget& row, BudgetColumn column) {
  return column == BudgetColumn::kObject ? row.object_us : row.scan_us;
}

}  // namespace

void BudgetMonitor::count(FrameReport& report) {
  ++counts_.frames;
  for (int i = 0; i < kStageCount; ++i)
    if (report.stage_us[i] > budget_us(kStageBudgets[i], column_)) ++counts_.stage_overruns[i];
  const float frame_budget_us =
      column_ == BudgetColumn::kObject ? kObjectFrameBudget_us : kScanFrameBudget_us;
  if (report.cpu_us > frame_budget_us) ++counts_.frame_overruns;
  if (report.age_us > kSlipLimit_us) ++counts_.slips;
  report.deadline_missed = report.cpu_us > period_us_;
  if (report.deadline_missed) ++counts_.deadline_misses;
}

}  // namespace st
