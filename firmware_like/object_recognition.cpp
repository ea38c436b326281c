// Known objects: a new track is compared with the models of earlier runs, a few slices in each frame. On a
// hit the stored model becomes the track's own (STAR, section 4.2).
#include <utility>

#include "firmware_like/model_library.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {
namespace {

// Good poses after which a track is looked up: at once, and again when more of it has been seen.
constexpr int kLookUps[] = {4, 30, 75, 150};
constexpr int kColorMargin_px = 14;
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
      if (&other != &track && other.phase != Track::Phase::kFree && other.named_model >= 0)
        taken[static_cast<std::size_t>(other.named_model)] = true;
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
  if (!recognition_.running() && !proof_.running) start_recognition();
  if (!recognition_.running() && !proof_.running) return;
  Track& track = tracks_[recognised_track_];
  if (track.id != recognised_id_ || track.phase != Track::Phase::kTracked) {
    recognition_.stop();
    proof_ = {};
    return;
  }
  // The answer is checked against frames in which the track itself is good.
  if (track.state != TrackState::kGood) return;
  if (proof_.running) {
    prove(track, recognition_.best());
  } else if (recognition_.advance(step.level == 0 ? Recognition::kUnitsPerFrame : kUnitsWhenLate)) {
    const Recognised& answer = recognition_.best();
    if (const Doubt doubt = doubt_of_model(answer); doubt != Doubt::kNone)
      settle(track, answer, doubt);
    else
      proof_ = {true, 0, answer.fit.T_model_seen.inverse(), {}, false};
  }
}

// One look in each frame, since the model has to be rendered for each: it must agree with what the frame
// shows, on the whole and everywhere; and turned to any other heading that fits, it must not.
void ObjectTracker::prove(Track& track, const Recognised& answer) {
  std::swap(track.volume, recognition_.volume());
  Pose T_camera_model = track.T_camera_object * proof_.T_object_model;
  Doubt doubt = Doubt::kNone;
  const int look = proof_.looks++;
  if (look == 0) {
    doubt = fit_to_frame(track, T_camera_model);
    proof_.T_object_model = track.T_camera_object.inverse() * T_camera_model;
  } else if (look == 1) {
    proof_.here = patches_at(track, T_camera_model);
    if (!proof_.here.agrees()) doubt = Doubt::kFrame;
  } else if (const VolumeFit& other = answer.other_headings[look - 2]; other.score() > 0) {
    const PatchCheck turned = patches_at(track, track.T_camera_object * other.T_model_seen.inverse());
    proof_.heading_open = proof_.heading_open || !proof_.here.refutes(turned);
  }
  const bool last = proof_.looks == 2 + Recognised::kOtherHeadings;
  if (last && proof_.heading_open) doubt = Doubt::kHeading;
  if (last && doubt == Doubt::kNone) {
    adopt_model(track, answer.model, T_camera_model);
  } else {
    std::swap(track.volume, recognition_.volume());
  }
  render_one(track, track.T_camera_object);
  if (last || doubt != Doubt::kNone) settle(track, answer, doubt);
}

// What the answer comes to.
void ObjectTracker::settle(Track& track, const Recognised& answer, Doubt doubt) {
  proof_ = {};
  const bool recognised = doubt == Doubt::kNone || doubt == Doubt::kHeading;
  if (recognised && track.named_model == answer.model && doubt == Doubt::kHeading) return;  // said already
  // Seen from more sides it may turn out to be another thing, after all.
  const bool refuted = !recognised && doubt != Doubt::kRival;
  if (recognised || refuted) {
    track.named_model = recognised ? answer.model : -1;
    if (ObjectCount* count = count_of(track.id)) count->named_model = track.named_model;
  }
  log(recognised ? EventKind::kRecognised : EventKind::kUnknownObject, track.id,
      static_cast<double>(answer.fit.score()), answer.agreeing, static_cast<double>(doubt));
}

// The model, which stands in the track's volume, rendered at the pose and held against the frame.
PatchCheck ObjectTracker::patches_at(Track& track, const Pose& T_camera_model) {
  const auto k = static_cast<std::size_t>(&track - tracks_);
  render_one(track, T_camera_model);
  PatchInput in;
  in.view = &track.view;
  in.camera = frame_.camera;
  in.depth_z = frame_.depth_z;
  in.owners = frame_.owners;
  in.owner = static_cast<std::uint8_t>(k + 1);
  in.color = register_colors(
      k, track.view.maps.roi.grown(kColorMargin_px).clipped(frame_.depth_z.width, frame_.depth_z.height));
  in.skirt_z_m = appearance_of(library_->models()[static_cast<std::size_t>(recognition_.best().model)].traits)
                     .least_top_m;
  return check_patches(in);
}

// Moves the pose of the model, which stands in the track's volume, onto the frame.
Doubt ObjectTracker::fit_to_frame(Track& track, Pose& T_camera_model) {
  constexpr float kLeastExplained = 0.75f, kMostLookedThrough = 0.15f;
  render_one(track, T_camera_model);
  AlignInput in = alignment_of(track, static_cast<std::size_t>(&track - tracks_));
  in.start = T_camera_model;
  in.pivot = T_camera_model.t;
  in.prior = {T_camera_model, {}};
  in.terms.motion = false;
  in.largest_start_error_m = 0.03;
  const AlignResult aligned = align(in, scratch_);
  const Pose D = aligned.T_camera_object * T_camera_model.inverse();
  const Agreement agreement = compare(track.view, frame_.camera, frame_.depth_z, D, aligned.depth);
  if (judge(aligned, agreement) != Verdict::kGood || agreement.explained < kLeastExplained ||
      agreement.through > kMostLookedThrough * (agreement.same + agreement.through))
    return Doubt::kFrame;
  T_camera_model = aligned.T_camera_object;
  return Doubt::kNone;
}

// The stored model, which stands in the track's volume, takes the track over.
void ObjectTracker::adopt_model(Track& track, int known_model, const Pose& T_camera_model) {
  const KnownModel& model = library_->models()[static_cast<std::size_t>(known_model)];
  track.T_model_object = T_camera_model.inverse() * track.T_camera_object;
  const Pose T_object_model = track.T_model_object.inverse();
  Bounds bounds;  // what the track has seen, and the model
  for (int i = 0; i < 8; ++i)
    bounds.include(track.T_model_object * Vec3{(i & 1) != 0 ? track.bounds.high.x : track.bounds.low.x,
                                               (i & 2) != 0 ? track.bounds.high.y : track.bounds.low.y,
                                               (i & 4) != 0 ? track.bounds.high.z : track.bounds.low.z});
  track.known_model = known_model;
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
    count->known_model = known_model;
    count->T_model_object = track.T_model_object;
  }
}

}  // namespace st
