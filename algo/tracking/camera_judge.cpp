#include "algo/tracking/camera_judge.hpp"

namespace st {
namespace {

constexpr double kMostMove_m = 0.35, kMostTurn_rad = 0.5;  // from where the camera was expected
constexpr float kLostPaired = 0.03f, kPoorPaired = 0.08f;
constexpr float kLostExplained = 0.4f, kPoorExplained = 0.6f, kPoorOfUsual = 0.75f;
// A wall seen head-on lets the camera slide along it: the evidence against sliding is noise then.
constexpr double kUnseen_m = 0.004;
constexpr double kTypicalDistance_m = 1.5;
constexpr float kPace = 0.05f;

}  // namespace

CameraVerdict judge_camera(const CameraAlignResult& r, const CameraHabit& habit) {
  CameraVerdict v;
  if (!r.solved || r.facing == 0) return v;
  v.explained = static_cast<float>(r.inliers) / static_cast<float>(r.facing);
  v.paired = static_cast<float>(r.paired) / static_cast<float>(r.pixels);
  v.least_seen_m = least_seen_sigma_m(r.data_information, kTypicalDistance_m);
  const bool plausible =
      norm(r.T_view_camera.t) < kMostMove_m && rotation_angle(r.T_view_camera.R) < kMostTurn_rad;
  if (!plausible || v.paired < kLostPaired || v.explained < kLostExplained) return v;
  const bool doubtful = v.paired < kPoorPaired || v.explained < kPoorExplained ||
                        v.explained < kPoorOfUsual * habit.explained || v.least_seen_m > kUnseen_m;
  v.state = doubtful ? TrackState::kPoor : TrackState::kGood;
  return v;
}

void learn(CameraHabit& habit, const CameraVerdict& verdict) {
  habit.explained = habit.explained > 0 ? habit.explained + kPace * (verdict.explained - habit.explained)
                                        : verdict.explained;
}

}  // namespace st
