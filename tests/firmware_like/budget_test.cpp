#include "firmware_like/budget.hpp"

#include <CppUTest/TestHarness.h>

#include <cstdint>
#include <vector>

using namespace st;

namespace {

constexpr double kPeriod_s = 1.0 / 30;

// A monitor on memory of its own.
struct Fixture {
  BudgetMonitor monitor;
  std::vector<std::uint64_t> storage;
  explicit Fixture(bool wall_holds) : monitor(BudgetColumn::kObject, kPeriod_s, wall_holds) {
    Bump measure;
    monitor.bind(measure);
    storage.resize(measure.used() / 8 + 16);
    Bump bump(storage.data(), storage.size() * 8);
    monitor.bind(bump);
  }
};

}  // namespace

TEST_GROUP(Budget){};

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
  Fixture f(false);
  FrameReport report;
  report.stage_us[static_cast<int>(Stage::kAlign)] = 4001;
  report.stage_us[static_cast<int>(Stage::kRender)] = 2500;
  f.monitor.count(report);
  UNSIGNED_LONGS_EQUAL(1, f.monitor.counts().stage_overruns[static_cast<int>(Stage::kAlign)]);
  UNSIGNED_LONGS_EQUAL(0, f.monitor.counts().stage_overruns[static_cast<int>(Stage::kRender)]);
  UNSIGNED_LONGS_EQUAL(0, f.monitor.counts().slips);
}

TEST(Budget, AFrameTakenUpLateIsASlipAndNoOverrun) {
  Fixture f(false);
  FrameReport report;
  report.age_us = 6000;
  report.cpu_us = 2000;
  f.monitor.count(report);
  UNSIGNED_LONGS_EQUAL(1, f.monitor.counts().slips);
  UNSIGNED_LONGS_EQUAL(0, f.monitor.counts().frame_overruns);
}

TEST(Budget, WithoutPriorityADeadlineIsJudgedOnCpuTime) {
  Fixture f(false);
  FrameReport report;
  report.cpu_us = 5000;
  report.frame_us = 90000;  // another program had the CPU
  f.monitor.count(report);
  CHECK(!report.deadline_missed);
  report.cpu_us = 34000;
  f.monitor.count(report);
  CHECK(report.deadline_missed);
  UNSIGNED_LONGS_EQUAL(1, f.monitor.counts().deadline_misses);
  UNSIGNED_LONGS_EQUAL(1, f.monitor.counts().frame_overruns);
}

TEST(Budget, WithPriorityItIsJudgedOnWallTimeFromTheFrameOn) {
  Fixture f(true);
  FrameReport report;
  report.cpu_us = 5000;
  report.frame_us = 30000;
  f.monitor.count(report);
  CHECK(!report.deadline_missed);
  report.age_us = 4000;
  f.monitor.count(report);
  CHECK(report.deadline_missed);
}

TEST(Budget, KeepsAHistogramOfEveryStageAndOfTheFrame) {
  Fixture f(false);
  FrameReport report;
  report.stage_us[static_cast<int>(Stage::kSegment)] = 700;
  report.frame_us = 3000;
  report.cpu_us = 2900;
  for (int i = 0; i < 10; ++i) f.monitor.count(report);
  UNSIGNED_LONGS_EQUAL(10, f.monitor.counts().frames);
  DOUBLES_EQUAL(700, f.monitor.stage(Stage::kSegment).percentile_us(0.5), 12);
  DOUBLES_EQUAL(3000, f.monitor.frame().max_us(), 0.01);
  DOUBLES_EQUAL(2900, f.monitor.cpu().max_us(), 0.01);
}
