// How a run may end, and what stands in its folder then.
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "hal/results/object_files.hpp"
#include "hal/results/run_folder.hpp"
#include "tests/replay/driven_circle.hpp"
#include "tests/support/fake_recording.hpp"
#include "tests/support/program.hpp"
#include "tests/support/recorded_data.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;
namespace fs = std::filesystem;

TEST_GROUP(ReplayEndings) {
  TempFolder folder;

  // A replay at real pace that has published a few rows of an object.
  void wait_for_rows(Running & program, const std::string& run) const {
    while (!program.ended() && lines_of(content(run + "/object-1.csv")) < 6) usleep(10000);
    CHECK(!program.ended());
  }
};

TEST(ReplayEndings, NothingEverMovedIsDoneWithAnEvent) {
  const std::string recording = folder / "still";
  fs::create_directory(recording);
  write_camera_toml(recording, false);
  for (int k = 0; k < 40; ++k) add_depth(recording, k, 700);
  const Said said = startrack({"replay", recording, "--out", folder / "run"});
  LONGS_EQUAL_TEXT(0, said.code, said.err.c_str());
  STRCMP_CONTAINS(",no_object,", content(folder / "run/events.csv").c_str());
  const std::string last = "run: " + (folder / "run") + "\n";
  CHECK(said.out.ends_with(last));
}

TEST(ReplayEndings, LostAtTheEndIsOne) {
  driven_then_covered(folder / "covered");
  const Said said = startrack({"replay", folder / "covered", "--out", folder / "run"});
  LONGS_EQUAL_TEXT(1, said.code, said.err.c_str());
  STRCMP_CONTAINS(",lost,1,", content(folder / "run/events.csv").c_str());
}

TEST(ReplayEndings, AnInterruptedRunSaysSoAndIsComplete) {
  const std::string run = folder / "run";
  Running program({"replay", driven_circle(), "--pace", "real", "--out", run}, folder.path());
  wait_for_rows(program, run);
  program.send(SIGINT);
  const Said said = program.wait();
  LONGS_EQUAL(130, said.code);
  const nlohmann::json summary = nlohmann::json::parse(content(run + "/summary.json"));
  STRCMP_EQUAL("interrupted", summary["ended"].get<std::string>().c_str());
  CHECK(fs::exists(run + "/object-1.ply"));
  STRCMP_CONTAINS(",interrupted,", content(run + "/events.csv").c_str());
}

TEST(ReplayEndings, AKilledRunLeavesWholeLinesAndNoSummary) {
  const std::string run = folder / "run";
  Running program({"replay", driven_circle(), "--pace", "real", "--out", run}, folder.path());
  wait_for_rows(program, run);
  program.send(SIGKILL);
  LONGS_EQUAL(128 + SIGKILL, program.wait().code);
  CHECK(!fs::exists(run + "/summary.json"));
  for (const fs::directory_entry& entry : fs::directory_iterator(run))
    CHECK_TEXT(content(entry.path().string()).ends_with('\n'), entry.path().c_str());
  CHECK(parse_object_csv(content(run + "/object-1.csv"), "object-1.csv").size() >= 5);

  const Said report = startrack({"report", run});
  LONGS_EQUAL_TEXT(0, report.code, report.err.c_str());
  STRCMP_CONTAINS("interrupted", content(run + "/report.html").c_str());
}

TEST(ReplayEndings, ForceReplacesARunAndNothingElse) {
  const std::string run = folder / "run";
  fs::create_directory(run);
  write_file(run + "/object-7.tum", "old\n");
  write_file(run + "/notes.txt", "mine\n");
  const std::vector<std::string> arguments{"replay", driven_circle(), "--seconds", "0.2", "--out", run};
  LONGS_EQUAL(2, startrack(arguments).code);
  STRCMP_EQUAL("old\n", content(run + "/object-7.tum").c_str());
  std::vector<std::string> forced = arguments;
  forced.push_back("--force");
  LONGS_EQUAL(0, startrack(forced).code);
  CHECK(!fs::exists(run + "/object-7.tum"));
  STRCMP_EQUAL("mine\n", content(run + "/notes.txt").c_str());
}
