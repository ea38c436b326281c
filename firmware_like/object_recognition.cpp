// Known objects: a new track is compared with the models of earlier runs, a few slices in each frame. On a
// hit the stored model becomes the track's own (STAR, section 4.2).
#include <utility>

#include "firmware_like/model_library.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {
namespace {

// Good poses after which a track is looked up: at once, and again when more of it has been seen.
constexpr int kLookUps[] = {4, 45, 150};
constexpr int kUnitsWhenLate = Recognition::kUnitsPerFrame / 4;  // on every step of the ladder but the first

}  // namespace

void ObjectTracker::bind_recognition(Bump& memory) { recognition_.bind(memory, config_.volume_side); }

bool ObjectTracker::knows_models() const { return library_ != nullptr && !library_->empty(); }

bool ObjectTracker::wants_look_up(const Track& track) const {
  return track.phase == Track::Phase::kTracked && track.state == TrackState::kGood && track.known_model < 0 &&
         !track.cut() && track.look_ups < static_cast<int>(std::size(kLookUps)) &&
         track.good_poses >= kLookUps[track.look_ups];
}

void ObjectTracker::start_recognition() {
  for (std::size_t k = 0; k < kMaxObjects; ++k) {
    Track& track = tracks_[k];
    if (!wants_look_up(track)) continue;
    ++track.look_ups;
    bool taken[kMaxKnownModels]{};
    for (const Track& other : tracks_)
      if (other.phase != Track::Phase::kFree && other.known_model >= 0)
        taken[static_cast<std::size_t>(other.known_model)] = true;
    RecognitionSubject subject;
    subject.volume = &track.volume;
    const Vec3 camera = track.T_camera_object.inverse().t - track.bounds.centre();
    subject.towards = to_float(normalized(Vec3{camera.x, camera.y, 0}));
    subject.cut = track.cut();
    recognised_track_ = k;
    recognised_id_ = track.id;
    recognition_.start(library_->models(), taken, subject, config_.recognition);
    return;
  }
}

// After the search, which needs the same time and is more urgent.
void ObjectTracker::recognition_step(const LadderStep& step) {
  if (!knows_models() || search_.running || config_.tracker == TrackerKind::kFrameToFrame) return;
  if (!recognition_.running()) start_recognition();
  if (!recognition_.running()) return;
  Track& track = tracks_[recognised_track_];
  if (track.id != recognised_id_ || track.phase != Track::Phase::kTracked) {
    recognition_.stop();
    return;
  }
  // The answer is checked against a frame in which the track itself is good.
  const bool at_hand = track.state == TrackState::kGood;
  if (!at_hand || !recognition_.advance(step.level == 0 ? Recognition::kUnitsPerFrame : kUnitsWhenLate))
    return;
  const Recognised& answer = recognition_.best();
  // Where the last look-up finds all headings alike, it is the thing's own nature: round and plain.
  const bool last = track.look_ups == static_cast<int>(std::size(kLookUps));
  const bool heading = is_sure_heading(answer) || (last && has_no_heading(answer));
  if (is_sure_model(answer) && heading && adopt_model(track, answer))
    log(EventKind::kRecognised, track.id, static_cast<double>(answer.fit.score()), answer.agreeing);
  else
    log(EventKind::kUnknownObject, track.id, static_cast<double>(answer.fit.score()), answer.agreeing);
}

// The model, where the answer puts it, must agree with what this frame shows: also with what it does not
// show. Then it takes the track over; else everything stays as it was.
bool ObjectTracker::adopt_model(Track& track, const Recognised& answer) {
  constexpr float kLeastExplained = 0.75f, kMostLookedThrough = 0.15f;
  std::swap(track.volume, recognition_.volume());
  const Pose T_camera_model = track.T_camera_object * answer.fit.T_model_seen.inverse();
  render_one(track, T_camera_model);
  AlignInput in = alignment_of(track, recognised_track_);
  in.start = T_camera_model;
  in.pivot = T_camera_model.t;
  in.prior = {T_camera_model, {}};
  in.terms.motion = false;
  in.largest_start_error_m = 0.03;
  const AlignResult aligned = align(in, scratch_);
  const Pose D = aligned.T_camera_object * T_camera_model.inverse();
  const Agreement agreement = compare(track.view, frame_.camera, frame_.depth_z, D, aligned.depth);
  const bool agrees = judge(aligned, agreement) == Verdict::kGood && agreement.explained >= kLeastExplained &&
                      agreement.through <= kMostLookedThrough * (agreement.same + agreement.through);
  if (!agrees) {
    std::swap(track.volume, recognition_.volume());
    render_one(track, track.T_camera_object);
    return false;
  }
  const KnownModel& model = library_->models()[static_cast<std::size_t>(answer.model)];
  track.T_model_object = aligned.T_camera_object.inverse() * track.T_camera_object;
  const Pose T_object_model = track.T_model_object.inverse();
  Bounds bounds;  // what the track has seen, and the model
  for (int i = 0; i < 8; ++i)
    bounds.include(track.T_model_object * Vec3{(i & 1) != 0 ? track.bounds.low.x : track.bounds.high.x,
                                               (i & 2) != 0 ? track.bounds.low.y : track.bounds.high.y,
                                               (i & 4) != 0 ? track.bounds.low.z : track.bounds.high.z});
  track.known_model = answer.model;
  track.motion.rebase(T_object_model);
  track.T_camera_object = track.T_camera_object * T_object_model;
  track.T_last_good = track.T_last_good * T_object_model;
  track.T_birth = track.T_birth * T_object_model;
  bounds.include(model.traits.bounds.low);
  bounds.include(model.traits.bounds.high);
  track.bounds = bounds;
  track.sides = model.traits.sides;
  track.integrated = static_cast<int>(model.traits.integrated);
  track.drive.reset();
  track.habit = Habit{};
  if (ObjectCount* count = count_of(track.id)) {
    count->known_model = answer.model;
    count->T_model_object = track.T_model_object;
  }
  return true;
}

}  // namespace st
