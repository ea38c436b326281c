// The trackers of the comparison and the terms that may be left out, through the whole program.
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/replay/driven_circle.hpp"
#include "tests/sanitized.hpp"
#include "tests/support/program.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;

TEST_GROUP(Trackers) {
  TempFolder folder;

  nlohmann::json replay(const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"replay", driven_circle(), "--out", folder / name, "--simd", "SSE4"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Said said = startrack(arguments);
    LONGS_EQUAL_TEXT(0, said.code, said.err.c_str());
    const std::string summary = content((folder / name) + "/summary.json");
    return nlohmann::json::parse(summary);
  }
  std::string trajectory(const std::string& name) { return content((folder / name) + "/object-1.tum"); }
};

TEST(Trackers, EveryOneFollowsTheRobotInItsOwnWay) {
  const std::vector<std::vector<std::string>> ways = {{},
                                                      {"--tracker", "listing1"},
                                                      {"--tracker", "frame-to-frame"},
                                                      {"--tracker", "frame-to-frame", "--keyframes", "15"}};
  std::vector<std::string> seen;
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const std::string name = std::to_string(i);
    const nlohmann::json summary = replay(name, ways[i]);
    CHECK(summary["tracked"].get<int>() > 30);
    const double iterations = summary["objects"][0]["iterations_mean"].get<double>();
    CHECK(iterations > 1 && iterations <= 50);
    CHECK(std::find(seen.begin(), seen.end(), trajectory(name)) == seen.end());
    seen.push_back(trajectory(name));
  }
}

// The robot stands some two metres before the camera.
TEST(Trackers, NoTrackStartsOutsideTheArena) {
  const nlohmann::json inside = replay("inside", {"--arena", "0,-5;10,-5;10,5;0,5"});
  CHECK(inside["objects"].size() == 1);
  const nlohmann::json outside = replay("outside", {"--arena", "-5,-5;0,-5;0,5;-5,5"});
  CHECK(outside["objects"].empty());
}

// The paper's section 4.2: what frame to frame gets wrong it keeps, the updated model brings back.
TEST(Trackers, FrameToFrameDriftsAwayFromWhatTheModelHolds) {
  const auto end_error_mm = [this](const std::string& name) {
    const Said said =
        startrack({"evaluate", folder / name, "--truth", driven_circle() + "/truth.tum", "--json"});
    return nlohmann::json::parse(said.out)["first_b"]["final"]["trans_mm"].get<double>();
  };
  replay("model", {});
  replay("frame", {"--tracker", "frame-to-frame"});
  CHECK(end_error_mm("frame") > 2 * end_error_mm("model"));
}

TEST(Trackers, Listing1GivesTheSameBytesTwiceAndKeepsOffTheHeap) {
  const nlohmann::json first = replay("first", {"--tracker", "listing1"}),
                       again = replay("again", {"--tracker", "listing1"});
  CHECK(first["deterministic_hash"] == again["deterministic_hash"]);
  if (kSanitized)
    return;  // a sanitizer's shadow memory faults, and its allocator is not the one that is watched
  LONGS_EQUAL(0, first["memory"]["heap_calls_after_seal"].get<int>());
  LONGS_EQUAL(0, first["memory"]["page_faults_after_seal"].get<int>());
}

TEST(Trackers, EveryTermCanBeLeftOutAndAllOfThem) {
  replay("whole", {});
  std::vector<std::string> seen{trajectory("whole")};
  for (const char* terms : {"edges", "colour", "floor", "motion", "edges,colour,floor,motion"}) {
    const nlohmann::json summary = replay(terms, {"--without", terms});
    CHECK_TEXT(summary["tracked"].get<int>() > 30, terms);
    CHECK_TEXT(std::find(seen.begin(), seen.end(), trajectory(terms)) == seen.end(), terms);
    seen.push_back(trajectory(terms));
  }
}

TEST(Trackers, ANameThatIsNoneIsRefusedWithThoseThatAre) {
  const Said tracker = startrack({"replay", driven_circle(), "--tracker", "icp", "--out", folder / "x"});
  LONGS_EQUAL(2, tracker.code);
  for (const char* name : {"star", "listing1", "frame-to-frame"}) STRCMP_CONTAINS(name, tracker.err.c_str());
  const Said term = startrack({"replay", driven_circle(), "--without", "edges,color", "--out", folder / "x"});
  LONGS_EQUAL(2, term.code);
  for (const char* name : {"edges", "colour", "floor", "motion"}) STRCMP_CONTAINS(name, term.err.c_str());
}

TEST(Trackers, TheHelpNamesThem) {
  const std::string help = startrack({"replay", "--help"}).out;
  for (const char* name :
       {"listing1", "frame-to-frame", "edges", "colour", "floor", "motion", "projective ICP"})
    STRCMP_CONTAINS(name, help.c_str());
}
