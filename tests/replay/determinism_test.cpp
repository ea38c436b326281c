// The contract's promise on bytes: the same recording gives the same files, at any pace, under load, run
// after run.
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
namespace fs = std::filesystem;

namespace {

// The files that must not differ between two runs.
std::vector<std::string> promised_files(const std::string& run) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(run)) {
    const std::string name = entry.path().filename().string(), suffix = entry.path().extension().string();
    const bool promised = suffix == ".tum" || suffix == ".csv" || suffix == ".ply";
    if (promised && name != "timing.csv") names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

nlohmann::json summary_of(const std::string& run) {
  return nlohmann::json::parse(content(run + "/summary.json"));
}

}  // namespace

TEST_GROUP(ReplayDeterminism) {
  TempFolder folder;

  std::string replay(const std::string& name, std::vector<std::string> more = {}) {
    const std::string run = folder / name;
    std::vector<std::string> arguments{"replay", driven_circle(), "--out", run, "--simd", "SSE4"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Said said = startrack(arguments);
    LONGS_EQUAL_TEXT(0, said.code, said.err.c_str());
    return run;
  }

  static void check_same(const std::string& a, const std::string& b) {
    const std::vector<std::string> names = promised_files(a);
    CHECK(names == promised_files(b));
    for (const std::string& name : names)
      CHECK_TEXT(content(a + "/" + name) == content(b + "/" + name), name.c_str());
    CHECK(summary_of(a)["deterministic_hash"] == summary_of(b)["deterministic_hash"]);
  }
};

TEST(ReplayDeterminism, TheRobotIsFoundAndLeavesEveryFile) {
  const std::string run = replay("first");
  for (const char* name : {"object-1.tum", "object-1.csv", "object-1-covariance.csv", "object-1.ply",
                           "events.csv", "timing.csv", "summary.json"})
    CHECK_TEXT(!content(run + "/" + name).empty(), name);
  const nlohmann::json summary = summary_of(run);
  UNSIGNED_LONGS_EQUAL(1, summary["objects"].size());
  CHECK(summary["tracked"].get<int>() > 30);  // two seconds of driving are 63 frames
  STRCMP_EQUAL("SSE4", summary["simd"].get<std::string>().c_str());
}

TEST(ReplayDeterminism, TwiceAndAtAnyPaceTheSameBytes) {
  const std::string first = replay("fast");
  check_same(first, replay("again"));
  check_same(first, replay("real", {"--pace", "real"}));
}

TEST(ReplayDeterminism, TheHashTellsRunsApart) {
  const std::string whole = replay("whole"), part = replay("part", {"--seconds", "3"});
  CHECK(summary_of(whole)["deterministic_hash"] != summary_of(part)["deterministic_hash"]);
}

TEST(ReplayDeterminism, TheLoopNeitherCallsTheHeapNorFaults) {
  if (kSanitized)
    return;  // a sanitizer's shadow memory faults, and its allocator is not the one that is watched
  const nlohmann::json memory = summary_of(replay("sealed"))["memory"];
  LONGS_EQUAL(0, memory["heap_calls_after_seal"].get<int>());
  LONGS_EQUAL(0, memory["page_faults_after_seal"].get<int>());
}
