// How objects begin, are confirmed, get lost, leave, are found again and make room: decide_lives() and what
// it needs.
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
constexpr int kNewcomerFrames =
    2;  // frames in which an unexplained segment must stand before it becomes a track
constexpr int kLeastNewcomer_px = 120;
constexpr double kLeastNewcomer_m2 = 0.002;
constexpr int kYawsPerFrame = 3;
constexpr int kSearchPatience = 5;

bool overlap(const Rect& a, const Rect& b) {
  return a.u0 < b.u1 && b.u0 < a.u1 && a.v0 < b.v1 && b.v0 < a.v1;
}

// Share of the box that lies inside the image.
double share_inside(const Rect& box, int width, int height) {
  const double area = static_cast<double>(box.width()) * box.height();
  const Rect in = box.clipped(width, height);
  return area > 0 ? static_cast<double>(in.width()) * in.height() / area : 0.0;
}

}  // namespace

void ObjectTracker::log(EventKind kind, int object, double a, double b) {
  events_.push_back({frame_.input->t_s, kind, object, a, b, 0});
}

void ObjectTracker::confirm(Track& track) {
  track.phase = Track::Phase::kTracked;
  track.id = next_id_++;
  log(EventKind::kConfirmed, track.id);
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
    track.phase = Track::Phase::kFree;
    return;
  }
  const Rect box = image_box(track.bounds, track.motion.pose(), frame_.camera, 0);
  track.phase = Track::Phase::kLost;
  track.left_view = share_inside(box, frame_.camera.width, frame_.camera.height) < 0.6;
  log(track.left_view ? EventKind::kLeft : EventKind::kLost, track.id,
      frame_.input->t_s - track.last_good_t_s);
}

std::size_t ObjectTracker::free_slot() {
  for (std::size_t k = 0; k < kMaxObjects; ++k)
    if (tracks_[k].phase == Track::Phase::kFree) return k;
  // Least to lose first: lost objects by how little was seen of them, then the one that has stood still for
  // longest.
  std::size_t victim = kMaxObjects;
  for (std::size_t k = 0; k < kMaxObjects; ++k)
    if (tracks_[k].phase == Track::Phase::kLost &&
        (victim == kMaxObjects || tracks_[k].good_poses < tracks_[victim].good_poses))
      victim = k;
  if (victim == kMaxObjects) {
    constexpr int kStands = 30;
    for (std::size_t k = 0; k < kMaxObjects; ++k)
      if (tracks_[k].still_run >= kStands &&
          (victim == kMaxObjects || tracks_[k].still_run > tracks_[victim].still_run))
        victim = k;
  }
  if (victim == kMaxObjects) return victim;
  if (tracks_[victim].id > 0) log(EventKind::kEvicted, tracks_[victim].id);
  if (search_.running && search_.track == victim) search_.running = false;
  tracks_[victim].phase = Track::Phase::kFree;
  return victim;
}

void ObjectTracker::claim_pixels(const Unexplained& what, std::size_t k) {
  for (int v = what.box.v0; v < what.box.v1; ++v)
    for (int u = what.box.u0; u < what.box.u1; ++u)
      if (segmentation_->labels(u, v) == what.label && frame_.owners(u, v) == kForeign)
        frame_.owners(u, v) = static_cast<std::uint8_t>(k + 1);
}

// Something that stood there from the first frame has just begun to move. What it looked like at rest,
// averaged over the learning frames, is the best first frame there is, and no hand touched it yet.
void ObjectTracker::begin_released() {
  if (!segmentation_->has_released) return;
  const ReleasedProto& released = segmentation_->released;
  const std::size_t k = free_slot();
  if (k == kMaxObjects) return;
  const std::span<const float> z_of_code = segmenter_.tables().z_of_code();
  const ImageView<const std::uint16_t> code = segmentation_->released_code;
  for (int i = 0; i < rest_z_.pixels(); ++i) rest_z_.data[i] = 0;
  const Rect box = released.box.clipped(rest_z_.width, rest_z_.height);
  const std::span<ObservedPoint> points = points_of(k);
  std::size_t used = 0;
  const int every = released.pixels / static_cast<int>(points.size()) + 1;
  int seen = 0;
  for (int v = box.v0; v < box.v1; ++v) {
    for (int u = box.u0; u < box.u1; ++u) {
      const float z = z_of_code[code(u, v)];
      rest_z_(u, v) = z;
      if (!(z > 0) || seen++ % every != 0) continue;
      points[used].p = frame_.camera.ray(static_cast<float>(u), static_cast<float>(v)) * z;
      points[used].luminance = -1;
      ++used;
    }
  }
  if (used < 40) return;
  Track& track = tracks_[k];
  start_track(track, find_footprint(points.first(used), support_), support_, frame_.input->device_t_s);
  track.from_background = true;
  track.has_moved = true;
  fuse_at_rest(track, box);
  // Pixels of the thing in this frame are its own already, so that no second track starts from them.
  for (std::size_t i = 0; i < unexplained_.size();) {
    if (!overlap(unexplained_[i].box, box)) {
      ++i;
      continue;
    }
    if (segmentation_->segments[unexplained_[i].label - 1u].from_background) claim_pixels(unexplained_[i], k);
    unexplained_.erase(i);
  }
}

void ObjectTracker::begin_from_pixels(const Unexplained& what) {
  const std::size_t k = free_slot();
  if (k == kMaxObjects) return;
  Track& track = tracks_[k];
  claim_pixels(what, k);
  observe(track, k, what.box, true);
  if (track.points_used < 40) {
    track.phase = Track::Phase::kFree;
    return;
  }
  start_track(track, find_footprint(points_of(k).first(track.points_used), support_), support_,
              frame_.input->device_t_s);
  if (config_.init_frames >= 1) fuse(track, k);
}

ObjectTracker::Newcomer* ObjectTracker::newcomer_at(const Rect& box) {
  for (Newcomer& newcomer : newcomers_)
    if (overlap(newcomer.box, box)) return &newcomer;
  return nullptr;
}

// A segment becomes a track when it was there in the frame before, too: single-frame flicker begins nothing.
// While a lost object is looked for in it, it waits.
void ObjectTracker::begin_tracks() {
  for (Newcomer& newcomer : newcomers_) newcomer.seen = false;
  for (const Unexplained& what : unexplained_) {
    const double px_m = what.centroid.z / frame_.camera.fx;
    if (what.pixels < kLeastNewcomer_px || what.pixels * px_m * px_m < kLeastNewcomer_m2) continue;
    Newcomer* known = newcomer_at(what.box);
    if (known == nullptr) {
      newcomers_.push_back({what.box, 1, 0, true});
      continue;
    }
    known->box = what.box;
    known->seen = true;
    const bool searched = search_.running && overlap(search_.box, what.box);
    if (!searched && ++known->frames >= kNewcomerFrames) {
      begin_from_pixels(what);
      known->seen = false;
    }
  }
  for (std::size_t i = 0; i < newcomers_.size();) {
    if (newcomers_[i].seen)
      ++i;
    else
      newcomers_.erase(i);
  }
}

double ObjectTracker::try_yaw(Track& track, std::size_t k, const Footprint& footprint, double yaw_rad) {
  const Pose T = hypothesis(track, footprint, support_, yaw_rad);
  render_one(track, T);
  if (track.view_pixels < 40) return 0;
  AlignInput in = alignment_of(track, k);
  in.start = T;
  in.pivot = T.t;
  in.terms.motion = false;
  in.largest_start_error_m = 0.04;
  in.levels = 2;
  track.aligned = align(in, scratch_);
  const Pose D = track.aligned.T_camera_object * T.inverse();
  track.agreement = compare(track.view, frame_.camera, frame_.depth_z, D, track.aligned.depth);
  return fit_score(track.aligned, track.agreement);
}

void ObjectTracker::finish_search(const Unexplained& candidate, const Footprint& footprint) {
  const std::size_t k = search_.track;
  Track& track = tracks_[k];
  double best = 0;
  Pose best_pose;
  for (const Search::Found& found : search_.best) {
    if (found.score <= 0) continue;
    const double score = try_yaw(track, k, footprint, found.yaw_rad);
    if (score <= best || judge(track.aligned, track.agreement) != Verdict::kGood) continue;
    best = score;
    best_pose = track.aligned.T_camera_object;
  }
  search_.running = false;
  if (best <= 0) {
    Newcomer* known = newcomer_at(candidate.box);  // somebody else
    if (known == nullptr)
      newcomers_.push_back({candidate.box, 1, static_cast<std::uint8_t>(1u << k), true});
    else
      known->refused_by = static_cast<std::uint8_t>(known->refused_by | 1u << k);
    return;
  }
  log(EventKind::kRecovered, track.id, frame_.input->t_s - track.last_good_t_s);
  track.phase = Track::Phase::kTracked;
  track.left_view = false;
  track.poor_run = 0;
  track.state = TrackState::kPoor;
  track.T_camera_object = best_pose;
  track.motion.start(best_pose, support_.R_camera_floor.transposed(), frame_.input->device_t_s);
}

// Looks for a lost object of the size of something unexplained, unless that pair was tried already.
void ObjectTracker::start_search() {
  for (std::size_t k = 0; k < kMaxObjects; ++k) {
    if (tracks_[k].phase != Track::Phase::kLost) continue;
    for (const Unexplained& what : unexplained_) {
      const Newcomer* known = newcomer_at(what.box);
      if (what.pixels < kLeastNewcomer_px || (known != nullptr && (known->refused_by >> k & 1u) != 0))
        continue;
      const std::size_t used = gather_points(frame_.depth_z, segmentation_->labels, what.label, what.box,
                                             frame_.camera, {}, points_of(k));
      if (used < 40) continue;
      const Footprint footprint = find_footprint(points_of(k).first(used), support_);
      if (!size_fits(tracks_[k].bounds, footprint.bounds, what.touches_border)) continue;
      search_.start(k, what);
      return;
    }
  }
}

void ObjectTracker::search_step() {
  if (!search_.running) start_search();
  if (!search_.running) return;
  const std::size_t k = search_.track;
  const Unexplained* candidate = nullptr;
  for (const Unexplained& what : unexplained_)
    if (overlap(what.box, search_.box) && norm(what.centroid - search_.centroid) < 0.2f) candidate = &what;
  if (candidate == nullptr) {
    if (++search_.frames_without > kSearchPatience) search_.running = false;
    return;
  }
  search_.frames_without = 0;
  search_.box = candidate->box;
  search_.centroid = candidate->centroid;
  Track& track = tracks_[k];
  claim_pixels(*candidate, k);
  track.motion.rest();  // how it moves now is not known
  observe(track, k, candidate->box, true);
  if (track.points_used < 40) return;
  const Footprint footprint = find_footprint(points_of(k).first(track.points_used), support_);
  for (int i = 0; i < kYawsPerFrame && search_.next_yaw < kSearchYaws; ++i, ++search_.next_yaw) {
    const double yaw = 2.0 * kPi * search_.next_yaw / kSearchYaws;
    const double score = try_yaw(track, k, footprint, yaw);
    const Mat3 turned = track.aligned.T_camera_object.R * track.view.T_camera_object.R.transposed();
    if (score > 0) search_.note(score, yaw + dot(rotation_to_vector(turned), support_.up));
  }
  if (search_.next_yaw == kSearchYaws) finish_search(*candidate, footprint);
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

void ObjectTracker::decide_lives() {
  for (Track& track : tracks_) {
    if (!track.active()) continue;
    const bool candidate = track.phase == Track::Phase::kCandidate;
    const double speed = norm(track.motion.velocity_mps()) + 0.15 * norm(track.motion.angular_velocity_rps());
    track.still_run = speed < 0.03 ? track.still_run + 1 : 0;
    if (candidate && track.good_poses >= kGoodPosesToConfirm && track.has_moved) confirm(track);
    if (candidate && !track.has_moved && track.good_poses > kStillCandidate)
      track.phase = Track::Phase::kFree;
    if (track.poor_run > (candidate ? kCandidatePatience : kTrackedPatience)) lose(track);
  }
  begin_released();
  search_step();
  begin_tracks();
  freeze_background();
}

}  // namespace st
