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
  const std::size_t used =
      gather_near_view({depth.data(), kW, kH}, {owners.data(), kW, kH}, 1, view.view, kSmallCamera, points);
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

TEST(SearchForLost, TheSideBehindSomethingNearerIsHidden) {
  const Rect box{60, 40, 90, 60}, view{0, 0, kW, kH};
  for (int v = 0; v < kH; ++v)
    for (int u = 0; u < kW; ++u) {
      const auto at = static_cast<std::size_t>(v * kW + u);
      depth[at] = u < 60 ? 0.7f : 1.0f;  // a screen on the left
      owners[at] = u >= 60 && u < 90 && v >= 40 && v < 60 ? 2 : 0;
      if (owners[at] == 0 && u >= 90) depth[at] = 2.0f;
    }
  const ImageView<const float> z{depth.data(), kW, kH};
  const ImageView<const std::uint8_t> whose{owners.data(), kW, kH};
  CHECK(hidden_side(z, whose, 2, box, view) == HiddenSide::kLeft);
  for (float& d : depth) d = d < 0.9f ? 2.0f : d;  // it is gone
  CHECK(hidden_side(z, whose, 2, box, view) == HiddenSide::kNone);
  CHECK(hidden_side(z, whose, 2, box, {0, 0, 91, kH}) == HiddenSide::kRight);  // the view ends there
}

TEST(SearchForLost, OfAHalfSeenOneTheSideInSightIsMatched) {
  const auto track = std::make_unique<Track>();
  track->bounds.include({-0.17, -0.17, 0});
  track->bounds.include({0.17, 0.17, 0.09});
  const Support support = make_support({0, -1, 0}, 0.5, true);
  Footprint half;
  half.on_floor = true;
  half.T_camera_object = {support.R_camera_floor, {0.1, 0.5, 1.5}};
  half.bounds.include({-0.17, -0.08, 0});  // y is to the left: the left half is in sight
  half.bounds.include({0.17, 0.08, 0.09});
  const Vec3 left = support.R_camera_floor.col(1);
  const Vec3 whole = hypothesis(*track, half, support, 0, HiddenSide::kNone).t;
  const Vec3 matched = hypothesis(*track, half, support, 0, HiddenSide::kRight).t;
  DOUBLES_EQUAL(0.08 - 0.17, dot(matched - whole, left), 1e-9);
  DOUBLES_EQUAL(0.17 - 0.08, dot(hypothesis(*track, half, support, 0, HiddenSide::kLeft).t - whole, left),
                1e-9);
}

TEST(SearchForLost, TheBestOfAllIsFoundWhereverItStands) {
  Search search;
  for (const double score : {0.1, 0.5, 0.3}) search.note(score, {{}, {score, 0, 0}});
  search.best[0].score = 0;  // refused when it was refined
  DOUBLES_EQUAL(0.3, search.best_of_all().score, 0);
}
