// Finding lost objects again, a few tried poses in each frame: where something unexplained of their size has
// turned up, and in place, where an arm that still holds them hides their size.
#include "algo/core/scalar_math.hpp"
#include "algo/tracking/image_box.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {
namespace {

constexpr int kYawsPerFrame = 3;
constexpr int kSearchPatience = 5;
constexpr int kInPlaceFrames = 90;  // for so long a lost object is expected where it was

}  // namespace

double ObjectTracker::try_pose(Track& track, std::size_t k, const Pose& T_camera_object) {
  render_one(track, T_camera_object);
  if (track.view_pixels < kLeastPoints) return 0;
  track.points_used = gather_near_view(
      frame_.depth_z, frame_.owners, static_cast<std::uint8_t>(k + 1), track.view, frame_.camera,
      frame_.has_color ? registered_color_ : ImageView<std::uint32_t>{}, points_of(k));
  if (track.points_used < kLeastPoints) return 0;
  AlignInput in = alignment_of(track, k);
  in.start = T_camera_object;
  in.pivot = T_camera_object.t;
  in.terms.motion = false;
  in.largest_start_error_m = 0.04;
  in.levels = 2;
  track.aligned = align(in, scratch_);
  const Pose D = track.aligned.T_camera_object * T_camera_object.inverse();
  track.agreement = compare(track.view, frame_.camera, frame_.depth_z, D, track.aligned.depth);
  return fit_score(track.aligned, track.agreement);
}

void ObjectTracker::finish_search(const Unexplained& candidate, const Pose& T_camera_anchor) {
  const std::size_t k = search_.track;
  Track& track = tracks_[k];
  double best = 0;
  Pose best_pose;
  for (const Search::Found& found : search_.best) {
    if (found.score <= 0) continue;
    const double score = try_pose(track, k, T_camera_anchor * found.T_anchor_object);
    if (score <= best || judge(track.aligned, track.agreement) != Verdict::kGood) continue;
    best = score;
    best_pose = track.aligned.T_camera_object;
  }
  search_.running = false;
  if (best <= 0) {
    if (search_.in_place) return;                  // it may still come out from behind what holds it
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

// Looks for a lost object in something unexplained: of its size, unless that pair was tried already, or
// larger and where it was last.
bool ObjectTracker::start_search_of(std::size_t k, const Unexplained& what) {
  const Track& track = tracks_[k];
  if (what.pixels < kLeastNewcomer_px) return false;
  const Newcomer* known = newcomer_at(what.box);
  const bool refused = known != nullptr && (known->refused_by >> k & 1u) != 0;
  if (!refused) {
    const std::size_t used = gather_points(frame_.depth_z, segmentation_->labels, what.label, what.box,
                                           frame_.camera, {}, points_of(k));
    if (used >= kLeastPoints &&
        size_fits(track.bounds, find_footprint(points_of(k).first(used), support_).bounds,
                  what.touches_border)) {
      search_.start(k, what, false);
      return true;
    }
  }
  const Rect box = image_box(track.bounds, track.T_last_good, frame_.camera, 0);
  if (track.lost_run > kInPlaceFrames || !overlap(box, what.box)) return false;
  search_.start(k, what, true);
  return true;
}

void ObjectTracker::start_search() {
  for (std::size_t k = 0; k < kMaxObjects; ++k) {
    if (tracks_[k].phase != Track::Phase::kLost) continue;
    for (const Unexplained& what : unexplained_)
      if (start_search_of(k, what)) return;
  }
}

const Unexplained* ObjectTracker::search_candidate() const {
  const Rect box = search_.in_place ? image_box(tracks_[search_.track].bounds,
                                                tracks_[search_.track].T_last_good, frame_.camera, 0)
                                    : search_.box;
  for (const Unexplained& what : unexplained_)
    if (overlap(what.box, box) && (search_.in_place || norm(what.centroid - search_.centroid) < 0.2f))
      return &what;
  return nullptr;
}

void ObjectTracker::search_step() {
  if (!search_.running) start_search();
  if (!search_.running) return;
  const std::size_t k = search_.track;
  const Unexplained* candidate = search_candidate();
  if (candidate == nullptr) {
    if (++search_.frames_without > kSearchPatience) search_.running = false;
    return;
  }
  search_.frames_without = 0;
  search_.box = candidate->box;
  search_.centroid = candidate->centroid;
  Track& track = tracks_[k];
  if (search_.in_place)
    claim_near(*candidate, k, track.T_last_good * track.bounds.centre(), 0.6 * norm(track.bounds.size()));
  else
    claim_pixels(*candidate, k);
  track.motion.rest();  // how it moves now is not known
  observe(track, k, candidate->box, true);
  if (track.points_used < kLeastPoints) return;
  const Footprint footprint = find_footprint(points_of(k).first(track.points_used), support_);
  const Pose anchor = search_.in_place ? track.T_last_good : footprint.T_camera_object;
  for (int i = 0; i < kYawsPerFrame && search_.next_yaw < kSearchYaws; ++i, ++search_.next_yaw) {
    const double yaw = 2.0 * kPi * search_.next_yaw / kSearchYaws;
    const double score = try_pose(track, k,
                                  search_.in_place ? turned_in_place(track, support_, yaw)
                                                   : hypothesis(track, footprint, support_, yaw));
    if (score > 0) search_.note(score, anchor.inverse() * track.aligned.T_camera_object);
  }
  if (search_.next_yaw == kSearchYaws) finish_search(*candidate, anchor);
}

}  // namespace st
