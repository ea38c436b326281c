// An object that was met before, as the recognition needs it, and how one is described.
#pragma once

#include "algo/recognition/appearance.hpp"
#include "algo/recognition/sift3d.hpp"
#include "algo/tracking/track.hpp"
#include "algo/volume/packed_volume.hpp"

namespace st {

// Colours of a surface. The shares do not change when the light does; the luminance does.
struct ColorStats {
  float luminance = 0, luminance_sigma = 0;  // 0-255
  float red_share = 0, green_share = 0;      // of r + g + b, mean
  std::uint32_t voxels = 0;                  // that have a colour

  bool known() const { return voxels > 200; }
};

// Over the volume's voxels within half a voxel of the surface, in bricks that are solid somewhere.
ColorStats color_stats(const Volume& volume);

// What a model is, apart from its volume and features.
struct ModelTraits {
  Bounds bounds;  // object frame
  ColorStats color;
  SeenSides sides;
  std::uint32_t integrated = 0;  // frames
};

// How 3-D SIFT looks at it, and which keypoints it keeps of it: robots have few details, so that the loose
// rules find a few dozen where the strict ones find three.
Appearance appearance_of(const ModelTraits& traits);
inline constexpr KeypointLimits kObjectKeypoints{Neighbours::kNearest8, 0.02f, 0.002f, 50};
// Of an object that is being looked up, in the loop's time.
inline constexpr KeypointLimits kLookUpKeypoints{Neighbours::kNearest8, 0.02f, 0.002f, 50, 80};

struct KnownModel {
  PackedVolume volume;
  FeatureSet features;
  ModelTraits traits;
};

// The coarse gate: could what was seen of `seen` be the model? By size, of which one view shows a part, and
// by the hue, which survives another light.
bool may_be(const ModelTraits& model, const ModelTraits& seen, bool cut);

}  // namespace st
