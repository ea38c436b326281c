#include "hal/results/telemetry.hpp"

#include <CppUTest/TestHarness.h>

#include <memory>
#include <vector>

using namespace st;

namespace {

class Collector final : public TelemetrySink {
 public:
  void take(const FrameReport& report) override { seen.push_back(report.index); }
  void flush() override { ++flushes; }
  std::vector<std::uint64_t> seen;
  int flushes = 0;
};

}  // namespace

TEST_GROUP(Telemetry) {
  ReportRing ring;
  std::vector<std::uint8_t> memory;

  void bind(std::size_t slots) {
    Bump measure;
    ReportRing probe;
    probe.bind(measure, slots);
    memory.resize(measure.used() + Bump::kAlign);
    void* at = memory.data();
    std::size_t room = memory.size();
    std::align(Bump::kAlign, measure.used(), at, room);
    Bump bump(at, room);
    ring.bind(bump, slots);
  }
  static FrameReport report(std::uint64_t index) {
    FrameReport r;
    r.index = index;
    return r;
  }
};

TEST(Telemetry, ARingThatIsFullRefusesAndKeepsWhatItHas) {
  bind(4);
  for (std::uint64_t i = 0; i < 4; ++i) CHECK(ring.push(report(i)));
  CHECK_FALSE(ring.has_room());
  CHECK_FALSE(ring.push(report(4)));
  UNSIGNED_LONGS_EQUAL(0, ring.front()->index);
  ring.pop();
  CHECK(ring.push(report(5)));
  for (const std::uint64_t expected : {1, 2, 3, 5}) {
    UNSIGNED_LONGS_EQUAL(expected, ring.front()->index);
    ring.pop();
  }
  POINTERS_EQUAL(nullptr, ring.front());
  UNSIGNED_LONGS_EQUAL(4, ring.high_water());
}

TEST(Telemetry, AReplayThatWaitsForRoomLosesNothing) {
  bind(8);
  Collector collector;
  Telemetry telemetry(ring, {&collector});
  telemetry.start();
  constexpr std::uint64_t kReports = 500;
  for (std::uint64_t i = 0; i < kReports; ++i) {
    telemetry.wait_for_room();
    CHECK(telemetry.offer(report(i)));
  }
  telemetry.stop();
  UNSIGNED_LONGS_EQUAL(kReports, collector.seen.size());
  for (std::uint64_t i = 0; i < kReports; ++i) UNSIGNED_LONGS_EQUAL(i, collector.seen[i]);
  UNSIGNED_LONGS_EQUAL(0, telemetry.dropped());
  CHECK(collector.flushes > 0);
}

TEST(Telemetry, ALiveRunDropsAndCountsWhenTheRingIsFull) {
  bind(2);
  Telemetry telemetry(ring, {});  // not started: nobody empties the ring
  for (std::uint64_t i = 0; i < 5; ++i) telemetry.offer(report(i));
  UNSIGNED_LONGS_EQUAL(3, telemetry.dropped());
}

TEST(Telemetry, StopHandsOnWhatWasPushedJustBefore) {
  bind(16);
  Collector collector;
  Telemetry telemetry(ring, {&collector});
  telemetry.start();
  for (std::uint64_t i = 0; i < 10; ++i) telemetry.offer(report(i));
  telemetry.stop();
  UNSIGNED_LONGS_EQUAL(10, collector.seen.size());
}
