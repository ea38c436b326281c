// Writes a frame into a volume (Curless & Levoy 1996; weights by measured noise, Nguyen, Izadi & Lovell
// 2012). Only bricks that the frame's surface or the space emptied before it can touch are visited; their
// number bounds the work.
#pragma once

#include <span>

#include "algo/volume/evidence.hpp"
#include "algo/volume/fuse_kernel.hpp"
#include "algo/volume/volume.hpp"

namespace st {

struct IntegrateOptions {
  NoiseWeights noise;
  float weight_cap = 64;      // nominal observations, whole, up to kMaxWeightCap: the memory of the average
  float carve_weight = 0.5f;  // of a look through a voxel, beside one of a surface at the nominal distance
  float color_cap =
      15;  // trust at which the colour average stops narrowing, 1-15; 8 until the first full turn is closed
};

struct IntegrateStats {
  int surface_pixels = 0;  // used
  int refused_pixels = 0;  // on depth edges or grazing
  int outside_pixels = 0;  // used, but outside of the box: counted, not stored
  Vec3f low{}, high{};     // extent of the used samples, object frame; low > high when there are none
  int bricks = 0;          // visited
  int updated = 0, carved = 0, colored = 0, color_refused = 0;  // voxels
};

struct IntegrateScratch {
  Evidence evidence;
  std::span<FuseBrick> list;

  // For frames up to this size and volumes up to this many voxels a side. One serves all objects, one after
  // another.
  void bind(Bump& memory, int max_width, int max_height, int max_side);
};

// T_camera_object: a pose that is believed; the caller refuses others. The result does not depend on the
// instruction set.
IntegrateStats integrate(Volume& volume, const EvidenceInput& input, const Pose& T_camera_object,
                         const IntegrateOptions& options, IntegrateScratch& scratch);

}  // namespace st
