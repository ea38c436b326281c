#include "firmware_like/budget.hpp"

namespace st {

const StageBudget kStageBudgets[kStageCount] = {
    {Stage::kAcquire, 200, 200},   {Stage::kPreprocess, 2000, 4000}, {Stage::kSegment, 2500, 300},
    {Stage::kAssociate, 300, 100}, {Stage::kPredict, 100, 100},      {Stage::kRender, 2500, 12000},
    {Stage::kAlign, 4000, 9000},   {Stage::kJudge, 400, 400},        {Stage::kIntegrate, 3000, 6000},
    {Stage::kDecide, 400, 300},    {Stage::kSend, 200, 200},         {Stage::kPublish, 400, 400},
};

namespace {

constexpr float budget_us(const StageBudget& row, BudgetColumn column) {
  return column == BudgetColumn::kObject ? row.object_us : row.scan_us;
}

}  // namespace

BudgetMonitor::BudgetMonitor(BudgetColumn column, double period_s, bool wall_holds)
    : column_(column), period_us_(period_s * 1e6), wall_holds_(wall_holds) {}

void BudgetMonitor::bind(Bump& bump) {
  histograms_ = bump.take<LatencyHistogram>(kStageCount + 2);
  for (LatencyHistogram& histogram : histograms_) histogram.reset();
}

float BudgetMonitor::judged_us(const FrameReport& report) const {
  return wall_holds_ ? report.age_us + report.frame_us : report.cpu_us;
}

void BudgetMonitor::count(FrameReport& report) {
  ++counts_.frames;
  for (int i = 0; i < kStageCount; ++i) {
    if (report.stage_us[i] > budget_us(kStageBudgets[i], column_)) ++counts_.stage_overruns[i];
    histograms_[static_cast<std::size_t>(i)].add(report.stage_us[i]);
  }
  histograms_[kStageCount].add(report.frame_us);
  histograms_[kStageCount + 1].add(report.cpu_us);
  const float frame_budget_us =
      column_ == BudgetColumn::kObject ? kObjectFrameBudget_us : kScanFrameBudget_us;
  if (report.cpu_us > frame_budget_us) ++counts_.frame_overruns;
  if (report.age_us > kSlipLimit_us) ++counts_.slips;
  report.deadline_missed = judged_us(report) > period_us_;
  if (report.deadline_missed) ++counts_.deadline_misses;
}

}  // namespace st
