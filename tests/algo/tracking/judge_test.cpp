#include "algo/tracking/judge.hpp"

#include <CppUTest/TestHarness.h>

#include "tests/algo/tracking/flat_view.hpp"

using namespace st;
using namespace st::test;

TEST_GROUP(Judge) {
  // An alignment that used plenty, and a frame that agrees with its model.
  AlignResult result;
  Agreement agreement{1000, 0.9f, 0.03f, 0.02f, 0.05f, 0.9f};
  void setup() override {
    result.solved = true;
    result.depth.tried = 1000;
    result.depth.paired = result.depth.inliers = 900;
  }
  void check(Verdict verdict) const { CHECK(judge(result, agreement) == verdict); }

  // A model of 40 x 40 pixels at 1.2 m; the frame shows `left` in its left half and `right` in its right one.
  FlatView flat{{60, 40, 100, 80}, {0, 0, -1}, -1.2f};
  std::vector<float> depth;
  Agreement compared(float left, float right) {
    depth.assign(160 * 120, 0.0f);
    for (int v = 0; v < 120; ++v)
      for (int u = 0; u < 160; ++u) depth[static_cast<std::size_t>(v * 160 + u)] = u < 80 ? left : right;
    return compare(flat.view, kSmallCamera, {depth.data(), 160, 120}, Pose{}, result.depth);
  }
};

TEST(Judge, SharesOfTheModelsPixels) {
  const Agreement half = compared(1.2f, 2.5f);
  LONGS_EQUAL(400, half.model_pixels);
  DOUBLES_EQUAL(0.5, half.same, 0.03);
  DOUBLES_EQUAL(0.5, half.through, 0.03);
  const Agreement covered = compared(0.7f, 0.0f);
  DOUBLES_EQUAL(0.5, covered.hidden, 0.03);
  DOUBLES_EQUAL(0.5, covered.unknown, 0.03);
  DOUBLES_EQUAL(0.9, covered.explained, 1e-6);
}

TEST(Judge, APoseIsFollowedToWhereItPutsTheModel) {
  // Behind the model the wall; moved back by 10 cm it lies on it.
  depth.assign(160 * 120, 1.3f);
  const ImageView<const float> frame{depth.data(), 160, 120};
  DOUBLES_EQUAL(1, compare(flat.view, kSmallCamera, frame, Pose{}, result.depth).through, 1e-6);
  DOUBLES_EQUAL(1, compare(flat.view, kSmallCamera, frame, {{}, {0, 0, 0.1}}, result.depth).same, 1e-6);
}

TEST(Judge, WhatAgreesIsGood) { check(Verdict::kGood); }

TEST(Judge, WithoutASolutionOrPointsItIsLost) {
  result.solved = false;
  check(Verdict::kLost);
  result.solved = true;
  result.depth.inliers = 5;
  check(Verdict::kLost);
  result.depth.inliers = 900;
  agreement.model_pixels = 3;
  check(Verdict::kLost);
}

TEST(Judge, AModelThatIsLookedThroughIsNotThere) {
  agreement.same = 0.2f;
  agreement.through = 0.75f;
  check(Verdict::kLost);
}

TEST(Judge, HalfAndHalfIsPoor) {
  agreement.same = 0.5f;
  agreement.through = 0.45f;
  agreement.explained = 0.7f;
  check(Verdict::kPoor);
}

TEST(Judge, AnArmThatLetsGoLeavesAGoodPose) {
  agreement.same = 0.4f;
  agreement.through = 0.55f;
  agreement.explained = 0.95f;
  check(Verdict::kGood);
}

TEST(Judge, PointsThatTheModelDoesNotExplainMakeItPoor) {
  agreement.explained = 0.2f;
  check(Verdict::kPoor);
}

TEST(Judge, WhatIsHiddenIsNotHeldAgainstThePose) {
  agreement.same = 0.4f;
  agreement.through = 0.02f;
  agreement.hidden = 0.55f;
  check(Verdict::kGood);
}

TEST(Judge, ButSomeOfItMustBeInSight) {
  agreement.same = 0.5f * kLeastInSight;
  agreement.through = 0;
  agreement.hidden = 0.85f;
  check(Verdict::kLost);
}

TEST(Judge, AfterAWhileATrackIsHeldToItsHabit) {
  Agreement worse = agreement;
  worse.same = 0.68f, worse.through = 0.22f;  // would do for an object that is seen like that as a rule
  Habit habit;
  result.color.used = 500;
  result.color.sigma = 5;
  for (int i = 0; i < 14; ++i) habit.learn(result, agreement);
  CHECK(judge(result, worse, habit) == Verdict::kGood);
  habit.learn(result, agreement);
  CHECK(judge(result, agreement, habit) == Verdict::kGood);
  CHECK(judge(result, worse) == Verdict::kGood);
  CHECK(judge(result, worse, habit) == Verdict::kPoor);
  result.color.sigma = 10;
  CHECK(judge(result, agreement, habit) == Verdict::kGood);
  result.color.sigma = 12;  // the print is not where it should be
  CHECK(judge(result, agreement, habit) == Verdict::kPoor);
}

TEST(Judge, WhatStaysDifferentBecomesTheHabitBeforeATrackIsGivenUp) {
  constexpr int kTrackGivesUp = 8;  // frames without a good pose
  Habit habit;
  result.color.used = 500;
  result.color.sigma = 5;
  for (int i = 0; i < 30; ++i) habit.learn(result, agreement);
  result.color.sigma = 14;  // another light
  int poor = 0;
  for (; judge(result, agreement, habit) == Verdict::kPoor && poor < 100; ++poor)
    habit.learn(result, agreement);
  CHECK(poor > 0 && poor < kTrackGivesUp);
}

TEST(Judge, WithoutColourTheHabitSaysNothingOfIt) {
  Habit habit;
  for (int i = 0; i < 30; ++i) habit.learn(result, agreement);
  result.color.used = 500;
  result.color.sigma = 30;
  CHECK(judge(result, agreement, habit) == Verdict::kGood);
}
