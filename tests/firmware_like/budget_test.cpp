#include "firmware_like/budget.hpp"

#include <CppUTest/TestHarness.h>

using namespace st;

namespace {

constexpr double kPeriod_s = 1.0 / 30;

}  // namespace

TEST_GROUP(Budget) { BudgetMonitor monitor{BudgetColumn::kObject, kPeriod_s}; };

TEST(Budget, TheTableFollowsTheStagesAndFitsTheFrame) {
  float object_us = 0, scan_us = 0;
  for (int i = 0; i < kStageCount; ++i) {
    LONGS_EQUAL(i, static_cast<int>(kStageBudgets[i].stage));
    object_us += kStageBudgets[i].object_us;
    scan_us += kStageBudgets[i].scan_us;
  }
  CHECK(object_us <= kObjectFrameBudget_us);
  CHECK(scan_us <= kScanFrameBudget_us);
  CHECK(kScanFrameBudget_us <= kPeriod_s * 1e6);
}

TEST(Budget, AStageThatTakesTooLongIsAnOverrunOfThatStageOnly) {
  FrameReport report;
  report.stage_us[static_cast<int>(Stage::kAlign)] = 4001;
  report.stage_us[static_cast<int>(Stage::kRender)] = 2500;
  monitor.count(report);
  UNSIGNED_LONGS_EQUAL(1, monitor.counts().stage_overruns[static_cast<int>(Stage::kAlign)]);
  UNSIGNED_LONGS_EQUAL(0, monitor.counts().stage_overruns[static_cast<int>(Stage::kRender)]);
  UNSIGNED_LONGS_EQUAL(0, monitor.counts().slips);
}

TEST(Budget, AFrameTakenUpLateIsASlipAndNoOverrun) {
  FrameReport report;
  report.age_us = 6000;
  report.cpu_us = 2000;
  monitor.count(report);
  UNSIGNED_LONGS_EQUAL(1, monitor.counts().slips);
  UNSIGNED_LONGS_EQUAL(0, monitor.counts().frame_overruns);
}

TEST(Budget, ADeadlineIsJudgedOnCpuTime) {
  FrameReport report;
  report.cpu_us = 5000;
  report.frame_us = 90000;  // another program had the CPU
  monitor.count(report);
  CHECK(!report.deadline_missed);
  report.cpu_us = 34000;
  monitor.count(report);
  CHECK(report.deadline_missed);
  UNSIGNED_LONGS_EQUAL(1, monitor.counts().deadline_misses);
  UNSIGNED_LONGS_EQUAL(1, monitor.counts().frame_overruns);
}
