// Which known model an object is, at what pose, or none of them: coarse gate, 3-D SIFT matches, a fit of the
// silhouette and the distance field for every heading, and the best of all. In slices: advance() does so much
// work and no more, so the answer comes after a fixed number of frames.
#pragma once

#include "algo/recognition/appearance.hpp"
#include "algo/recognition/known_model.hpp"
#include "algo/recognition/match.hpp"
#include "algo/recognition/upright_fit.hpp"
#include "algo/recognition/volume_fit.hpp"

namespace st {

inline constexpr std::size_t kMaxKnownModels = 256;
inline constexpr double kSameHeading_rad = 0.35;

// Where a pose may come from: every heading is tried beside the matches; or the matches alone, as the paper
// has it.
enum class RecognitionWay : std::uint8_t { kMatchesAndHeadings, kMatchesAlone };

struct RecognitionSubject {
  const Volume* volume = nullptr;  // must stay as it is, or grow, until the answer
  Vec3f towards{};                 // horizontal unit vector to the camera, object frame
  bool cut = false;
};

struct Recognised {
  int model = -1;                 // -1: unknown
  VolumeFit fit;                  // T_model_seen and how well it fits
  Pose T_model_seen_matched;      // as the matches alone have it; where `agreeing` is not 0
  int matches = 0, agreeing = 0;  // 3-D SIFT
  float second_score = 0;         // of the best other model that is not the same thing, stored twice
  static constexpr int kOtherHeadings = 2;
  VolumeFit other_headings[kOtherHeadings];  // the best of this model turned by more than kSameHeading_rad
};

class Recognition {
 public:
  // One unit is about 0.1 ms on a slow PC.
  static constexpr int kUnitsPerFrame = 50;

  void bind(Bump& memory, int volume_side);

  // `skip[i]`: model i is somebody else already.
  void start(std::span<const KnownModel> models, const bool (&skip)[kMaxKnownModels],
             const RecognitionSubject& subject, RecognitionWay way);
  bool running() const { return stage_ != Stage::kIdle; }
  void stop() { stage_ = Stage::kIdle; }
  // True when the answer is there: best(), whose model stands in volume().
  bool advance(int units);

  const Recognised& best() const { return best_; }
  Volume& volume() { return volume_; }
  // Of the subject, and matches with the model that had most.
  int features() const { return static_cast<int>(sift_.features().features.size()); }
  int most_matches() const { return most_matches_; }

  // At once: the features of one volume, valid until the next use; and the motion that most matches of two
  // sets agree on, to within so many voxels of the appearance.
  FeatureSet describe(const Volume& volume);
  UprightFit match(const FeatureSet& a, const FeatureSet& b, float tolerance_voxels, int& matches);

 private:
  enum class Stage { kIdle, kSample, kAppearance, kFeatures, kMatch, kUnpack, kHeadings, kRefine, kAnswer };
  struct Candidate {
    int model = 0, matches = 0;
    UprightFit fit;
  };
  static constexpr int kMostVerified = 4, kHeadings = 24, kKept = 1 + Recognised::kOtherHeadings;

  int step();  // one slice; its cost in units
  int sample_subject();
  void look_at(const Volume& volume);
  void gate();
  int match_next();
  void rank();
  int unpack_next();
  int try_heading();
  int refine();
  void conclude();
  void note(const VolumeFit& fit);
  SeenSurface seen() const { return {seen_, fit_tolerance_m(subject_.volume->truncation_m)}; }
  const KnownModel& known(const Candidate& c) const { return models_[static_cast<std::size_t>(c.model)]; }
  Candidate& verified() { return candidates_[static_cast<std::size_t>(next_)]; }

  Stage stage_ = Stage::kIdle;
  RecognitionWay way_ = RecognitionWay::kMatchesAndHeadings;
  RecognitionSubject subject_;
  ModelTraits traits_;  // of the subject
  std::span<const KnownModel> models_;
  Sift3d sift_;
  Matcher matcher_;
  Matches matches_;
  Volume volume_;
  std::span<SurfacePoint> seen_memory_, model_memory_;
  std::span<Vec3f> scratch_;
  std::span<const SurfacePoint> seen_, model_points_;
  FixedVector<Candidate, kMaxKnownModels> candidates_;
  int most_matches_ = 0;
  int next_ = 0;  // candidate, slab or heading that is next in this stage
  int heading_ = 0;
  bool matching_ = false;
  int unpacked_ = -1;  // the model in volume_
  VolumeFit kept_[kKept];
  Recognised best_;
};

// How sure an answer must be before it counts: a wrong one would spoil both models. The last two are found by
// check_patches().
enum class Doubt : std::uint8_t {
  kNone,
  kNoCandidate,  // none of the models has this size and hue, or none fits at all
  kShape,        // too much of what was seen lies off the best model's surface
  kPrint,        // it is printed otherwise
  kRival,        // another model fits as well
  kFrame,        // what is seen contradicts the model in places
  kHeading,      // it is this model, but which way round is open: turned it is not contradicted, either
};
Doubt doubt_of_model(const Recognised& r);  // kNone to kRival
inline bool is_sure_model(const Recognised& r) { return doubt_of_model(r) == Doubt::kNone; }

}  // namespace st
