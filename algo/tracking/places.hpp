// Where a hand-held camera has been and what it saw there, small: to find back to one of these views once it
// is lost (keyframes by tiny images: Klein & Murray 2008; of depth, as Glocker et al. 2013 have it).
#pragma once

#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/image.hpp"
#include "algo/core/pose.hpp"

namespace st {

// Mean inverse depth of blocks of the image, in 1/m; 0 where a block has hardly a reading.
struct Thumbnail {
  static constexpr int kAcross = 20, kDown = 15, kBlocks = kAcross * kDown;
  float inverse_depth[kBlocks]{};
};
Thumbnail thumbnail_of(ImageView<const float> depth_z);

// Mean difference of the blocks that both have, 1/m; huge when they share less than a third of the image.
float difference(const Thumbnail& a, const Thumbnail& b);

class Places {
 public:
  static constexpr std::size_t kMost = 256;

  void bind(Bump& memory) { places_ = memory.take<Place>(kMost); }

  // Keeps the view unless one from nearly there is kept already. Once all places are taken the oldest makes
  // room.
  void remember(const Pose& T_world_camera, ImageView<const float> depth_z);

  std::size_t size() const { return size_; }

  // The pose of the place that looks `rank`-th most like the thumbnail (0: most), and how much it differs.
  // rank < size().
  struct Match {
    Pose T_world_camera;
    float difference;
  };
  Match like(const Thumbnail& seen, std::size_t rank) const;

 private:
  struct Place {
    Pose T_world_camera;
    Thumbnail seen;
  };
  std::span<Place> places_;
  std::size_t size_ = 0, next_ = 0;
};

}  // namespace st
