// Whether a pose may be believed: good goes out and into the model, poor neither, lost starts the search.
#pragma once

#include <span>

#include "algo/core/records.hpp"
#include "algo/tracking/align.hpp"
#include "algo/tracking/model_view.hpp"

namespace st {

// How the model, placed at the pose, agrees with the frame. Shares of the model's visible pixels.
struct Agreement {
  int model_pixels = 0;
  float same = 0;       // the frame's depth lies on the model
  float through = 0;    // the frame sees past the model: it is not there
  float hidden = 0;     // something nearer stands before it
  float unknown = 0;    // no depth
  float explained = 0;  // share of the object's observed points that lie on the model
};

// view: rendered near the pose; D moves it there (T = D * view.T_camera_object).
Agreement compare(const ModelView& view, const Pinhole& camera, ImageView<const float> depth_z, const Pose& D,
                  const DepthTermResult& depth);

enum class Verdict { kGood, kPoor, kLost };

// How well a track's good poses agree with their frames as a rule. After a jump the alignment may settle
// beside the object, or turned against it, in a pose that would pass for another object's; what falls far
// behind its own track's habit is not believed.
class Habit {
 public:
  bool broken_by(const AlignResult& result, const Agreement& agreement) const;
  // The colours fit clearly worse than usual, though perhaps not so badly that the pose is wrong.
  bool wondered_at_by_color(const AlignResult& result) const;
  bool broken_by_color(const AlignResult& result) const;
  bool knows_color() const;
  // What a pose that was found by searching must reach: soft and ragged things never fit well.
  float least_explained() const;
  // Also from poses that broke it: what stays different (the lamps went out, a cloth lies on it) becomes the
  // habit before the track would be given up.
  void learn(const AlignResult& result, const Agreement& agreement);

 private:
  float agree_ = 0, explained_ = 0, color_sigma_ = 0;
  int frames_ = 0, colored_frames_ = 0;
};

// The rule, in one place: for any pose, and for one of a track that has its habit.
Verdict judge(const AlignResult& result, const Agreement& agreement);
Verdict judge(const AlignResult& result, const Agreement& agreement, const Habit& habit);

// Points with a colour from which the colours say something.
inline constexpr int kLeastColored = 50;

// What the turn about `up` (camera frame, unit) was read from; none when the data leave it open.
YawSource yaw_source_of(const AlignResult& result, const Vec3& up);

// Share of the model that must be in sight for the frame to say anything.
inline constexpr float kLeastInSight = 0.25f;

}  // namespace st
