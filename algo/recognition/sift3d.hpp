// 3-D SIFT of a volume, from scale space to descriptors, in slices: each step is bounded by a count, so that
// it runs beside the tracking without one late frame.
#pragma once

#include "algo/recognition/descriptor.hpp"
#include "algo/recognition/keypoints.hpp"
#include "algo/recognition/orientation.hpp"

namespace st {

inline constexpr std::size_t kMaxFeatures = 200;

// A keypoint in one of its frames.
struct Feature {
  Vec3f p_m{};        // object frame
  float sigma_m = 0;  // its scale
  Mat3f R{};          // p_object = R p_keypoint + p_m
  int keypoint = 0;   // features of one keypoint in several frames share it
};

// What is known of a thing by its features, stored or just seen.
struct FeatureSet {
  std::span<const Feature> features;
  std::span<const Descriptor> descriptors;
};

class Sift3d {
 public:
  enum class Stage { kIdle, kBlur, kExtrema, kDescribe, kDone };

  // side: of the volumes, 32 to 256, a power of two.
  void bind(Bump& memory, int side);
  // The volume to fill before start().
  const Grid& input() const { return input_; }
  Grid& input() { return input_; }

  void start(const KeypointLimits& limits = {});
  // One slice: a third of a level's blur, a level's extrema, or a keypoint's frames and descriptors. True
  // when it was the last.
  bool step();
  Stage stage() const { return stage_; }

  // Valid once done, until the next start().
  FeatureSet features() const { return {features_.first(used_), descriptors_.first(used_)}; }
  const Keypoints& keypoints() const { return keypoints_; }
  const KeypointCounts& counts() const { return counts_; }
  const ScaleSpace& scale_space() const { return space_; }

 private:
  void describe_next();
  std::size_t keypoints_to_describe() const;

  Grid input_;
  ScaleSpace space_;
  KeypointLimits limits_;
  Keypoints keypoints_;
  KeypointCounts counts_;
  std::span<Feature> features_;
  std::span<Descriptor> descriptors_;
  std::span<float> histogram_;
  std::size_t used_ = 0, next_keypoint_ = 0;
  Stage stage_ = Stage::kIdle;
  int octave_ = 0, level_ = 0, axis_ = 0;
};

}  // namespace st
