// The paper's first tracker (section 3.3): every frame on its own is recognised against the database, and its
// pose comes from the matches of 3-D SIFT; or (section 4.1) the matches are those with the frame before. It
// is the baseline that STAR is measured against: nothing is predicted, smoothed or kept from frame to frame.
#include "firmware_like/model_library.hpp"
#include "firmware_like/object_tracker.hpp"

namespace st {

bool ObjectTracker::tracks_by_matches() const { return st::tracks_by_matches(config_.tracker); }

void ObjectTracker::bind_seen_features(Bump& memory) {
  for (SeenFeatures& seen : seen_features_) {
    seen.features = memory.take<Feature>(kMaxFeatures);
    seen.descriptors = memory.take<Descriptor>(kMaxFeatures);
  }
}

// The segment of this frame, alone, as a volume about its footprint; the track's own frame is that of the
// footprint, anew in each frame.
void ObjectTracker::align_by_matches(Track& track, std::size_t k) {
  observe(track, k, owned_[k].box);
  track.aligned = AlignResult{};
  track.matched = false;
  if (track.points_used < kLeastPoints) return;
  const Footprint footprint = find_footprint(points_of(k).first(track.points_used), support_);
  const Vec3f middle = to_float(footprint.bounds.centre());
  track.volume.reset(track.volume.voxel_m, track.volume.truncation_m, middle);
  track.bounds = footprint.bounds;
  track.aligned.T_camera_object = track.T_camera_object = footprint.T_camera_object;
  constexpr double kPlaceSigma_m = 0.02, kTurnSigma_rad = 0.05;
  for (int i = 0; i < 6; ++i) {
    const double sigma = i < 3 ? kPlaceSigma_m : kTurnSigma_rad;
    track.aligned.covariance[7 * i] = sigma * sigma;
  }
  fuse(track, k);
  track.aligned.solved = true;
  ++match_counts_.frames;
  track.matched =
      config_.tracker == TrackerKind::kRecognition ? match_database(track) : match_frame_before(track, k);
  match_counts_.found += track.matched ? 1 : 0;
}

bool ObjectTracker::match_database(Track& track) {
  constexpr float kLeastExplained = 0.6f;
  constexpr bool kNone[kMaxKnownModels]{};
  RecognitionSubject subject;
  subject.volume = &track.volume;
  subject.cut = track.cut();
  recognition_.start(library_->models(), kNone, subject, RecognitionWay::kMatchesAlone);
  while (!recognition_.advance(Recognition::kUnitsPerFrame)) {
  }
  const Recognised& best = recognition_.best();
  if (recognition_.features() < kLeastMatches)
    ++match_counts_.no_keypoints;
  else if (recognition_.most_matches() < kLeastMatches)
    ++match_counts_.no_matches;
  else if (best.model < 0)
    ++match_counts_.no_agreement;
  else if (best.fit.explained < kLeastExplained)
    ++match_counts_.not_verified;
  if (best.model < 0 || best.fit.explained < kLeastExplained) return false;
  track.T_model_object = best.T_model_seen_matched.inverse();
  if (ObjectCount* count = count_of(track.id)) count->known_model = best.model;
  return true;
}

// The motion since the last frame that was matched; where that fails the pose is not given out.
bool ObjectTracker::match_frame_before(Track& track, std::size_t k) {
  constexpr float kToleranceVoxels = 2.5f;
  SeenFeatures& before = seen_features_[k];
  const FeatureSet now = recognition_.describe(track.volume);
  const FeatureSet then{before.features.first(before.used), before.descriptors.first(before.used)};
  const bool first = track.good_poses == 0 || before.used == 0;
  UprightFit fit;
  int matches = 0;
  if (!first) fit = recognition_.match(now, then, kToleranceVoxels, matches);
  if (!first && !fit.found) {
    if (now.features.size() < kLeastMatches)
      ++match_counts_.no_keypoints;
    else if (matches < kLeastMatches)
      ++match_counts_.no_matches;
    else
      ++match_counts_.no_agreement;
  }
  if (!first && !fit.found) return false;
  before.used = now.features.size();
  for (std::size_t i = 0; i < before.used; ++i) {
    before.features[i] = now.features[i];
    before.descriptors[i] = now.descriptors[i];
  }
  track.T_model_object = first ? Pose{} : fit.T_b_a.inverse() * track.T_model_object;
  return true;
}

// There is nothing to judge: the matches agree, or there is no pose.
void ObjectTracker::judge_matches(Track& track) {
  const bool there = track.aligned.solved;
  track.verdict = track.matched ? Verdict::kGood : Verdict::kLost;
  track.state = track.matched ? TrackState::kGood : TrackState::kLost;
  track.poor_run = there ? 0 : track.poor_run + 1;
  if (!there) return;
  track.motion.correct(track.aligned.T_camera_object, track.aligned.covariance);
  track.has_moved = track.has_moved || norm(track.T_camera_object.t - track.T_birth.t) > 0.03;
  if (!track.matched) return;
  ++track.good_poses;
  track.last_good_t_s = frame_.input->t_s;
  track.T_last_good = track.T_camera_object;
}

}  // namespace st
