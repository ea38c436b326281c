#include "tools/evaluate/evaluate.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "algo/core/scalar_math.hpp"
#include "hal/error.hpp"
#include "hal/results/object_files.hpp"
#include "hal/results/text_format.hpp"

using namespace st;

namespace {

constexpr int kFrames = 240;
const Pose kOffset{rotation_from_vector({0.1, -0.2, 1.1}), {0.03, -0.02, 0.01}};

double stamp(int i) { return 1000 + i / 30.0; }

Pose true_pose(int i) {
  const double a = 0.02 * i;
  const SinCos sc = sin_cos(a);
  return {rotation_from_vector({0.3, 0.1, a}), {0.5 * sc.cos, 0.5 * sc.sin, 2.0 + 0.1 * sc.sin}};
}

// Errors without chance, so that the numbers below stay what the script computed from these very files.
Pose estimated_pose(int i) {
  const Pose wrong{
      rotation_from_vector({0.002 * ((i * 7) % 11 - 5), 0.0, 0.0015 * ((i * 5) % 13 - 6) + 2e-4 * i}),
      {0.001 * ((i * 3) % 7 - 3), 0.0005 * ((i * 11) % 9 - 4), 0.0007 * ((i * 13) % 5 - 2)}};
  return true_pose(i) * kOffset.inverse() * wrong;
}

template <typename Keep, typename PoseOf>
NamedTrajectory trajectory(const char* name, Keep keep, PoseOf pose_of) {
  std::string text = "# made by a test\n";
  for (int i = 0; i < kFrames; ++i)
    if (keep(i)) append_tum_row(text, stamp(i), pose_of(i));
  return {name, parse_tum(text)};
}

bool everything(int) { return true; }
bool with_gaps(int i) { return i >= 10 && !(i >= 100 && i < 115) && i % 50 != 49; }

}  // namespace

TEST_GROUP(Evaluate) {
  using Json = nlohmann::json;
  const NamedTrajectory truth = trajectory("gt.tum", everything, true_pose);
  const NamedTrajectory estimate = trajectory("est.tum", with_gaps, estimated_pose);

  static void close(double expected, const Json& value) {
    DOUBLES_EQUAL(expected, value.get<double>(), 1e-6 * std::fabs(expected) + 1e-9);
  }
};

TEST(Evaluate, TheOffsetBetweenTheFramesIsTakenOut) {
  const auto exact = trajectory("e", everything, [](int i) { return true_pose(i) * kOffset.inverse(); });
  const Json r = Json::parse(evaluate_objects({truth}, {exact}, {}));
  DOUBLES_EQUAL(0, r["trans_mm"]["max"].get<double>(), 0.005);
  DOUBLES_EQUAL(0, r["rot_deg"]["max"].get<double>(), 0.001);
  for (int row = 0; row < 3; ++row)
    DOUBLES_EQUAL(kOffset.t[row], r["B"][static_cast<std::size_t>(row)][3].get<double>(), 1e-6);
}

// Figures of eval_traj.py for the same files.
TEST(Evaluate, ObjectModeGivesTheFiguresOfTheScript) {
  const Json r = Json::parse(evaluate_objects({truth}, {estimate}, {}));
  LONGS_EQUAL(211, r["matched"].get<int>());
  close(0.879166667, r["coverage"]);
  LONGS_EQUAL(4, r["gaps"]["count"].get<int>());
  close(0.533333, r["gaps"]["longest_s"]);
  close(0.333333, r["gaps"]["before_first_s"]);
  close(2.62893282, r["trans_mm"]["rmse"]);
  close(3.80378793, r["trans_mm"]["p95"]);
  close(0.785499991, r["rot_deg"]["median"]);
  close(0.838791904, r["yaw_deg"]["rmse"]);
  close(-0.00787748555, r["yaw_deg"]["mean"]);
  close(0.788767044, r["tilt_deg"]["max"]);
  close(1.41369967, r["first_b"]["yaw_deg"]["rmse"]);
  close(1.06619497, r["first_b"]["final"]["trans_mm"]);
  close(5.11702679, r["rpe_1s"]["trans_mm"]["rmse"]);
  LONGS_EQUAL(168, r["rpe_1s"]["pairs"].get<int>());
  close(2.31055973, r["gt_path_m"]);
  close(261.552447, r["gt_turn_deg"]);
}

TEST(Evaluate, CameraModeGivesTheFiguresOfTheScript) {
  const Json r = Json::parse(evaluate_camera(truth, estimate));
  close(5.12504387, r["ate"]["trans_mm"]["rmse"]);
  close(0.991098744, r["ate"]["sim3_scale"]);
  close(783.824049, r["first_pose"]["trans_mm"]["mean"]);
}

TEST(Evaluate, ATrackThatChangesCountsAsASwitch) {
  const auto early = trajectory(
      "a", [](int i) { return i < 115; }, estimated_pose);
  const auto late = trajectory(
      "b", [](int i) { return i >= 100; },
      [](int i) {
        Pose T = estimated_pose(i);
        if (i < 120) T.t.x += 0.1;  // farther than the other while both are there
        return T;
      });
  const Json r = Json::parse(evaluate_objects({truth}, {early, late}, {}));
  LONGS_EQUAL(1, r["id_switches"].get<int>());
  LONGS_EQUAL(2, r["tracks_used"].get<int>());
  STRCMP_EQUAL("b#0", r["track"].get<std::string>().c_str());
  DOUBLES_EQUAL(1, r["coverage_any_track"].get<double>(), 0);
}

TEST(Evaluate, FramesWithoutTheObjectInSightDoNotCount) {
  std::string visible = "host_t,clk_t,tick,frame,robot_px,robot_frac\n";
  for (int i = 0; i < kFrames; ++i) {
    append_fixed(visible, stamp(i), 6);
    visible += ",1,2,3," + std::string(i < 60 ? "10" : "5000") + ",1.0\n";
  }
  const Json r = Json::parse(evaluate_objects({truth}, {estimate}, {visible, "visible.csv"}));
  LONGS_EQUAL(180, r["gt_frames_visible"].get<int>());
  LONGS_EQUAL(49, r["estimates_while_invisible"].get<int>());
  CHECK_THROWS(Failure, evaluate_objects({truth}, {estimate}, {"a,b\n1,2\n", "visible.csv"}));
}

TEST(Evaluate, TooLittleToScoreIsSaid) {
  const auto two = trajectory(
      "e", [](int i) { return i < 2; }, estimated_pose);
  STRCMP_EQUAL("fewer than 3 associated frames",
               Json::parse(evaluate_objects({truth}, {two}, {}))["error"].get<std::string>().c_str());
  STRCMP_EQUAL("no estimates",
               Json::parse(evaluate_objects({truth}, {}, {}))["error"].get<std::string>().c_str());
  STRCMP_EQUAL("no estimates", Json::parse(evaluate_objects({truth, truth}, {}, {}))["objects"][1]["error"]
                                   .get<std::string>()
                                   .c_str());
  CHECK(evaluation_table(evaluate_objects({truth}, {two}, {})).find("no score") != std::string::npos);
}

TEST(Evaluate, TheTableHoldsTheFigures) {
  const std::string table = evaluation_table(evaluate_objects({truth}, {estimate}, {}));
  for (const char* word : {"position (mm)", "yaw (deg)", "drift over 1 s (mm)", "coverage"})
    CHECK_TEXT(table.find(word) != std::string::npos, word);
}
