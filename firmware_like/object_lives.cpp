// How objects are confirmed, get lost, leave and make room: decide_lives() and what it needs.
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "algo/tracking/image_box.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {
namespace {

constexpr int kGoodPosesToConfirm = 3;
constexpr int kCandidatePatience = 6;  // frames without a good pose
constexpr int kTrackedPatience = 8;    // then the search begins
constexpr int kStillCandidate = 90;    // good poses without motion: not a mover

}  // namespace

void ObjectTracker::log(EventKind kind, int object, double a, double b, double c) {
  events_.push_back({frame_.input->t_s, kind, object, a, b, c});
}

void ObjectTracker::confirm(Track& track) {
  track.phase = Track::Phase::kTracked;
  track.id = next_id_++;
  log(EventKind::kConfirmed, track.id);
  counts_.push_back({track.id, frame_.input->t_s, frame_.input->t_s});
  if (has_floor_frame_) return;
  // The floor frame of the run: below object 1, x along the camera's axis laid on the floor.
  has_floor_frame_ = support_frozen_ = true;
  const Vec3 origin = track.T_camera_object.t -
                      support_.up * (support_.found ? support_.height_of(track.T_camera_object.t) : 0.0);
  T_floor_camera_ = Pose{support_.R_camera_floor, origin}.inverse();
  if (!support_.found) log(EventKind::kNoFloor, track.id);
}

void ObjectTracker::lose(Track& track) {
  if (track.phase == Track::Phase::kCandidate) {
    mark_barren(track);
    free_slot(track);
    return;
  }
  const Rect box = image_box(track.bounds, track.motion.pose(), frame_.camera, 0);
  track.phase = Track::Phase::kLost;
  track.left_view = share_inside(box, frame_.camera.width, frame_.camera.height) < 0.6;
  log(track.left_view ? EventKind::kLeft : EventKind::kLost, track.id,
      frame_.input->t_s - track.last_good_t_s);
}

// Whoever searched for the track, or in it, gives up.
void ObjectTracker::free_slot(Track& track) {
  const auto k = static_cast<std::size_t>(&track - tracks_);
  track.phase = Track::Phase::kFree;
  previous_[k].surface_pixels = 0;
  if (search_.track == k || (search_.where == Search::Where::kRival && search_.rival == k))
    search_.running = false;
}

void ObjectTracker::evict(Track& track) {
  if (track.id > 0) {
    log(EventKind::kEvicted, track.id);
    if (ObjectCount* count = count_of(track.id)) count->good_at_end = false;
  }
  free_slot(track);
}

// Something unexplained takes a slot, if need be from what is worth less; kMaxObjects: it has to wait.
std::size_t ObjectTracker::make_room(Newness newness) {
  const std::size_t k = slot_for(tracks_, newness);
  if (k < kMaxObjects && tracks_[k].phase != Track::Phase::kFree) evict(tracks_[k]);
  return k;
}

// Two tracks of one thing: begun from its two ends, say. When the smaller model lies in the larger one for a
// while, it gives way, or the one of them that is not confirmed; two things cannot be in one place.
void ObjectTracker::drop_doubles() {
  constexpr int kPatience = 10;  // frames
  constexpr float kSamePlace_m = 0.02f;
  const auto coincide = [](const Track& small, const Track& large) {
    const auto a = [&](int u, int v) { return small.view.z(u, v); };
    const auto b = [&](int u, int v) { return large.view.z(u, v); };
    return 2 * count_same_surface(a, b, small.view.maps.roi, kSamePlace_m) > small.view_pixels;
  };
  bool doubled[kMaxObjects]{};
  for (std::size_t i = 0; i < kMaxObjects; ++i) {
    for (std::size_t j = 0; j < kMaxObjects; ++j) {
      const Track &small = tracks_[i], &large = tracks_[j];
      if (!small.active() || !large.active() || small.view_pixels >= large.view_pixels) continue;
      const bool larger_is_nobody = small.phase != large.phase && large.phase == Track::Phase::kCandidate;
      bool& gives_way = doubled[larger_is_nobody ? j : i];
      gives_way = gives_way || coincide(small, large);
    }
  }
  for (std::size_t i = 0; i < kMaxObjects; ++i) {
    tracks_[i].double_run = doubled[i] ? tracks_[i].double_run + 1 : 0;
    if (tracks_[i].double_run <= kPatience) continue;
    if (tracks_[i].phase == Track::Phase::kCandidate) mark_barren(tracks_[i]);
    evict(tracks_[i]);
  }
}

// Pixels of tracks, and of where their models stand, are not background in the next frame, whatever they look
// like.
void ObjectTracker::freeze_background() {
  // On copies of pointer and count, and stored always: bytes may alias anything, and this is the whole frame.
  std::uint8_t* const owners = frame_.owners.data;
  const int pixels = frame_.owners.pixels();
  for (int i = 0; i < pixels; ++i) owners[i] = owners[i] == kForeign ? std::uint8_t{0} : owners[i];
  for (std::size_t k = 0; k < kMaxObjects; ++k) {
    const Track& track = tracks_[k];
    if (!track.active() || track.view_pixels == 0) continue;
    const Rect box = track.view.maps.roi.clipped(frame_.owners.width, frame_.owners.height);
    for (int v = box.v0; v < box.v1; ++v) {
      for (int u = box.u0; u < box.u1; ++u) {
        const float model = track.view.z(u, v), z = frame_.depth_z(u, v);
        if (model > 0 && z > 0 && frame_.owners(u, v) == 0 && std::fabs(z - model) < 0.05f)
          frame_.owners(u, v) = static_cast<std::uint8_t>(k + 1);
      }
    }
  }
}

// A candidate with enough good poses that is nobody who is missed.
bool ObjectTracker::is_proven(const Track& candidate) const {
  if (candidate.phase != Track::Phase::kCandidate || candidate.good_poses < kGoodPosesToConfirm ||
      !candidate.has_moved)
    return false;
  for (const Track& lost : tracks_)
    if (may_be_lost_one(candidate, lost)) return false;
  return true;
}

// Numbers those that have proved themselves: in one frame the larger first, then the one further left.
void ObjectTracker::confirm_proven() {
  for (std::size_t round = 0; round < kMaxObjects; ++round) {
    std::size_t next = kMaxObjects;
    for (std::size_t k = 0; k < kMaxObjects; ++k) {
      if (!is_proven(tracks_[k])) continue;
      const bool first = next == kMaxObjects || owned_[k].pixels > owned_[next].pixels ||
                         (owned_[k].pixels == owned_[next].pixels && owned_[k].box.u0 < owned_[next].box.u0);
      if (first) next = k;
    }
    if (next == kMaxObjects) return;
    confirm(tracks_[next]);
  }
}

// Last of all it is decided who is confirmed: what has to make room in this frame never gets a number.
void ObjectTracker::decide_lives(const LadderStep& step) {
  for (Track& track : tracks_) {
    track.lost_run = track.phase == Track::Phase::kLost ? track.lost_run + 1 : 0;
    if (!track.active()) continue;
    const bool candidate = track.phase == Track::Phase::kCandidate;
    const double speed = norm(track.motion.velocity_mps()) + 0.15 * norm(track.motion.angular_velocity_rps());
    track.still_run = speed < 0.03 ? track.still_run + 1 : 0;
    const bool stands = candidate && !track.has_moved && track.good_poses > kStillCandidate;
    if (stands || track.poor_run > (candidate ? kCandidatePatience : kTrackedPatience)) lose(track);
  }
  drop_doubles();
  begin_released();
  if (!tracks_by_matches()) {
    search_step(step);
    recognition_step(step);
  }
  begin_tracks();
  confirm_proven();
  freeze_background();
}

}  // namespace st
