// The model as a camera would see it: depth, normal, colour and weight per pixel, by marching rays to the
// zero crossing (KinectFusion, Newcombe et al. 2011, section 3.4) between the depths that the solid bricks in
// the way allow (InfiniTAM, Kaehler et al. 2015).
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/image.hpp"
#include "algo/core/pinhole.hpp"
#include "algo/core/pose.hpp"
#include "algo/volume/volume.hpp"

namespace st {

// Images of the rectangle `roi` of the camera; pixel (u, v) of the camera stands at at(u, v). Rows are
// padded.
struct ModelMaps {
  Rect roi;
  int stride = 0;
  std::span<float> z;  // camera frame, metres; 0: no surface
  std::span<std::uint32_t>
      normal;  // camera frame: x and y in 16 bits each, 32767 = 1, z = -sqrt(1 - x^2 - y^2)
  std::span<std::uint32_t> color;  // pack_rgb; alpha 255: colour known, else 0
  std::span<std::uint8_t> weight;  // of the nearest voxel, halves of a nominal observation

  void bind(Bump& memory, int max_width, int max_height);
  bool contains(int u, int v) const { return u >= roi.u0 && v >= roi.v0 && u < roi.u1 && v < roi.v1; }
  std::size_t at(int u, int v) const {
    return static_cast<std::size_t>(v - roi.v0) * static_cast<std::size_t>(stride) +
           static_cast<std::size_t>(u - roi.u0);
  }
};

inline constexpr float kNormalScale = 32767.0f;
inline Vec3f unpack_normal(std::uint32_t n) {
  const float x = static_cast<float>(static_cast<std::int16_t>(n & 0xffffu)) / kNormalScale;
  const float y = static_cast<float>(static_cast<std::int16_t>(n >> 16)) / kNormalScale;
  const float rest = 1.0f - x * x - y * y;
  return {x, y, -std::sqrt(rest > 0 ? rest : 0.0f)};
}
constexpr float luminance_of(std::uint32_t c) {
  return 0.299f * static_cast<float>(red_of(c)) + 0.587f * static_cast<float>(green_of(c)) +
         0.114f * static_cast<float>(blue_of(c));
}

struct RaycastScratch {
  std::span<float> nearest, farthest;  // per tile
  std::span<float> depth;              // the image with a margin of nothing around it
  void bind(Bump& memory, int max_width, int max_height);
};

struct RaycastOptions {
  bool with_color = true;
  // Normals over a wider span where the surface was seen in few frames only. A sensor's noise stands still in
  // its image; in a young model it makes slopes of its own, which tell an alignment that nothing has moved.
  bool smooth_young = false;
  // Depth where each pixel's surface is guessed to be, whole image; may be empty. Rays then look only within
  // kGuessReach truncations of it, and pixels without a guess stay empty: enough to align the frame that the
  // guesses are from, at a fraction of the march. Read eight at a time: the last row must be followed by 8
  // readable elements.
  ImageView<const float> guess = {};
};

inline constexpr float kGuessReach = 3.0f;

struct RaycastStats {
  int rays = 0;  // that had any solid brick in their way
  int hits = 0;
};

// Renders the pixels of `roi` (clipped to the camera's image). For a coarser view pass coarser(camera, step).
// Surfaces seen from behind, or next to unseen voxels, give no pixel. The result does not depend on the
// instruction set.
RaycastStats raycast(const Volume& volume, const Pinhole& camera, const Rect& roi,
                     const Pose& T_camera_object, RaycastScratch& scratch, ModelMaps& out,
                     const RaycastOptions& options = {});

// The pixels that the solid part of the volume can fall on, clipped to the image; empty when there are none.
Rect visible_rect(const Volume& volume, const Pinhole& camera, const Pose& T_camera_object);

}  // namespace st
