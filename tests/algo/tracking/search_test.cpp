// What a search for a lost object is made of: which points take part in a try, where tries start, which win.
#include <CppUTest/TestHarness.h>

#include <memory>
#include <vector>

#include "algo/tracking/observe.hpp"
#include "algo/tracking/recover.hpp"
#include "tests/algo/tracking/flat_view.hpp"

using namespace st;
using test::FlatView;
using test::kSmallCamera;

TEST_GROUP(SearchForLost) {
  static constexpr int kW = 160, kH = 120;
  std::vector<float> depth = std::vector<float>(kW * kH, 1.0f);
  std::vector<std::uint8_t> owners = std::vector<std::uint8_t>(kW * kH, 1);
  std::vector<ObservedPoint> points = std::vector<ObservedPoint>(kW * kH);
};

TEST(SearchForLost, OnlyPointsNearTheTriedModelTakePart) {
  const FlatView view({60, 40, 80, 60}, {0, 0, -1}, -1.05f);
  for (int v = 40; v < 60; ++v) depth[static_cast<std::size_t>(v * kW + 70)] = 0.8f;  // an arm in front
  const std::size_t used = gather_near_view({depth.data(), kW, kH}, {owners.data(), kW, kH}, 1, view.view,
                                            kSmallCamera, {}, points);
  CHECK(used > 19 * 20);              // the model's pixels without the arm's
  CHECK(used < (20 + 4) * (20 + 4));  // and a narrow seam about them
  for (std::size_t i = 0; i < used; ++i) CHECK(points[i].p.z > 0.9f);
}

TEST(SearchForLost, InPlaceTheModelsMiddleStaysWhereItWas) {
  const auto track = std::make_unique<Track>();
  track->T_last_good = {rotation_from_vector({0.3, -0.2, 0.1}), {0.2, 0.1, 1.5}};
  track->bounds.include({0.1, -0.05, 0});
  track->bounds.include({0.4, 0.15, 0.3});
  const Support support = make_support({0, -1, 0}, 0.5, true);
  const Vec3 middle = track->T_last_good * track->bounds.centre();
  const Pose turned = turned_in_place(*track, support, 1.0);
  DOUBLES_EQUAL(0, norm(turned * track->bounds.centre() - middle), 1e-12);
  const Vec3 turn = rotation_to_vector(turned.R * track->T_last_good.R.transposed());
  DOUBLES_EQUAL(0, norm(turn - support.up), 1e-9);  // by one radian about the vertical
  DOUBLES_EQUAL(0, norm(turned_in_place(*track, support, 0).t - track->T_last_good.t), 1e-12);
}

TEST(SearchForLost, TheTwoBestTriesAreKept) {
  Search search;
  for (const double score : {0.1, 0.5, 0.3, 0.7, 0.2}) search.note(score, {{}, {score, 0, 0}});
  DOUBLES_EQUAL(0.7, search.best[0].score, 0);
  DOUBLES_EQUAL(0.5, search.best[1].score, 0);
  DOUBLES_EQUAL(0.5, search.best[1].T_anchor_object.t.x, 0);
}

TEST(SearchForLost, AModelMostlyHiddenDoesNotScoreLikeOneInSight) {
  AlignResult aligned;
  aligned.solved = true;
  Agreement hidden, seen;
  hidden.same = 0.2f, hidden.hidden = 0.8f, hidden.explained = 0.9f;
  seen.same = 0.9f, seen.through = 0.1f, seen.explained = 0.6f;
  CHECK(fit_score(aligned, hidden) < fit_score(aligned, seen));
}
