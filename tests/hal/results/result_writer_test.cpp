#include "hal/results/result_writer.hpp"

#include <CppUTest/TestHarness.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "firmware_like/finish_run.hpp"
#include "hal/error.hpp"
#include "hal/results/csv_table.hpp"
#include "hal/results/ply_file.hpp"
#include "hal/results/run_hash.hpp"
#include "hal/results/summary_file.hpp"
#include "hal/results/tum_file.hpp"
#include "tests/support/demo_run.hpp"
#include "tests/support/temp_folder.hpp"

using namespace st;

namespace {

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t n = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
  return n;
}

std::set<std::string> names_in(const std::string& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

DemoRun short_run() {
  DemoRun run = square_run(0.4, 0.98);
  run.lost_from = 100, run.lost_to = 112;
  return run;
}

}  // namespace

TEST_GROUP(ResultWriter) {
  TempFolder temp;
  std::string text(const std::string& name) { return read_whole_file(temp / name); }
  std::string first_line(const std::string& name) {
    const std::string all = text(name);
    return all.substr(0, all.find('\n'));
  }
};

// The contract: every name, every column, in its order.
TEST(ResultWriter, LeavesTheFilesAndColumnsOfTheContract) {
  write_demo_run(short_run(), temp.path());
  const std::set<std::string> expected = {"base-1.csv",   "events.csv",   "object-1-covariance.csv",
                                          "object-1.csv", "object-1.ply", "object-1.tum",
                                          "path.csv",     "summary.json", "timing.csv"};
  CHECK(names_in(temp.path()) == expected);
  STRCMP_EQUAL(
      "t,state,x,y,z,roll,pitch,yaw,yaw_unwrapped,vx,vy,vz,wx,wy,wz,ax,ay,az,v,w,alpha,sx,sy,sz,sroll,spitch,"
      "syaw,yaw_source,"
      "inliers,residual",
      first_line("object-1.csv").c_str());
  STRCMP_EQUAL("t,x,y,yaw", first_line("base-1.csv").c_str());
  STRCMP_EQUAL("t,x,y,yaw,v,w", first_line("path.csv").c_str());
  STRCMP_EQUAL("t,event,object,a,b,c", first_line("events.csv").c_str());
  STRCMP_EQUAL(
      "t,frame,acquire_us,preprocess_us,segment_us,associate_us,predict_us,render_us,align_us,judge_us,"
      "integrate_us,decide_us,"
      "send_us,publish_us,frame_us,cpu_us,level,age_us",
      first_line("timing.csv").c_str());
  const std::string covariance_text = text("object-1-covariance.csv");
  const CsvTable covariance = parse_csv(covariance_text, "covariance");
  LONGS_EQUAL(22, covariance.columns.size());
  STRCMP_EQUAL("t", std::string(covariance.columns[0]).c_str());
}

TEST(ResultWriter, SummaryHoldsEveryKeyInTheOrderOfTheContract) {
  write_demo_run(circle_run(0.5, 0.02), temp.path());
  const auto json = nlohmann::ordered_json::parse(text("summary.json"));
  const auto keys = [](const nlohmann::ordered_json& object) {
    std::string all;
    for (const auto& [key, value] : object.items()) all += key + " ";
    return all;
  };
  STRCMP_EQUAL(
      "version source mode simd frames tracked lost ended objects T_floor_camera path timing memory "
      "deadline_misses "
      "deterministic_hash ",
      keys(json).c_str());
  STRCMP_EQUAL(
      "id name model_source model_id first_t last_t tracked lost iterations_mean path_length_m "
      "T_model_object "
      "base ",
      keys(json["objects"][0]).c_str());
  STRCMP_EQUAL("x y yaw sigma_m sigma_rad ", keys(json["objects"][0]["base"]).c_str());
  STRCMP_EQUAL("rmse_as_placed_m rmse_shape_m max_m heading_rmse_rad in_band radius_m ",
               keys(json["path"]).c_str());
  STRCMP_EQUAL("frame_us cpu_us stages ", keys(json["timing"]).c_str());
  STRCMP_EQUAL("p50 p99 p999 max ", keys(json["timing"]["frame_us"]).c_str());
  LONGS_EQUAL(kStageCount, json["timing"]["stages"].size());
  STRCMP_EQUAL("planned_bytes peak_rss_bytes heap_calls_after_seal page_faults_after_seal ",
               keys(json["memory"]).c_str());
  STRCMP_EQUAL("object-1", json["objects"][0]["name"].get<std::string>().c_str());
  STRCMP_EQUAL("new", json["objects"][0]["model_source"].get<std::string>().c_str());
  STRCMP_EQUAL("done", json["ended"].get<std::string>().c_str());
}

// With a wheel 2 % larger a robot with a base of 0.258 m drives the circle of 0.5 m with another radius,
// known exactly.
TEST(ResultWriter, SummaryTellsTheBaseAndTheCircleThatWasDriven) {
  const DemoRun run = circle_run(0.5, 0.02);
  write_demo_run(run, temp.path());
  const auto json = nlohmann::json::parse(text("summary.json"));
  const double right = 0.2 + 0.129 * 0.4, left = 0.2 - 0.129 * 0.4;
  const double radius = 0.129 * (1.02 * right + left) / (1.02 * right - left);
  DOUBLES_EQUAL(radius, json["path"]["radius_m"].get<double>(), 0.002);
  DOUBLES_EQUAL(run.base.x, json["objects"][0]["base"]["x"].get<double>(), 0.002);
  DOUBLES_EQUAL(run.base.y, json["objects"][0]["base"]["y"].get<double>(), 0.002);
  DOUBLES_EQUAL(run.base.yaw, json["objects"][0]["base"]["yaw"].get<double>(), 0.2 * kPi / 180);
  DOUBLES_EQUAL(2 * kPi * radius, json["objects"][0]["path_length_m"].get<double>(), 0.2);
}

TEST(ResultWriter, TumRowsHaveEightFieldsSortedUniqueStampsAndNoTrailingSpace) {
  write_demo_run(short_run(), temp.path());
  const std::string tum = text("object-1.tum");
  CHECK(tum.ends_with('\n'));
  LONGS_EQUAL(0, count_of(tum, " \n"));
  LONGS_EQUAL(0, count_of(tum, "  "));
  LONGS_EQUAL(7 * count_of(tum, "\n"), count_of(tum, " "));
  const TumTrajectory read = parse_tum(tum);
  LONGS_EQUAL(0, read.dropped_lines);
  LONGS_EQUAL(count_of(tum, "\n"), read.poses.size());
  for (std::size_t i = 1; i < read.poses.size(); ++i) CHECK(read.poses[i].t_s > read.poses[i - 1].t_s);
}

TEST(ResultWriter, AStampThatRepeatsOrGoesBackLeavesNoSecondTumRow) {
  ResultWriter writer(temp.path());
  for (const double t_s : {10.0, 10.0, 9.5, 10.0000001, 10.1}) {
    FrameReport report;
    report.t_s = t_s;
    ObjectSample sample;
    sample.id = 1, sample.state = TrackState::kGood, sample.in_tum = true;
    report.objects.push_back(sample);
    writer.take(report);
  }
  writer.flush();
  LONGS_EQUAL(2, count_of(text("object-1.tum"), "\n"));
  LONGS_EQUAL(3, count_of(text("object-1-covariance.csv"), "\n"));
}

TEST(ResultWriter, AFrameHasARowFromConfirmationToTheEndAndNoPoseWhenLost) {
  const DemoRun run = short_run();
  write_demo_run(run, temp.path());
  const std::vector<ObjectRow> rows = parse_object_csv(text("object-1.csv"), "object-1.csv");
  LONGS_EQUAL(run.driven.size() - 2, rows.size());
  std::size_t lost = 0;
  for (const ObjectRow& row : rows) {
    CHECK(row.has_pose == (row.state != TrackState::kLost));
    lost += row.state == TrackState::kLost ? 1 : 0;
  }
  LONGS_EQUAL(10, lost);
  LONGS_EQUAL(rows.size() - lost, count_of(text("object-1.tum"), "\n"));
  CHECK(text("object-1.csv").find(",lost,,,,,,,,,,,,,,,,,,,,,,,,,,colour,,\n") != std::string::npos);
}

TEST(ResultWriter, NeverWritesNaN) {
  ResultWriter writer(temp.path());
  FrameReport report;
  report.t_s = 5;
  ObjectSample sample;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  sample.id = 1, sample.state = TrackState::kGood, sample.in_tum = true;
  sample.velocity_mps = {nan, nan, nan};
  sample.covariance[3] = nan;
  sample.residual_m = std::numeric_limits<float>::infinity();
  report.objects.push_back(sample);
  sample.id = 2;
  sample.T_camera_object.t.x = nan;
  sample.T_floor_object.R(0, 0) = nan;
  report.objects.push_back(sample);
  report.cpu_us = std::numeric_limits<float>::quiet_NaN();
  report.events.push_back({5, EventKind::kLost, 1, nan, 0, 0});
  writer.take(report);
  writer.flush();
  for (const std::string& name : names_in(temp.path())) {
    const std::string all = text(name);
    CHECK_TEXT(all.find("nan") == std::string::npos && all.find("inf,") == std::string::npos, name.c_str());
  }
  STRCMP_EQUAL("", text("object-2.tum").c_str());
}

TEST(ResultWriter, WithoutAnyObjectThereIsAnEventAndNoObjectFile) {
  DemoRun run = short_run();
  run.with_object = false;
  write_demo_run(run, temp.path());
  CHECK(names_in(temp.path()) == (std::set<std::string>{"events.csv", "summary.json", "timing.csv"}));
  CHECK(text("events.csv").find(",no_object,0,") != std::string::npos);
  const auto json = nlohmann::json::parse(text("summary.json"));
  CHECK(json["objects"].empty());
  CHECK(json["path"].is_null());
  CHECK(json["T_floor_camera"].is_null());
}

TEST(ResultWriter, AnInterruptedRunSaysSo) {
  DemoRun run = short_run();
  run.ending = Ending::kInterrupted;
  write_demo_run(run, temp.path());
  CHECK(text("events.csv").find(",interrupted,0,2.000000,") != std::string::npos);
  STRCMP_EQUAL("interrupted", parse_summary(text("summary.json"), "summary.json").ended.c_str());
}

TEST(ResultWriter, TheSameRunHasTheSameHashAndAnyChangeAnother) {
  TempFolder other;
  write_demo_run(short_run(), temp.path());
  write_demo_run(short_run(), other.path());
  const std::string hash = parse_summary(text("summary.json"), "").hash;
  STRCMP_EQUAL(hash.c_str(), parse_summary(read_whole_file(other / "summary.json"), "").hash.c_str());
  STRCMP_EQUAL(hash.c_str(), deterministic_hash(temp.path()).c_str());
  // What the clock causes, and what is not of the run, does not count.
  write_whole_file(temp / "timing.csv", "another");
  write_whole_file(temp / "notes.csv", "mine");
  STRCMP_EQUAL(hash.c_str(), deterministic_hash(temp.path()).c_str());
  write_whole_file(temp / "events.csv", text("events.csv") + "\n");
  CHECK(hash != deterministic_hash(temp.path()));
}

TEST(ResultWriter, TheHashIsFnv1a) {
  LONGS_EQUAL_TEXT(1, fnv1a("") == 0xcbf29ce484222325ull, "empty");
  LONGS_EQUAL_TEXT(1, fnv1a("a") == 0xaf63dc4c8601ec8cull, "a");
  LONGS_EQUAL_TEXT(1, fnv1a("foobar") == 0x85944171f73967e8ull, "foobar");
}

TEST(ResultWriter, AnEvictedObjectThatComesBackGoesOnInItsFiles) {
  ResultWriter writer(temp.path());
  for (int i = 0; i < 6; ++i) {
    FrameReport report;
    report.t_s = i;
    ObjectSample sample;
    sample.id = 1, sample.state = TrackState::kGood, sample.in_tum = true;
    if (i != 3) report.objects.push_back(sample);
    if (i == 3) report.events.push_back({3, EventKind::kEvicted, 1, 0, 0, 0});
    writer.take(report);
  }
  writer.flush();
  LONGS_EQUAL(5, count_of(text("object-1.tum"), "\n"));
  LONGS_EQUAL(6, count_of(text("object-1.csv"), "\n"));
}

// A child writes as fast as it can and is killed: only whole lines may be there.
TEST(ResultWriter, AKilledRunLeavesWholeLines) {
  const pid_t child = fork();
  if (child == 0) {
    ResultWriter writer(temp.path());
    for (;;)
      for_each_report(short_run(), [&](const FrameReport& report) {
        writer.take(report);
        writer.flush();
      });
  }
  while (!std::filesystem::exists(temp / "object-1.csv") ||
         std::filesystem::file_size(temp / "object-1.csv") < 20000)
    usleep(1000);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(WIFSIGNALED(status));
  CHECK_FALSE(std::filesystem::exists(temp / "summary.json"));
  for (const std::string& name : names_in(temp.path())) {
    const std::string all = text(name);
    CHECK_TEXT(all.ends_with('\n'), name.c_str());
    if (name.ends_with(".csv")) CHECK(parse_csv(all, name).rows() > 0 || name == "events.csv");
    if (name.ends_with(".tum")) LONGS_EQUAL(0, parse_tum(all).dropped_lines);
  }
}

// A limit on the size of files is met like a full disk: in the middle of a line.
TEST(ResultWriter, AFullDiskIsToldToTheLoopAndLeavesWholeLinesAndNoSummary) {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{10001, 10001};
    setrlimit(RLIMIT_FSIZE, &limit);
    int code = 0;
    try {
      ResultWriter writer(temp.path());
      bool told = false;
      for_each_report(short_run(), [&](const FrameReport& report) {
        writer.take(report);
        writer.flush();
        told = told || writer.failed();
      });
      if (!told) _exit(9);
      finish_run(writer, end_of(short_run(), {}), {});
    } catch (const Failure& failure) {
      code = static_cast<int>(failure.code());
    }
    _exit(code);
  }
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(WIFEXITED(status));
  LONGS_EQUAL(2, WEXITSTATUS(status));
  CHECK_FALSE(std::filesystem::exists(temp / "summary.json"));
  for (const char* name : {"object-1.tum", "object-1.csv", "timing.csv"}) {
    CHECK(text(name).size() > 9000);
    CHECK_TEXT(text(name).ends_with('\n'), name);
  }
}

TEST_GROUP(SummaryFile){};

TEST(SummaryFile, WhatIsNoSummaryIsRefusedWithItsName) {
  for (const char* text : {"", "{", "[]", "{\"version\": 3}", "null"}) {
    try {
      parse_summary(text, "x/summary.json");
      FAIL("took it");
    } catch (const Failure& failure) {
      STRNCMP_EQUAL("x/summary.json", failure.what(), 14);
    }
  }
}
