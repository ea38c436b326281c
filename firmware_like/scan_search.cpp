// A camera that is lost, and the way back: where the scene is looked at from, and what has to hold before the
// camera counts as found.
#include "firmware_like/scan_tracker.hpp"

namespace st {

Pose ScanTracker::place_to_try() const {
  constexpr std::size_t kPlacesTried = 5;
  if (has_lead_) return T_world_lead_;
  const std::size_t turn = tries_ % (kPlacesTried + 1);
  if (turn == 0 || places_.size() == 0) return motion_.last();
  return places_.like(thumbnail_of(depth_.levels[2].z), (turn - 1) % places_.size()).T_world_camera;
}

// What is found by searching has more to show than what was followed.
bool ScanTracker::found() const {
  constexpr float kLeastPaired = 0.2f, kOfUsual = 0.85f;
  return verdict_.state == TrackState::kGood && verdict_.paired > kLeastPaired &&
         verdict_.explained > kOfUsual * habit_.explained && upright(camera_now_.T_world_camera);
}

// A try that explains something came near, and the next one from there has more in reach; so on for as long
// as each explains clearly more than the one before.
void ScanTracker::follow_lead() {
  constexpr float kClearlyMore = 0.02f;
  has_lead_ = verdict_.state != TrackState::kLost &&
              (!has_lead_ || verdict_.explained > lead_explained_ + kClearlyMore);
  T_world_lead_ = camera_now_.T_world_camera;
  lead_explained_ = verdict_.explained;
}

bool ScanTracker::upright(const Pose& T_world_camera) const {
  constexpr double kCosMostLean = 0.966;  // 15 degrees: a hand's pushes lean the accelerometer's up
  if (!input_->has_gravity || norm(up_world_) == 0) return true;
  return dot(T_world_camera.R * normalized(input_->gravity_mps2), normalized(up_world_)) > kCosMostLean;
}

void ScanTracker::lose() {
  search();
  log(EventKind::kLost, input_->t_s - last_good_t_s_);
}

void ScanTracker::search() {
  camera_now_.state = TrackState::kLost;
  course_ = Course::kSearching;
  tries_ = 0;
  has_lead_ = false;
}

// Found again: the scene may change once several frames in a row have borne it out.
void ScanTracker::prove() {
  constexpr int kProofs = 3;
  if (camera_now_.state != TrackState::kGood) {
    search();
    return;
  }
  motion_.take(input_->device_t_s, camera_now_.T_world_camera);
  if (++proven_ < kProofs) {
    camera_now_.state = TrackState::kPoor;
    return;
  }
  course_ = Course::kFollowing;
  poor_run_ = 0;
  log(EventKind::kRecovered, input_->t_s - last_good_t_s_);
}

}  // namespace st
