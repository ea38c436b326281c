// Whatever happens, the robot stands within the time that the safety rules state: real processes on a
// simulated robot.
#include "tests/support/provocations.hpp"

#include <set>

// Last: it redefines new.
#include <CppUTest/TestHarness.h>

using namespace st;
using namespace st::test;

namespace {

// The best of three, since this machine may be busy; a robot that drives on fails all three.
void check_rule(const char* rule) {
  int tried = 0;
  for (const Provocation& what : provocations()) {
    if (std::string(what.rule) != rule) continue;
    ++tried;
    const SafetyRow& row = row_named(rule);
    Outcome best;
    for (int attempt = 0; attempt < 3; ++attempt) {
      const Outcome outcome = provoke(what, 100 * attempt);
      if (!outcome.drove) continue;
      CHECK_TEXT(outcome.stood_ms >= 0, what.name);
      if (what.exit_code != kAny) LONGS_EQUAL_TEXT(what.exit_code, outcome.exit_code, what.name);
      if (!best.drove || outcome.stood_ms < best.stood_ms) best = outcome;
      if (best.stood_ms <= row.stands_within_ms) break;
    }
    CHECK_TEXT(best.drove, what.name);
    CHECK_TEXT(best.stood_ms <= row.stands_within_ms, what.name);
    UT_PRINT(
        StringFromFormat("%s: stands after %.0f ms and %.0f mm", what.name, best.stood_ms, 1000 * best.way_m)
            .asCharString());
  }
  CHECK_TEXT(tried > 0, rule);
}

}  // namespace

TEST_GROUP(StandingRobot){};

TEST(StandingRobot, EveryRuleIsProvoked) {
  std::set<std::string> rules;
  for (const Provocation& what : provocations()) rules.insert(what.rule);
  for (const SafetyRow& row : safety_rules()) CHECK_TEXT(rules.count(row.name) == 1, row.name);
  UNSIGNED_LONGS_EQUAL(safety_rules().size(), rules.size());
}

TEST(StandingRobot, AtACliff) { check_rule("cliff"); }
TEST(StandingRobot, WithAWheelInTheAir) { check_rule("wheel_drop"); }
TEST(StandingRobot, AfterABump) { check_rule("bump"); }
TEST(StandingRobot, OutOfSafeMode) { check_rule("left_safe_mode"); }
TEST(StandingRobot, WithAnEmptyBattery) { check_rule("low_battery"); }
TEST(StandingRobot, WhenItIsSilent) { check_rule("silent"); }
TEST(StandingRobot, WhenItsCableIsBack) { check_rule("disconnected"); }
TEST(StandingRobot, WhenTheCameraDoesNotSeeIt) { check_rule("not_seen"); }
TEST(StandingRobot, WhenTheCameraStops) { check_rule("stale"); }
TEST(StandingRobot, WhenItsProgramStalls) { check_rule("stalled"); }
TEST(StandingRobot, WhenItsProgramIsKilled) { check_rule("killed"); }
TEST(StandingRobot, WhenItsGuardIsKilled) { check_rule("guard_killed"); }
TEST(StandingRobot, AfterASignal) { check_rule("signal"); }
TEST(StandingRobot, AfterAKey) { check_rule("key"); }
