// Finding lost objects again, a few tried poses in each frame: where something unexplained of their size has
// turned up; in place, where an arm that still holds them hides their size; and in a young candidate, begun
// when half of the object had come out from behind something.
#include "algo/core/scalar_math.hpp"
#include "algo/tracking/image_box.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {
namespace {

constexpr double kHeldTurn_rad = 0.002;
constexpr int kSearchPatience = 5;
constexpr int kInPlaceFrames = 90;  // for so long a lost object is expected where it was
constexpr int kRivalFrames = 90;    // good poses of a candidate that may yet turn out to be a lost object
constexpr int kMissedFrames = 600;  // for so long such a candidate has to wait for its number

}  // namespace

std::uint8_t ObjectTracker::searched_owner() const {
  return static_cast<std::uint8_t>((search_.where == Search::Where::kRival ? search_.rival : search_.track) +
                                   1);
}

// How well the pose fits once the alignment has moved it; `turn` says whether it may turn it, too. A first
// guess of the place is centimetres off, and what that does to the depth would turn it away from the right
// heading.
double ObjectTracker::try_pose(Track& track, const Pose& T_camera_object, bool turn) {
  render_one(track, T_camera_object);
  if (track.view_pixels < kLeastPoints) return 0;
  track.points_used = gather_near_view(frame_.depth_z, frame_.owners, searched_owner(), track.view,
                                       frame_.camera, points_of(search_.track));
  if (track.points_used < kLeastPoints) return 0;
  AlignInput in = alignment_of(track, search_.track);
  in.start = T_camera_object;
  in.pivot = T_camera_object.t;
  in.color_time = {Pose{}, {support_.R_camera_floor.transposed()}};
  if (search_.where == Search::Where::kRival)
    in.color_time.motion = tracks_[search_.rival].motion.motion_over(frame_.color_lag_s);
  in.terms.motion = !turn;
  in.terms.contour = false;
  in.prior = {T_camera_object, {}};
  for (int i = 3; i < 6; ++i) in.prior.information[7 * i] = 1 / (kHeldTurn_rad * kHeldTurn_rad);
  in.largest_start_error_m = 0.04;
  in.levels = turn ? 3 : 2;
  track.aligned = align(in, scratch_);
  const Pose D = track.aligned.T_camera_object * T_camera_object.inverse();
  track.agreement = compare(track.view, frame_.camera, frame_.depth_z, D, track.aligned.depth);
  // Of two that fit alike, a box and the same box the other way round, the one it was lately is likelier.
  const bool lately = track.lost_run < kInPlaceFrames;
  const double turned =
      rotation_angle(track.aligned.T_camera_object.R * track.T_last_good.R.transposed()) / kPi;
  return fit_score(track.aligned, track.agreement) * (lately ? 1 - 0.2 * turned : 1.0);
}

// Refines one of the best tries, rendered anew after each pass: the first views were centimetres off.
void ObjectTracker::refine(Search::Found& found, const Pose& T_camera_anchor) {
  constexpr int kPasses = 3;
  Track& track = tracks_[search_.track];
  const double tried = found.score;
  found.score = 0;
  if (!(tried > 0)) return;
  double score = 0;
  Pose pose = T_camera_anchor * found.T_anchor_object;
  for (int pass = 0; pass < kPasses; ++pass) {
    score = try_pose(track, pose, true);
    if (!(score > 0)) return;
    pose = track.aligned.T_camera_object;
  }
  // Half of it has to be in sight: a corner of a robot looks like any corner.
  const Rect box = image_box(track.bounds, pose, frame_.camera, 0);
  if (share_inside(box, frame_.camera.width, frame_.camera.height) < 0.55 || track.agreement.same < 0.45f)
    return;
  // In place it was nearly there a moment ago; elsewhere it has to be the object beyond doubt.
  const bool found_again = search_.where == Search::Where::kInPlace
                               ? judge(track.aligned, track.agreement, track.habit) == Verdict::kGood
                               : is_found(track.aligned, track.agreement, track.habit);
  if (!found_again) return;
  found = {score, T_camera_anchor.inverse() * pose};
}

// The object is back when one of the refined tries is beyond doubt.
void ObjectTracker::finish_search(const Pose& T_camera_anchor) {
  Track& track = tracks_[search_.track];
  search_.running = false;
  const Search::Found& best = search_.best_of_all();
  if (!(best.score > 0)) {
    if (search_.where == Search::Where::kSegment) refuse(search_.box, search_.track);
    return;  // else it may still come out from behind what hides it
  }
  previous_[search_.track].surface_pixels = 0;  // the frame before has long been another
  log(EventKind::kRecovered, track.id, frame_.input->t_s - track.last_good_t_s);
  track.phase = Track::Phase::kTracked;
  track.left_view = false;
  track.poor_run = 0;
  track.state = TrackState::kPoor;
  track.T_camera_object = T_camera_anchor * best.T_anchor_object;
  track.motion.start(track.T_camera_object, support_.R_camera_floor.transposed(), frame_.input->device_t_s);
  track.motion.start_found({}, {});
  if (search_.where != Search::Where::kRival) return;
  const Track& rival = tracks_[search_.rival];
  track.motion.start_found(rival.motion.velocity_mps(), rival.motion.angular_velocity_rps());
  evict(tracks_[search_.rival]);
}

// The segment is somebody else.
void ObjectTracker::refuse(const Rect& box, std::size_t k) {
  Newcomer* known = newcomer_at(box);
  if (known == nullptr)
    newcomers_.push_back({box, 1, static_cast<std::uint8_t>(1u << k), true});
  else
    known->refused_by = static_cast<std::uint8_t>(known->refused_by | 1u << k);
}

// Something unexplained of the object's size, unless that pair was tried already; or larger, where it was
// last.
bool ObjectTracker::start_search_in(const Unexplained& what, std::size_t k) {
  const Track& track = tracks_[k];
  if (what.pixels < kLeastNewcomer_px) return false;
  const Newcomer* known = newcomer_at(what.box);
  const bool refused = known != nullptr && (known->refused_by >> k & 1u) != 0;
  if (!refused) {
    const std::size_t used = gather_points(frame_.depth_z, segmentation_->labels, what.label, what.box,
                                           frame_.camera, points_of(k));
    if (used >= kLeastPoints &&
        size_fits(track.bounds, find_footprint(points_of(k).first(used), support_).bounds,
                  what.touches_border)) {
      search_.start(k, what, Search::Where::kSegment);
      return true;
    }
  }
  const Rect box = image_box(track.bounds, track.T_last_good, frame_.camera, 0);
  if (track.cut() || track.lost_run > kInPlaceFrames || !overlap(box, what.box)) return false;
  search_.start(k, what, Search::Where::kInPlace);
  return true;
}

// Whether a candidate may be a lost object, of which only a part had come into sight when it began.
bool ObjectTracker::may_be_lost_one(const Track& candidate, const Track& lost) const {
  return candidate.phase == Track::Phase::kCandidate && !candidate.from_background &&
         lost.phase == Track::Phase::kLost && !lost.cut() && lost.lost_run < kMissedFrames &&
         candidate.good_poses < kRivalFrames &&
         norm(candidate.bounds.size()) < 1.4 * norm(lost.bounds.size());
}

bool ObjectTracker::start_search_in_candidate(std::size_t j, std::size_t k) {
  if (!may_be_lost_one(tracks_[j], tracks_[k]) || tracks_[j].points_used < kLeastPoints) return false;
  const Footprint footprint = find_footprint(points_of(j).first(tracks_[j].points_used), support_);
  if (!size_fits(tracks_[k].bounds, footprint.bounds, tracks_[j].cut())) return false;
  search_.start(k, {}, Search::Where::kRival);
  search_.rival = j;
  return true;
}

// In turn: one that stays hidden must not keep the others from being looked for.
void ObjectTracker::start_search() {
  const std::size_t after = search_.track + 1;
  for (std::size_t i = 0; i < kMaxObjects; ++i) {
    const std::size_t k = (after + i) % kMaxObjects;
    if (tracks_[k].phase != Track::Phase::kLost) continue;
    for (std::size_t j = 0; j < kMaxObjects; ++j)
      if (start_search_in_candidate(j, k)) return;
    for (const Unexplained& what : unexplained_)
      if (start_search_in(what, k)) return;
  }
}

const Unexplained* ObjectTracker::searched_segment() const {
  const Track& track = tracks_[search_.track];
  const bool in_place = search_.where == Search::Where::kInPlace;
  const Rect box = in_place ? image_box(track.bounds, track.T_last_good, frame_.camera, 0) : search_.box;
  for (const Unexplained& what : unexplained_)
    if (overlap(what.box, box) && (in_place || norm(what.centroid - search_.centroid) < 0.2f)) return &what;
  return nullptr;
}

// The pixels to search in this frame become the searched object's; how many points they are. Those of a rival
// are its own already.
std::size_t ObjectTracker::claim_searched() {
  const std::size_t k = search_.track;
  Track& track = tracks_[k];
  if (search_.where == Search::Where::kRival) {
    const Track& rival = tracks_[search_.rival];
    search_.running = rival.phase == Track::Phase::kCandidate;
    for (std::size_t i = 0; search_.running && i < rival.points_used; ++i)
      points_of(k)[i] = points_of(search_.rival)[i];
    return search_.running ? rival.points_used : 0;
  }
  const Unexplained* segment = searched_segment();
  if (segment == nullptr) {
    search_.running = ++search_.frames_without <= kSearchPatience;
    return 0;
  }
  search_.frames_without = 0;
  search_.box = segment->box;
  search_.centroid = segment->centroid;
  if (search_.where == Search::Where::kInPlace)
    claim_near(*segment, k, track.T_last_good * track.bounds.centre(), 0.6 * norm(track.bounds.size()));
  else
    claim_pixels(*segment, k);
  track.motion.rest();  // how it moves now is not known
  observe(track, k, segment->box);
  return track.points_used;
}

// What the tried poses are relative to. A candidate is tracked, so that its turn while the search goes on is
// known.
Pose ObjectTracker::search_anchor(const Footprint& footprint) const {
  switch (search_.where) {
    case Search::Where::kInPlace:
      return tracks_[search_.track].T_last_good;
    case Search::Where::kRival:
      return tracks_[search_.rival].T_camera_object;
    default:
      return footprint.T_camera_object;
  }
}

void ObjectTracker::search_step(const LadderStep& step) {
  if (!search_.running) start_search();
  if (!search_.running) return;
  const std::size_t used = claim_searched();
  if (used < kLeastPoints) return;
  Track& track = tracks_[search_.track];
  const Footprint footprint = find_footprint(points_of(search_.track).first(used), support_);
  const Pose anchor = search_anchor(footprint);
  const Rect box = search_.where == Search::Where::kRival ? owned_[search_.rival].box : search_.box;
  look_at_colors(box.grown(frame_.depth_z.width / 8).clipped(frame_.depth_z.width, frame_.depth_z.height),
                 step);
  if (search_.next_yaw == kSearchYaws) {
    Search::Found& tried = search_.best[search_.refined++];
    refine(tried, anchor);
    // One that the colours confirm needs no comparison; shape alone may fit two ways.
    const bool confirmed =
        tried.score > 0 && track.habit.knows_color() && track.aligned.color.used > kLeastColored;
    for (int i = search_.refined; confirmed && i < Search::kKept; ++i) search_.best[i].score = 0;
    if (confirmed || search_.refined == Search::kKept) finish_search(anchor);
    return;
  }
  const bool in_place = search_.where == Search::Where::kInPlace;
  const HiddenSide hidden =
      hidden_side(frame_.depth_z, frame_.owners, searched_owner(), box, segmentation_->view);
  for (int i = 0; i < step.search_tries && search_.next_yaw < kSearchYaws; ++i, ++search_.next_yaw) {
    const double yaw = 2.0 * kPi * search_.next_yaw / kSearchYaws;
    const Pose start = in_place ? turned_in_place(track, support_, yaw)
                                : hypothesis(track, footprint, support_, yaw, hidden);
    const double score = try_pose(track, start, false);
    if (score > 0) search_.note(score, anchor.inverse() * track.aligned.T_camera_object);
  }
}

}  // namespace st
