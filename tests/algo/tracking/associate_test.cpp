#include "algo/tracking/associate.hpp"

#include <CppUTest/TestHarness.h>

#include <memory>
#include <vector>

#include "tests/algo/tracking/flat_view.hpp"

using namespace st;
using namespace st::test;

TEST_GROUP(Associate) {
  static constexpr int kW = 160, kH = 120;
  std::vector<std::uint8_t> labels = std::vector<std::uint8_t>(kW * kH, 0);
  std::vector<std::uint8_t> owners = std::vector<std::uint8_t>(kW * kH, 77);
  std::vector<float> depth = std::vector<float>(kW * kH, 3.0f);
  std::vector<Segment> segments;
  std::unique_ptr<Track[]> tracks = std::make_unique<Track[]>(2);
  std::vector<std::unique_ptr<FlatView>> views;
  UnexplainedList unexplained;
  Owned owned[2];

  // A track whose model fills the rectangle at z_m; grown up, unless said otherwise.
  void add_track(std::size_t k, const Rect& box, float z_m) {
    views.push_back(std::make_unique<FlatView>(box, Vec3f{0, 0, -1}, -z_m));
    Track& track = tracks[k];
    track.phase = Track::Phase::kTracked;
    track.view = views.back()->view;
    track.view_pixels = track.owned_pixels = box.width() * box.height();
    track.integrated = 50;
    track.motion.start({{}, {0, 0, z_m}}, {}, 0);
  }

  void paint(const Rect& box, float z_m, std::uint8_t label) {
    for (int v = box.v0; v < box.v1; ++v)
      for (int u = box.u0; u < box.u1; ++u) {
        depth[at(u, v)] = z_m;
        labels[at(u, v)] = label;
      }
  }
  void add_segment(const Rect& box) {
    Segment segment;
    segment.box = box;
    const auto label = static_cast<std::uint8_t>(segments.size() + 1);
    for (int v = box.v0; v < box.v1; ++v)
      for (int u = box.u0; u < box.u1; ++u) segment.pixels += labels[at(u, v)] == label ? 1 : 0;
    segments.push_back(segment);
  }
  void assign() {
    const AssociationInput in{{labels.data(), kW, kH}, segments, {depth.data(), kW, kH}, kSmallCamera};
    associate(in, {tracks.get(), 2}, {owners.data(), kW, kH}, owned, unexplained);
  }
  static std::size_t at(int u, int v) { return static_cast<std::size_t>(v * kW + u); }
  int count(const Rect& box, std::uint8_t owner) const {
    int n = 0;
    for (int v = box.v0; v < box.v1; ++v)
      for (int u = box.u0; u < box.u1; ++u) n += owners[at(u, v)] == owner ? 1 : 0;
    return n;
  }
};

TEST(Associate, ASegmentThatOneTrackExplainsIsItsOwnGrowthIncluded) {
  add_track(0, {40, 40, 70, 70}, 1.2f);
  paint({39, 39, 72, 71}, 1.2f, 1);
  add_segment({39, 39, 72, 71});
  assign();
  LONGS_EQUAL(33 * 32, count({0, 0, kW, kH}, 1));
  LONGS_EQUAL(33 * 32, owned[0].pixels);
  CHECK_FALSE(owned[0].divided);
  LONGS_EQUAL(kW * kH - 33 * 32, count({0, 0, kW, kH}, 0));  // and every other pixel was set
  LONGS_EQUAL(0, unexplained.size());
}

TEST(Associate, WhatComesOutFromBehindSomethingMayGrowUpToItsModelAtOnce) {
  const Rect model{40, 40, 70, 70};
  add_track(0, model, 1.2f);
  tracks[0].owned_pixels = 100;
  paint(model, 1.2f, 1);
  add_segment(model);
  assign();
  LONGS_EQUAL(900, count(model, 1));
  CHECK_FALSE(owned[0].divided);
}

TEST(Associate, AHandNoLargerThanTheObjectIsNotItsGrowth) {
  const Rect object{40, 40, 70, 70}, hand{70, 45, 95, 65};
  add_track(0, object, 1.2f);
  paint(object, 1.2f, 1);
  paint(hand, 1.2f, 1);
  add_segment({40, 40, 95, 70});
  assign();
  CHECK(owned[0].divided);
  LONGS_EQUAL(900, count(object, 1));
  CHECK(count(hand, kForeign) >= 400);
}

TEST(Associate, TwoThatTouchAreDividedByTheirModels) {
  const Rect near_one{40, 40, 70, 70}, far_one{70, 40, 100, 70};
  add_track(0, near_one, 1.2f);
  add_track(1, far_one, 1.5f);
  paint(near_one, 1.2f, 1);
  paint(far_one, 1.5f, 1);
  add_segment({40, 40, 100, 70});
  assign();
  LONGS_EQUAL(900, count(near_one, 1));
  LONGS_EQUAL(900, count(far_one, 2));
  LONGS_EQUAL(70, owned[0].box.u1);
  LONGS_EQUAL(70, owned[1].box.u0);
  LONGS_EQUAL(0, unexplained.size());
}

TEST(Associate, OfTwoThatTouchAtOneDepthEachKeepsItsSide) {
  const Rect left{40, 40, 70, 70}, right{70, 40, 100, 70};
  add_track(0, left, 1.2f);
  add_track(1, right, 1.21f);
  paint(left, 1.2f, 1);
  paint(right, 1.21f, 1);
  add_segment({40, 40, 100, 70});
  assign();
  CHECK(count(left, 1) > 890);
  CHECK(count(right, 2) > 890);
}

TEST(Associate, AHandThatTakesHoldOfTheObjectIsNotTheObject) {
  const Rect object{60, 50, 90, 80}, arm{60, 0, 90, 50};
  add_track(0, object, 1.2f);
  paint(object, 1.2f, 1);
  paint(arm, 0.9f, 1);
  // An arm much larger than a grown-up model: the segment is divided.
  paint({20, 0, 140, 50}, 0.9f, 1);
  add_segment({20, 0, 140, 80});
  segments[0].touches_border = true;
  assign();
  LONGS_EQUAL(900, count(object, 1));
  LONGS_EQUAL(0, count({20, 0, 140, 40}, 1));
  LONGS_EQUAL(120 * 50, count({20, 0, 140, 50}, kForeign));
  LONGS_EQUAL(1, unexplained.size());
  CHECK(unexplained[0].rest);
  CHECK(unexplained[0].touches_border);
  LONGS_EQUAL(120 * 50, unexplained[0].pixels);
  DOUBLES_EQUAL(0.9, unexplained[0].centroid.z, 1e-4);
}

TEST(Associate, AYoungModelMayGrowAtAnyPace) {
  const Rect object{60, 50, 90, 80}, more{20, 0, 140, 50};
  add_track(0, object, 1.2f);
  tracks[0].integrated = 2;
  paint(object, 1.2f, 1);
  paint(more, 1.25f, 1);
  add_segment({20, 0, 140, 80});
  assign();
  LONGS_EQUAL(900 + 120 * 50, count({0, 0, kW, kH}, 1));
}

TEST(Associate, WhatNoTrackExplainsIsANewcomer) {
  add_track(0, {10, 10, 30, 30}, 1.2f);
  paint({10, 10, 30, 30}, 1.2f, 1);
  paint({100, 60, 120, 80}, 2.0f, 2);
  add_segment({10, 10, 30, 30});
  add_segment({100, 60, 120, 80});
  assign();
  LONGS_EQUAL(1, unexplained.size());
  LONGS_EQUAL(2, unexplained[0].label);
  CHECK(!unexplained[0].rest);
  LONGS_EQUAL(400, unexplained[0].pixels);
  LONGS_EQUAL(100, unexplained[0].box.u0);
  LONGS_EQUAL(120, unexplained[0].box.u1);
  LONGS_EQUAL(400, count({100, 60, 120, 80}, kForeign));
}

TEST(Associate, WhatPassesInFrontDoesNotBelongToTheObjectBehind) {
  const Rect box{40, 40, 70, 70};
  add_track(0, box, 1.5f);
  paint(box, 0.8f, 1);  // in the object's place, but far nearer
  add_segment(box);
  assign();
  LONGS_EQUAL(0, count(box, 1));
  LONGS_EQUAL(1, unexplained.size());
}

TEST(Associate, LostAndFreeTracksClaimNothing) {
  const Rect box{40, 40, 70, 70};
  add_track(0, box, 1.2f);
  tracks[0].phase = Track::Phase::kLost;
  paint(box, 1.2f, 1);
  add_segment(box);
  assign();
  LONGS_EQUAL(900, count(box, kForeign));
  LONGS_EQUAL(1, unexplained.size());
}
