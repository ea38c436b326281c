#include "algo/tracking/judge.hpp"

#include <cmath>

namespace st {

Agreement compare(const ModelView& view, const Pinhole& camera, ImageView<const float> depth_z, const Pose& D,
                  const DepthTermResult& depth) {
  const PoseF Df = to_float(D);
  int counts[4] = {0, 0, 0, 0};  // same, through, hidden, unknown
  Agreement a;
  constexpr int kStep = 2;  // a quarter of the pixels tells as much
  const Rect& box = view.maps.roi;
  for (int v = box.v0; v < box.v1; v += kStep) {
    for (int u = box.u0; u < box.u1; u += kStep) {
      const float z = view.z(u, v);
      if (!(z > 0)) continue;
      const Vec3f p = Df * (camera.ray(static_cast<float>(u), static_cast<float>(v)) * z);
      if (!(p.z > 0.1f)) continue;
      const auto [pu, pv] = camera.pixel_of(p);
      ++a.model_pixels;
      if (!depth_z.contains(pu, pv) || !(depth_z(pu, pv) > 0)) {
        ++counts[3];
        continue;
      }
      const float gap = depth_z(pu, pv) - p.z, reach = 0.02f + 3.0f * depth_sigma_m(p.z);
      ++counts[gap > reach ? 1 : gap < -reach ? 2 : 0];
    }
  }
  if (a.model_pixels > 0) {
    const float n = static_cast<float>(a.model_pixels);
    a.same = static_cast<float>(counts[0]) / n;
    a.through = static_cast<float>(counts[1]) / n;
    a.hidden = static_cast<float>(counts[2]) / n;
    a.unknown = static_cast<float>(counts[3]) / n;
  }
  if (depth.tried > 0) a.explained = static_cast<float>(depth.inliers) / static_cast<float>(depth.tried);
  return a;
}

namespace {

// Of the model's pixels that the frame says anything about, the share that it shows where they should be.
float agreeing(const Agreement& a) {
  const float seen = a.same + a.through;
  return seen > 0 ? a.same / seen : 0.0f;
}

// A part of what was modelled is not there any more, an arm that had carried the object, and the rest fits as
// well as ever: the pose is good, and the model has to change.
bool part_is_gone(const Agreement& a) { return a.explained > 0.9f && agreeing(a) > 0.3f; }

constexpr int kHabitFrames = 15;  // before it counts
constexpr float kHabitPace = 0.05f;
constexpr float kHabitAgree = 0.85f;  // of what is usual: least agreement
// Largest spread of the colour residuals, grey levels: where nothing is wrong it stays near what is usual,
// and a pose a few degrees off doubles it.
constexpr float kHabitColorTimes = 2.0f, kHabitColorMore = 1.0f;

void learn_one(float value, int& frames, float& habit) {
  habit = frames++ == 0 ? value : habit + kHabitPace * (value - habit);
}

}  // namespace

bool Habit::knows_color() const { return colored_frames_ >= kHabitFrames; }

bool Habit::broken_by_color(const AlignResult& result) const {
  return knows_color() && result.color.sigma > kHabitColorTimes * color_sigma_ + kHabitColorMore;
}

bool Habit::wondered_at_by_color(const AlignResult& result) const {
  constexpr float kTimes = 1.4f, kMore = 0.5f;
  return knows_color() && result.color.sigma > kTimes * color_sigma_ + kMore;
}

bool Habit::broken_by(const AlignResult& result, const Agreement& a) const {
  if (broken_by_color(result)) return true;
  return frames_ >= kHabitFrames && agreeing(a) < kHabitAgree * agree_ && !part_is_gone(a);
}

float Habit::least_explained() const {
  constexpr float kAnybody = 0.75f, kShareOfUsual = 0.9f;
  const float usual = kShareOfUsual * explained_;
  return frames_ >= kHabitFrames && usual < kAnybody ? usual : kAnybody;
}

void Habit::learn(const AlignResult& result, const Agreement& a) {
  int frames = frames_;
  learn_one(a.explained, frames, explained_);
  learn_one(agreeing(a), frames_, agree_);
  if (result.color.used > 0) learn_one(result.color.sigma, colored_frames_, color_sigma_);
}

Verdict judge(const AlignResult& result, const Agreement& a, const Habit& habit) {
  const Verdict verdict = judge(result, a);
  return verdict == Verdict::kGood && habit.broken_by(result, a) ? Verdict::kPoor : verdict;
}

Verdict judge(const AlignResult& result, const Agreement& a) {
  if (!result.solved || a.model_pixels < 20 || result.depth.inliers < 30) return Verdict::kLost;
  const float agree = agreeing(a);
  if (a.same + a.through < kLeastInSight || agree < 0.3f) return Verdict::kLost;
  if ((agree < 0.65f && !part_is_gone(a)) || a.explained < 0.35f) return Verdict::kPoor;
  return Verdict::kGood;
}

YawSource yaw_source_of(const AlignResult& result, const Vec3& up) {
  constexpr double kSeen_rad = 0.035;  // 2 degrees, one sigma
  const double all = turn_sigma_rad(result.data_information, up);
  if (all > kSeen_rad) return YawSource::kNone;
  const double shape = turn_sigma_rad(result.shape_information, up);
  return result.color.used > kLeastColored && all < 0.7 * shape ? YawSource::kColor : YawSource::kDepth;
}

}  // namespace st
