#include "algo/tracking/make_room.hpp"

#include <CppUTest/TestHarness.h>

#include <memory>

using namespace st;

TEST_GROUP(MakeRoom) {
  std::unique_ptr<Track[]> tracks = std::make_unique<Track[]>(kMaxObjects);

  void setup() override {
    for (std::size_t k = 0; k < kMaxObjects; ++k) tracks[k].phase = Track::Phase::kTracked;
  }
  void lose(std::size_t k, int frames) {
    tracks[k].phase = Track::Phase::kLost;
    tracks[k].lost_run = frames;
  }
  std::size_t slot(Newness newness) const { return slot_for({tracks.get(), kMaxObjects}, newness); }
};

TEST(MakeRoom, AFreeSlotComesFirst) {
  tracks[2].phase = Track::Phase::kFree;
  tracks[0].still_run = 500;
  LONGS_EQUAL(2, slot(Newness::kCut));
}

TEST(MakeRoom, NothingThatMovesGivesWay) {
  LONGS_EQUAL(kMaxObjects, slot(Newness::kWhole));
  LONGS_EQUAL(kMaxObjects, slot(Newness::kReleased));
}

TEST(MakeRoom, WhatHasStoodStillForLongestGivesWayToAFifthMover) {
  tracks[1].still_run = 40;
  tracks[3].still_run = 90;
  LONGS_EQUAL(3, slot(Newness::kWhole));
}

TEST(MakeRoom, APersonAtTheEdgeOfTheViewTakesNoWholeObjectsSlot) {
  tracks[1].still_run = 4000;
  lose(2, 1000);
  LONGS_EQUAL(kMaxObjects, slot(Newness::kCut));
}

TEST(MakeRoom, APersonsPartsGiveWayBeforeAStandingObject) {
  tracks[1].still_run = 4000;
  tracks[2].cut_balance = 5;
  LONGS_EQUAL(2, slot(Newness::kWhole));
}

TEST(MakeRoom, ALostObjectIsKeptWhileItIsLookedFor) {
  lose(0, 20);
  LONGS_EQUAL(kMaxObjects, slot(Newness::kWhole));
  lose(0, 200);
  LONGS_EQUAL(0, slot(Newness::kWhole));
}

TEST(MakeRoom, OnlyWhatWasReleasedTurnsACandidateOut) {
  tracks[1].phase = Track::Phase::kCandidate;
  LONGS_EQUAL(kMaxObjects, slot(Newness::kWhole));
  LONGS_EQUAL(1, slot(Newness::kReleased));
}
