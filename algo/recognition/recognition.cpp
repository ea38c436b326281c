#include "algo/recognition/recognition.hpp"

#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st {
namespace {

constexpr int kSlabs = 8;  // of the appearance that one slice fills
constexpr int kTryIterations = 8, kTryStride = 4, kRefineIterations = 12;
constexpr double kTryTurn_rad = 0.052, kRefineTurn_rad = 0.02;  // between turns by which the print is tried
constexpr int kTryTurns = 2, kRefineTurns = 4;                  // to either side
constexpr int kRows = 16;                                       // of a match that one slice does
constexpr float kMatchTolerance = 2.5f;                         // voxels of the appearance

bool same_heading(const VolumeFit& a, const VolumeFit& b) {
  return rotation_angle(a.T_model_seen.R * b.T_model_seen.R.transposed()) < kSameHeading_rad;
}

}  // namespace

void Recognition::bind(Bump& memory, int volume_side) {
  sift_.bind(memory, kAppearanceSide);
  matcher_.bind(memory);
  volume_.bind(memory, volume_side);
  seen_memory_ = memory.take<SurfacePoint>(kFitPoints);
  model_memory_ = memory.take<SurfacePoint>(kFitPoints);
  scratch_ = memory.take<Vec3f>(kFitPoints);
}

void Recognition::start(std::span<const KnownModel> models, const bool (&skip)[kMaxKnownModels],
                        const RecognitionSubject& subject, RecognitionWay way) {
  models_ = models;
  subject_ = subject;
  way_ = way;
  best_ = {};
  most_matches_ = 0;
  candidates_.clear();
  for (std::size_t i = 0; i < models.size() && i < kMaxKnownModels; ++i)
    if (!skip[i]) candidates_.push_back({static_cast<int>(i), 0, {}});
  unpacked_ = -1;
  stage_ = Stage::kSample;
}

bool Recognition::advance(int units) {
  while (units > 0 && running()) {
    units -= step();
    if (stage_ != Stage::kAnswer) continue;
    stage_ = Stage::kIdle;
    return true;
  }
  return false;
}

int Recognition::step() {
  switch (stage_) {
    case Stage::kSample:
      return sample_subject();
    case Stage::kAppearance:
      fill_appearance(*subject_.volume, appearance_of(traits_), sift_.input(), next_, next_ + kSlabs);
      next_ += kSlabs;
      if (next_ < kAppearanceSide) return 4;
      sift_.start(kLookUpKeypoints);
      stage_ = Stage::kFeatures;
      return 4;
    case Stage::kFeatures: {
      const Sift3d::Stage doing = sift_.stage();
      if (sift_.step()) {
        stage_ = Stage::kMatch;
        next_ = 0;
        matching_ = false;
      }
      return doing == Sift3d::Stage::kBlur ? 2 : doing == Sift3d::Stage::kExtrema ? 7 : 6;
    }
    case Stage::kMatch:
      return match_next();
    case Stage::kUnpack:
      return unpack_next();
    case Stage::kHeadings:
      return try_heading();
    case Stage::kRefine:
      return refine();
    default:
      return 1;
  }
}

// Samples the volume's surface, and places the appearance about it.
void Recognition::look_at(const Volume& volume) {
  const SampledSurface sampled = sample_surface(volume, seen_memory_, scratch_);
  seen_ = seen_memory_.first(sampled.points);
  traits_ = {};
  traits_.color = color_stats(volume);
  traits_.bounds = sampled.bounds;
  place_appearance(sift_.input(), traits_.bounds);
}

FeatureSet Recognition::describe(const Volume& volume) {
  look_at(volume);
  if (seen_.empty()) return {};
  fill_appearance(volume, appearance_of(traits_), sift_.input(), 0, kAppearanceSide);
  sift_.start(kObjectKeypoints);
  while (!sift_.step()) {
  }
  return sift_.features();
}

UprightFit Recognition::match(const FeatureSet& a, const FeatureSet& b, float tolerance_voxels,
                              int& matches) {
  matcher_.start(a, b);
  while (!matcher_.step()) {
  }
  matcher_.finish(kMatchRatio, matches_);
  matches = static_cast<int>(matches_.size());
  return fit_upright(a, b, matches_, tolerance_voxels * sift_.input().voxel_m);
}

int Recognition::sample_subject() {
  look_at(*subject_.volume);
  gate();
  next_ = 0;
  stage_ = candidates_.empty() || seen_.size() < 50 ? Stage::kAnswer : Stage::kAppearance;
  return 10;
}

// Leaves those that the object may be.
void Recognition::gate() {
  for (std::size_t i = candidates_.size(); i-- > 0;)
    if (!may_be(known(candidates_[i]).traits, traits_, subject_.cut)) candidates_.erase(i);
}

int Recognition::match_next() {
  if (next_ == static_cast<int>(candidates_.size())) {
    rank();
    return 1;
  }
  Candidate& candidate = verified();
  const KnownModel& model = known(candidate);
  if (!matching_) {
    matching_ = true;
    matcher_.start(sift_.features(), model.features);
  }
  for (int i = 0; i < kRows; ++i) {
    if (!matcher_.step()) continue;
    matcher_.finish(kMatchRatio, matches_);
    candidate.matches = static_cast<int>(matches_.size());
    if (candidate.matches > most_matches_) most_matches_ = candidate.matches;
    candidate.fit =
        fit_upright(sift_.features(), model.features, matches_, kMatchTolerance * sift_.input().voxel_m);
    matching_ = false;
    ++next_;
    break;
  }
  return 2;
}

// Those on which more matches agree come first; of the others those of the most similar size.
void Recognition::rank() {
  const auto unlike = [&](const Candidate& c) {
    return norm(known(c).traits.bounds.size() - traits_.bounds.size());
  };
  const auto before = [&](const Candidate& a, const Candidate& b) {
    if (a.fit.inliers != b.fit.inliers) return a.fit.inliers > b.fit.inliers;
    return unlike(a) < unlike(b);
  };
  for (std::size_t i = 1; i < candidates_.size(); ++i)
    for (std::size_t k = i; k > 0 && before(candidates_[k], candidates_[k - 1]); --k) {
      const Candidate swapped = candidates_[k];
      candidates_[k] = candidates_[k - 1];
      candidates_[k - 1] = swapped;
    }
  while (candidates_.size() > kMostVerified) candidates_.pop_back();
  next_ = 0;
  stage_ = Stage::kUnpack;
}

// The next model to verify, or, after the last, the best one once more: its volume is part of the answer.
int Recognition::unpack_next() {
  if (next_ == static_cast<int>(candidates_.size())) {
    if (best_.model >= 0 && unpacked_ != best_.model)
      unpack(models_[static_cast<std::size_t>(best_.model)].volume, volume_);
    stage_ = Stage::kAnswer;
    return 5;
  }
  const Candidate& candidate = verified();
  unpacked_ = candidate.model;
  if (!unpack(known(candidate).volume, volume_)) {
    ++next_;
    return 5;
  }
  model_points_ = model_memory_.first(sample_surface(volume_, model_memory_, scratch_).points);
  for (VolumeFit& kept : kept_) kept = {};
  heading_ = 0;
  stage_ = Stage::kHeadings;
  return 10;
}

// Keeps the best, each of another heading.
void Recognition::note(const VolumeFit& fit) {
  int worst = 0;
  for (int i = 0; i < kKept; ++i) {
    if (kept_[i].score() > 0 && same_heading(kept_[i], fit)) {
      if (fit.score() > kept_[i].score()) kept_[i] = fit;
      return;
    }
    if (kept_[i].score() < kept_[worst].score()) worst = i;
  }
  if (fit.score() > kept_[worst].score()) kept_[worst] = fit;
}

// The first try is what the matches say.
int Recognition::try_heading() {
  const Candidate& candidate = verified();
  const int tries = way_ == RecognitionWay::kMatchesAlone ? 1 : 1 + kHeadings;
  Pose start = candidate.fit.T_b_a;
  const bool has_start = heading_ == 0 ? candidate.fit.found
                                       : start_from_silhouette(model_points_, seen_, subject_.towards,
                                                               2 * kPi * (heading_ - 1) / kHeadings, start);
  if (has_start) {
    const VolumeFit fit = fit_to_volume(volume_, seen(), start, kTryIterations, kTryStride);
    note(turn_to_print(volume_, seen(), fit, kTryTurns, kTryTurn_rad, kTryStride));
  }
  if (++heading_ == tries) {
    heading_ = 0;
    stage_ = Stage::kRefine;
  }
  return 2;
}

int Recognition::refine() {
  VolumeFit& kept = kept_[heading_];
  if (kept.score() > 0) {
    kept = fit_to_volume(volume_, seen(), kept.T_model_seen, kRefineIterations);
    kept = turn_to_print(volume_, seen(), kept, kRefineTurns, kRefineTurn_rad);
  }
  if (++heading_ < kKept) return 11;
  conclude();
  ++next_;
  stage_ = Stage::kUnpack;
  return 11;
}

namespace {

constexpr float kExplained = 0.88f;  // least share of the surface, of a sure answer

// Two models that the subject fits well, print and all, are one thing that is stored twice: they do not count
// against each other.
bool is_twin(const VolumeFit& fit) {
  constexpr float kSamePrint = 0.85f;
  return fit.explained >= kExplained && fit.colored >= kLeastColoured && fit.likeness >= kSamePrint;
}

}  // namespace

// What this model came to, beside the others.
void Recognition::conclude() {
  const Candidate& candidate = verified();
  const VolumeFit* best = &kept_[0];
  for (const VolumeFit& fit : kept_)
    if (fit.score() > best->score()) best = &fit;
  const bool twins = is_twin(*best) && is_twin(best_.fit);
  if (best->score() <= best_.fit.score()) {
    if (!twins && best->score() > best_.second_score) best_.second_score = best->score();
    return;
  }
  const float second = twins ? best_.second_score : best_.fit.score();
  best_ = {candidate.model, *best, candidate.fit.T_b_a, candidate.matches, candidate.fit.inliers, second, {}};
  int others = 0;
  for (const VolumeFit& fit : kept_)
    if (&fit != best && fit.score() > 0 && !same_heading(fit, *best)) best_.other_headings[others++] = fit;
}

Doubt doubt_of_model(const Recognised& r) {
  constexpr float kLikeness = 0.75f, kAhead = 0.02f;
  // Both stand on the floor: of another size, the surfaces meet only where one of them is lifted.
  constexpr double kMostLift_m = 0.007;
  if (r.model < 0) return Doubt::kNoCandidate;
  if (std::fabs(r.fit.T_model_seen.t.z) > kMostLift_m) return Doubt::kShape;
  if (r.fit.explained < kExplained) return Doubt::kShape;
  if (r.fit.colored >= kLeastColoured && r.fit.likeness < kLikeness) return Doubt::kPrint;
  return r.fit.score() > r.second_score + kAhead ? Doubt::kNone : Doubt::kRival;
}

}  // namespace st
