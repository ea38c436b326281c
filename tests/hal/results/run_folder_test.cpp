#include "hal/results/run_folder.hpp"

#include <CppUTest/TestHarness.h>

#include <fstream>

#include "hal/error.hpp"
#include "tests/support/temp_folder.hpp"

using namespace st;
namespace fs = std::filesystem;

TEST_GROUP(RunFolder) {
  TempFolder temp;

  void touch(const std::string& name) { std::ofstream(temp / name) << "x"; }
  bool there(const std::string& name) { return fs::exists(temp / name); }
  std::string refusal(const std::string& out, bool force) {
    try {
      prepare_run_folder(out, "src", force);
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(ExitCode::kBadInput), static_cast<int>(failure.code()));
      return failure.what();
    }
    return {};
  }
};

TEST(RunFolder, KnowsTheNamesOfTheContractAndNoOthers) {
  for (const char* name :
       {"object-1.tum", "object-12.csv", "object-3-covariance.csv", "object-1.ply", "base-2.csv",
        "camera.tum", "scene.ply", "path.csv", "timing.csv", "events.csv", "report.html", "summary.json"})
    CHECK_TEXT(is_result_file(name), name);
  for (const char* name :
       {"object-0.tum", "object-01.tum", "object-x.tum", "object-1.txt", "object-.csv", "notes.csv",
        "truth.tum", "base.csv", "object-1-covariance.tum", "frames.csv", "robot.log", "object--1.tum"})
    CHECK_FALSE_TEXT(is_result_file(name), name);
}

TEST(RunFolder, DefaultNameHoldsTimeAndSource) {
  std::tm t{};
  t.tm_year = 124, t.tm_mon = 2, t.tm_mday = 9, t.tm_hour = 8, t.tm_min = 7, t.tm_sec = 6;
  STRCMP_EQUAL("runs/20240309-080706-sim-lab-x", default_run_name(t, "sim:lab/x").c_str());
}

TEST(RunFolder, MakesWhatIsMissing) {
  const std::string out = temp / "a/b";
  STRCMP_EQUAL(out.c_str(), prepare_run_folder(out, "src", false).c_str());
  CHECK(fs::is_directory(out));
  STRCMP_EQUAL("", refusal(out, false).c_str());  // empty is fine
}

TEST(RunFolder, RefusesWhatIsNotEmptyAndSaysWhatToDo) {
  touch("notes.txt");
  CHECK(refusal(temp.path(), false).find("--force") != std::string::npos);
}

TEST(RunFolder, ForceDeletesOnlyFilesOfARun) {
  for (const char* name :
       {"object-1.tum", "summary.json", "summary.json.part", "notes.txt", "truth.tum", "object-1.txt"})
    touch(name);
  fs::create_directory(temp / "object-2.tum");
  STRCMP_EQUAL("", refusal(temp.path(), true).c_str());
  CHECK_FALSE(there("object-1.tum"));
  CHECK_FALSE(there("summary.json"));
  CHECK_FALSE(there("summary.json.part"));
  CHECK(there("notes.txt"));
  CHECK(there("truth.tum"));
  CHECK(there("object-1.txt"));
  CHECK(there("object-2.tum"));
}

TEST(RunFolder, NeverTakesARecordingEvenByForce) {
  touch("depth.txt");
  touch("path.csv");
  CHECK(refusal(temp.path(), true).find("recording") != std::string::npos);
  CHECK(there("path.csv"));
}

TEST(RunFolder, AFileInTheWayIsBadInput) {
  touch("file");
  CHECK(!refusal(temp / "file", false).empty());
  CHECK(!refusal(temp / "file/below", true).empty());
}

TEST(RunFolder, TwoRunsInOneSecondGetTwoFolders) {
  const fs::path before = fs::current_path();
  fs::current_path(temp.path());
  const std::string a = prepare_run_folder("", "kinect-0", false),
                    b = prepare_run_folder("", "kinect-0", false);
  fs::current_path(before);
  CHECK(a != b);
  CHECK(fs::is_directory(temp / a));
  CHECK(fs::is_directory(temp / b));
}
