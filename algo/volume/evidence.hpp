// What each pixel of a frame says about the volume: where the surface is, which way it faces, how much to
// believe it, and whether the air before it is known to be empty. Computed once per frame and object for the
// pixels of a rectangle; the voxels then only look it up.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/image.hpp"
#include "algo/core/pinhole.hpp"
#include "algo/core/pose.hpp"

namespace st {

struct NoiseWeights {
  bool noise_aware = true;  // false: every sample counts the same (for comparison)
  float sigma_floor_m =
      0.0007f;  // sigma_z = floor + quadratic * z^2 (Khoshelham & Elberink 2012, as structured light does)
  float sigma_quadratic = 0.001425f;
  float nominal_m = 1.5f;  // distance at which a head-on sample has weight 1
};
constexpr float sigma_z_m(const NoiseWeights& noise, float z_m) {
  return noise.sigma_floor_m + noise.sigma_quadratic * z_m * z_m;
}

struct EvidenceInput {
  Pinhole camera;
  Rect roi;                        // the pixels to use
  ImageView<const float> depth_m;  // full frame, 0: no reading
  ImageView<const std::uint8_t>
      owners;                   // full frame; empty: every reading is the model's surface (scan mode)
  std::uint8_t object = 1;      // this value in `owners`: surface of this object
  std::uint8_t background = 0;  // this value: surface behind it, so that the way there is empty
                                // any other value says nothing (something may stand before the object)
  ImageView<const std::uint32_t>
      color;  // full frame in the depth camera's pixels, pack_rgb(r, g, b, valid ? 255 : 0); may be empty
};

// Pixel record: normal x and y (camera frame, signed 10 bits each, 511 = 1), weight in sixteenths (8 bits),
// then flags.
enum EvidenceBit : std::uint32_t {
  kEvidenceColor = 1u << 28,    // colour may be used: no depth edge near, not grazing
  kEvidenceSurface = 1u << 29,  // a surface sample of this object
  kEvidenceFree = 1u << 30,     // the ray before it is empty
};
inline constexpr float kEvidenceNormalScale = 511.0f;
inline constexpr float kEvidenceWeightUnits = 16.0f;

// Depth ranges of a block of pixels, metres. Empty blocks: nearest > farthest.
struct DepthCell {
  float nearest = 1e9f, farthest = 0;  // surface samples
  float empty_to = 0;                  // farthest pixel that empties the way to it
};

struct Evidence {
  static constexpr int kCell = 8;    // pixels a side of a finest cell
  static constexpr int kLevels = 8;  // each level halves the cells: the last is one cell up to 1024 pixels
  static constexpr int kReach = 8;   // pixels around one that are looked at
  static constexpr int kPad = 16;

  void bind(Bump& memory, int max_width, int max_height);

  // Evaluates a frame. `T_camera_object` and the box serve the counts below only.
  void evaluate(const EvidenceInput& input, const NoiseWeights& noise, const Pose& T_camera_object,
                const Vec3f& box_low, const Vec3f& box_high);

  // What the pixels of `rect` (relative to roi) may mean for voxels at depths [near, far] that a sample
  // changes from `reach` metres away: never too little. `range`: the depths where something can change, empty
  // when nothing can.
  struct Answer {
    bool surface = false, empties = false;
    float near_m = 1e9f, far_m = 0;
  };
  Answer ask(const Rect& rect, float near_m, float far_m, float reach_m) const;
  // The same for all pixels together: a cheap first question.
  const DepthCell& everything() const { return cells_[levels_[kLevels - 1].first]; }

  Rect roi;            // clipped to the image
  int stride = 0;      // of z and meta, elements
  std::span<float> z;  // metres, 0: says nothing
  std::span<std::uint32_t> meta;
  // Counts of the last frame.
  int surface_pixels = 0;  // samples of the object that are used
  int refused_pixels = 0;  // pixels of the object on depth edges or at grazing angles
  int outside_pixels = 0;  // used samples that lie outside of the box
  Vec3f low{}, high{};     // extent of the used samples in the object frame; low > high when there are none

 private:
  struct Level {
    int width = 0, height = 0;
    std::size_t first = 0;
  };
  void copy_padded(const EvidenceInput& input);
  void fill_cells();

  std::span<float> padded_;
  int padded_stride_ = 0;
  std::span<DepthCell> cells_;
  Level levels_[kLevels];
};

}  // namespace st
