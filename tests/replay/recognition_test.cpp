// A run stores what it met, the next one knows it: through the whole program, with a database.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hal/models/model_store.hpp"
#include "hal/models/sqlite.hpp"
#include "tests/replay/driven_circle.hpp"
#include "tests/sanitized.hpp"
#include "tests/support/program.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;

namespace {

using Json = nlohmann::json;

}  // namespace

TEST_GROUP(RecognitionRun) {
  TempFolder folder;

  Said replay(const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"replay", driven_circle(), "--out", folder / name, "--simd", "SSE4"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return startrack(arguments);
  }
  Json summary_of(const std::string& name) { return Json::parse(content((folder / name) + "/summary.json")); }
  std::string events_of(const std::string& name) { return content((folder / name) + "/events.csv"); }
  std::string list(const std::string& database) {
    return startrack({"models", "list", "--models", database}).out;
  }
};

// The same recording again: the model's frame is the first run's, so that the answer is known exactly.
TEST(RecognitionRun, TheSecondRunKnowsWhatTheFirstMetAndTheDatabaseHoldsItOnce) {
  const std::string database = folder / "models.db";
  LONGS_EQUAL(0, replay("first", {"--models", database}).code);
  const Json first = summary_of("first")["objects"][0];
  STRCMP_EQUAL("new", first["model_source"].get<std::string>().c_str());
  STRCMP_EQUAL("object-1", first["name"].get<std::string>().c_str());
  for (const char* name : {"second", "third"}) {
    LONGS_EQUAL(0, replay(name, {"--models", database}).code);
    const Json object = summary_of(name)["objects"][0];
    CHECK_EQUAL(first["model_id"].get<std::string>(), object["model_id"].get<std::string>());
    STRCMP_EQUAL("database", object["model_source"].get<std::string>().c_str());
    CHECK(events_of(name).find(",recognised,1,") != std::string::npos);  // in the loop, not at the end
    STRCMP_EQUAL("object-1", object["name"].get<std::string>().c_str());
    LONGS_EQUAL(2, lines_of(list(database)));  // heading and one model
    const Json T = object["T_model_object"];
    for (int i = 0; i < 3; ++i) DOUBLES_EQUAL(0, T[static_cast<std::size_t>(i)][3].get<double>(), 0.01);
    DOUBLES_EQUAL(0, std::atan2(T[1][0].get<double>(), T[0][0].get<double>()), 0.1);  // of small images
  }
}

TEST(RecognitionRun, ARunWithADatabaseIsRepeatableAndKeepsOffTheHeap) {
  const std::string database = folder / "models.db";
  replay("first", {"--models", database});
  std::filesystem::copy(database, folder / "copy.db");
  replay("a", {"--models", database});
  replay("b", {"--models", folder / "copy.db"});
  CHECK(summary_of("a")["deterministic_hash"] == summary_of("b")["deterministic_hash"]);
  CHECK(events_of("a").find(",recognised,") != std::string::npos);
  if (kSanitized) return;
  LONGS_EQUAL(0, summary_of("a")["memory"]["heap_calls_after_seal"].get<int>());
  LONGS_EQUAL(0, summary_of("a")["memory"]["page_faults_after_seal"].get<int>());
}

// The database cannot be written: the run's own files are complete all the same.
TEST(RecognitionRun, ADatabaseThatRefusesAtTheEndCostsTheRunNothing) {
  const std::string database = folder / "models.db";
  { const ModelStore made(database); }
  Database held(database, Database::Access::kCreate);
  held.run("CREATE TRIGGER no_more BEFORE INSERT ON model BEGIN SELECT RAISE(ABORT, 'no more'); END");
  const Said said = replay("run", {"--models", database});
  LONGS_EQUAL(2, said.code);
  STRCMP_CONTAINS("models.db", said.err.c_str());
  for (const char* name : {"summary.json", "object-1.ply", "object-1.tum"})
    CHECK_TEXT(!content((folder / "run") + "/" + name).empty(), name);
}

TEST(RecognitionRun, TheRecognitionTrackerCountsWhereItFails) {
  const std::string database = folder / "models.db";
  replay("first", {"--models", database});
  const Said without = replay("refused", {"--tracker", "recognition"});
  LONGS_EQUAL(2, without.code);
  STRCMP_CONTAINS("--models", without.err.c_str());
  for (const std::string& tracker : {std::string("recognition"), std::string("sift")}) {
    CHECK(replay(tracker, {"--models", database, "--tracker", tracker}).code <= 1);
    const Json m = summary_of(tracker)["matching"];
    const int frames = m["frames"].get<int>(), found = m["found"].get<int>();
    CHECK(frames > 20);
    LONGS_EQUAL(frames, found + m["no_keypoints"].get<int>() + m["no_matches"].get<int>() +
                            m["no_agreement"].get<int>() + m["not_verified"].get<int>());
  }
  LONGS_EQUAL(2, lines_of(list(database)));  // a baseline stores nothing
}

TEST(RecognitionRun, BadDatabasesAreRefusedBeforeTheRun) {
  const std::string foreign =
      folder.file("notes.txt", "no database at all, but long enough to look at " + std::string(2000, 'x'));
  const std::string before = content(foreign);
  const Said said = replay("x", {"--models", foreign});
  LONGS_EQUAL(2, said.code);
  STRCMP_CONTAINS("no model database", said.err.c_str());
  CHECK_EQUAL(before, content(foreign));
}

TEST_GROUP(ModelsCommand) {
  TempFolder folder;
  std::string database() const { return folder / "models.db"; }
  Said models(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "models");
    arguments.insert(arguments.end(), {"--models", database()});
    return startrack(arguments);
  }
};

TEST(ModelsCommand, ImportsShowsRenamesExportsAndDeletes) {
  const std::string truth = driven_circle() + "/truth.ply";
  LONGS_EQUAL(0, models({"import", truth, "--name", "robot"}).code);
  LONGS_EQUAL(2, models({"import", truth, "--name", "robot"}).code);  // the name is taken
  STRCMP_CONTAINS("robot", models({"list"}).out.c_str());
  const Said shown = models({"show", "robot", "--out", folder / "robot.png"});
  LONGS_EQUAL(0, shown.code);
  STRCMP_CONTAINS("version 1", shown.out.c_str());
  CHECK(content(folder / "robot.png").starts_with("\x89PNG"));
  LONGS_EQUAL(0, models({"rename", "robot", "create"}).code);
  LONGS_EQUAL(0, models({"export", "create", "--out", folder / "create.ply"}).code);
  LONGS_EQUAL(0, models({"import", folder / "create.ply", "--name", "again"}).code);
  LONGS_EQUAL(0, models({"delete", "create"}).code);
  LONGS_EQUAL(2, models({"show", "create"}).code);
  LONGS_EQUAL(2, lines_of(models({"list"}).out));
}

TEST(ModelsCommand, SaysWhatIsWrong) {
  STRCMP_CONTAINS("no such database", models({"list"}).err.c_str());
  LONGS_EQUAL(2, models({"list"}).code);
  CHECK_FALSE(std::filesystem::exists(database()));
  const std::string text = folder.file("text.ply", "this is no mesh");
  STRCMP_CONTAINS("text.ply", models({"import", text}).err.c_str());
  LONGS_EQUAL(2, startrack({"models", "keypoints", text}).code);
}

TEST(ModelsCommand, PrintsTheKeypointsOfARawVolume) {
  std::string bytes;
  for (int z = 0; z < 32; ++z)
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const auto square = [](int d) { return static_cast<float>(d * d); };
        const float value = std::exp(-(square(x - 16) + square(y - 14) + square(z - 17)) / 32.0f) +
                            0.5f * std::exp(-(square(x - 24) + square(y - 16) + square(z - 15)) / 32.0f);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
      }
  const Said said =
      startrack({"models", "keypoints", folder.file("blobs.raw", bytes), "--descriptors", folder / "d"});
  LONGS_EQUAL(0, said.code);
  CHECK(lines_of(said.out) >= 2);
  LONGS_EQUAL((lines_of(said.out) - 1) * 2048 * 4, content(folder / "d").size());
}
