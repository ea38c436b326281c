// The turn of the robot as its wheels tell it, and which object that is about.
#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {
namespace {

// Of the turning rate: what slip and rounding leave, and the share by which wheels and their base are off.
constexpr double kRateSigma_rps = 0.03, kRateShare = 0.04;
// The same while nothing has shown yet that the one thing that moves goes along with the wheels.
constexpr double kGuessSigma_rps = 0.10;

}  // namespace

// The wheels tell the turn of the object that went along with them, as long as nothing seen contradicts them.
// False: they tell nothing in this frame.
bool ObjectTracker::ask_wheels(Track& track) {
  const WheelOdometry& wheels = frame_.input->wheels;
  track.asked_wheels = false;
  if (!config_.use_wheels || !wheels.valid || !(wheels.dt_s > 0)) return false;
  const double rate_rps = wheels.turn_rad / wheels.dt_s;
  if (wheeled_id_ == 0 && track.planar && is_alone(track)) {
    // A guess, with nothing said of where the heading comes from. It takes half a second to know whom the
    // wheels belong to, and a heading that depth alone saw would be gone by then.
    track.motion.turns_at(rate_rps, kGuessSigma_rps + kRateShare * std::fabs(rate_rps));
    return false;
  }
  if (track.id == 0 || track.id != wheeled_id_ || !track.planar || !track.wheels.trusted()) return false;
  track.motion.turns_at(rate_rps, kRateSigma_rps + kRateShare * std::fabs(rate_rps));
  track.asked_wheels = true;
  return true;
}

bool ObjectTracker::is_alone(const Track& track) const {
  return std::all_of(tracks_, tracks_ + kMaxObjects,
                     [&](const Track& other) { return &other == &track || !other.active(); });
}

// After a good pose: whether the wheels were right, and that the heading comes from them where nothing else
// shows it.
void ObjectTracker::judge_wheels(Track& track) {
  if (!track.asked_wheels) return;
  const double predicted = support_.on_floor(track.motion.pose()).yaw;
  const double seen = support_.on_floor(track.aligned.T_camera_object).yaw;
  track.wheels.seen(frame_.input->wheels.turn_rad, wrap_angle(seen - predicted));
  if (track.yaw_source == YawSource::kNone) track.yaw_source = YawSource::kOdometry;
}

// Which object goes along with the wheels.
void ObjectTracker::match_wheels() {
  if (!config_.use_wheels) return;
  went_along_.begin_frame(frame_.input->wheels);
  for (const Track& track : tracks_) {
    if (track.id == 0 || track.phase != Track::Phase::kTracked || track.state != TrackState::kGood) continue;
    const Pose2 at = support_.on_floor(track.T_camera_object * track.T_model_object);
    went_along_.add(track.id, at.x, at.y);
  }
  wheeled_id_ = went_along_.best();
}

}  // namespace st
