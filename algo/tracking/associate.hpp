// Which pixels belong to which track. A segment that one track explains is that track's, growth included; one
// that several share, or that is much larger than the model (a hand took hold of it), is divided by distance
// to the models.
#pragma once

#include <span>

#include "algo/core/fixed_vector.hpp"
#include "algo/core/image.hpp"
#include "algo/segmentation/segmenter.hpp"
#include "algo/tracking/track.hpp"

namespace st {

// A segment, or the rest of one, that no track explains.
struct Unexplained {
  std::uint8_t label = 0;  // in the segment image
  Rect box;
  int pixels = 0;
  Vec3f centroid{};  // camera frame, metres
  bool touches_border = false;
  bool rest = false;  // what a divided segment left over
};
using UnexplainedList = FixedVector<Unexplained, 8>;

struct AssociationInput {
  ImageView<const std::uint8_t> labels;  // 0 none, i + 1: segments[i]
  std::span<const Segment> segments;
  ImageView<const float> depth_z;
  Pinhole camera;
};

// The pixels of one track.
struct Owned {
  Rect box = Rect::nothing();
  int pixels = 0;
  bool divided = false;  // something else hangs together with them

  void add(int u, int v) {
    box.include(u, v);
    ++pixels;
  }
};

// Owner of a foreground pixel that no track explains: it is no object's surface, and nothing behind an object
// either.
inline constexpr std::uint8_t kForeign = 255;

// Writes `owners`: 0 background, k + 1 for tracks[k], kForeign; owned[k] about the pixels of tracks[k]; and
// what is left. Every pixel of `owners` is set.
void associate(const AssociationInput& input, std::span<const Track> tracks, ImageView<std::uint8_t> owners,
               std::span<Owned> owned, UnexplainedList& unexplained);

}  // namespace st
