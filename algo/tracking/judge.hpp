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

// The rule, in one place. `shift_sigmas`: how far the pose moved from the prediction, in its own sigmas.
Verdict judge(const AlignResult& result, const Agreement& agreement);

// What the turn about `up` (camera frame, unit) was read from; none when the data leave it open.
YawSource yaw_source_of(const AlignResult& result, const Vec3& up);

// Share of the model that must be in sight for the frame to say anything.
inline constexpr float kLeastInSight = 0.25f;

}  // namespace st
