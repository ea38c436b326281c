// Scan mode over a whole recording: files, truth, determinism, a quiet compute thread, and the way back after
// the camera was covered.
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hal/results/ply_file.hpp"
#include "hal/results/tum_file.hpp"
#include "tests/replay/driven_circle.hpp"
#include "tests/sanitized.hpp"
#include "tests/support/program.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;

namespace {

nlohmann::json summary_of(const std::string& run) {
  return nlohmann::json::parse(content(run + "/summary.json"));
}

std::vector<TumPose> poses_in(const std::string& file) { return parse_tum(content(file)).poses; }

// Largest distance of the run's camera from the truth, once both agree at the run's first pose.
double worst_m(const std::string& run, const std::string& recording) {
  const std::vector<TumPose> truth = poses_in(recording + "/truth.tum"), seen = poses_in(run + "/camera.tum");
  double worst = 0;
  std::size_t at = 0;
  Pose T_truth_seen;
  for (const TumPose& pose : seen) {
    while (at < truth.size() && truth[at].t_s < pose.t_s - 1e-4) ++at;
    if (&pose == &seen.front()) T_truth_seen = truth.at(at).T * pose.T.inverse();
    worst = std::max(worst, norm((T_truth_seen * pose.T).t - truth.at(at).T.t));
  }
  return worst;
}

}  // namespace

TEST_GROUP(ReplayScan) {
  TempFolder folder;

  std::string scan(const std::string& recording, const std::string& name, int code = 0) {
    const std::string run = folder / name;
    const Said said = startrack({"replay", recording, "--mode", "scan", "--volume", "128", "--extent", "3",
                                 "--simd", "SSE4", "--out", run});
    LONGS_EQUAL_TEXT(code, said.code, said.err.c_str());
    return run;
  }
};

TEST(ReplayScan, TheCameraIsFollowedAndTheSceneIsLeft) {
  const std::string run = scan(hand_scan(), "scan");
  const nlohmann::json summary = summary_of(run);
  STRCMP_EQUAL("scan", summary["mode"].get<std::string>().c_str());
  LONGS_EQUAL(0, summary["lost"].get<int>());
  LONGS_EQUAL(summary["frames"].get<int>(), summary["tracked"].get<int>());
  UNSIGNED_LONGS_EQUAL(summary["frames"].get<std::size_t>(), poses_in(run + "/camera.tum").size());
  CHECK(worst_m(run, hand_scan()) < 0.012);  // small images, coarse voxels
  const Mesh scene = parse_ply(content(run + "/scene.ply"), "scene.ply");
  CHECK(scene.indices.size() > 3000);
  std::size_t colored = 0;
  for (const MeshVertex& v : scene.vertices) colored += v.r != v.g || v.g != v.b ? 1u : 0u;
  CHECK(colored > scene.vertices.size() / 2);
}

TEST(ReplayScan, TwiceTheSameBytesAndNeitherHeapNorFaults) {
  const nlohmann::json first = summary_of(scan(hand_scan(), "first")),
                       again = summary_of(scan(hand_scan(), "again"));
  CHECK(first["deterministic_hash"] == again["deterministic_hash"]);
  if (kSanitized) return;  // a sanitizer's shadow memory faults, and its allocator is not the one watched
  LONGS_EQUAL(0, first["memory"]["heap_calls_after_seal"].get<int>());
  LONGS_EQUAL(0, first["memory"]["page_faults_after_seal"].get<int>());
}

TEST(ReplayScan, ACoveredCameraIsLostAndFindsItsWayBack) {
  const std::string recording = folder / "covered";
  scan_covered_between(recording, 30, 45);
  const std::string run = scan(recording, "back");
  const std::string events = content(run + "/events.csv");
  CHECK(events.find(",lost,") != std::string::npos);
  CHECK(events.find(",recovered,") != std::string::npos);
  const nlohmann::json summary = summary_of(run);
  CHECK(summary["lost"].get<int>() >= 15 && summary["lost"].get<int>() < 40);
  CHECK(worst_m(run, hand_scan()) < 0.015);  // nothing of the dark was fused, and the way back is true
}

// Uncovered far from every place that it knows, it comes nearer try by try.
TEST(ReplayScan, ACameraThatWentOnBlindFindsItsWayBackFromANearMiss) {
  const std::string recording = folder / "went-on";
  scan_covered_between(recording, 20, 45);
  const std::string run = scan(recording, "near");
  CHECK(summary_of(run)["lost"].get<int>() < 25 + 8);
  CHECK(worst_m(run, hand_scan()) < 0.015);
}

TEST(ReplayScan, ACameraThatIsCoveredAtFirstBeginsOnceItSees) {
  const std::string recording = folder / "late";
  scan_covered_between(recording, 0, 10);
  const std::string run = scan(recording, "begun");
  LONGS_EQUAL(10, summary_of(run)["lost"].get<int>());
  CHECK(worst_m(run, hand_scan()) < 0.012);
}

TEST(ReplayScan, ACameraThatStaysCoveredEndsLost) {
  const std::string recording = folder / "dark";
  scan_covered_between(recording, 30, 89);
  const nlohmann::json summary = summary_of(scan(recording, "lost", 1));
  LONGS_EQUAL(30, summary["tracked"].get<int>());
}

TEST(ReplayScan, TheRobotIsCutOut) {
  const std::string run = scan(hand_scan(), "cut"), object = folder / "object.ply";
  const Said said = startrack({"cut", run, "--out", object, "--close-bottom"});
  LONGS_EQUAL_TEXT(0, said.code, said.err.c_str());
  const Mesh robot = parse_ply(content(object), "object.ply");
  float high = 0, wide = 0;
  for (const MeshVertex& v : robot.vertices) {
    high = std::max(high, v.position.z);
    wide = std::max(wide, std::max(std::fabs(v.position.x), std::fabs(v.position.y)));
  }
  CHECK(high > 0.06f && high < 0.14f);
  CHECK(wide > 0.12f && wide < 0.25f);
  const Said missing = startrack({"cut", folder.path()});
  LONGS_EQUAL(2, missing.code);
  CHECK(missing.err.find("scene.ply") != std::string::npos);
}
