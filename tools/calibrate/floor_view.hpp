// A floor as one still camera sees it: the mean of many frames, and the plane in it.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/core/records.hpp"
#include "algo/depth/depth_tables.hpp"
#include "algo/segmentation/floor.hpp"
#include "firmware_like/heap_memory.hpp"

namespace st {

// The mean reading of a pixel: 8 raw_a / z, that is disparity in eighths of a raw step.
struct FloorSample {
  int u = 0, v = 0;
  double code = 0;
};
inline constexpr int kFloorPatch_px = 16;

class FloorView {
 public:
  explicit FloorView(const Calibration& calibration);
  FloorView(const FloorView&) = delete;  // the tables point into the memory
  FloorView(FloorView&&) = default;

  void add(const FrameInput& frame);
  int frames() const { return frames_; }

  // The floor in the mean of the frames; found = false where there is none.
  Floor find_floor();

  // Pixels on the floor with a reading in at least half of the frames, one of every two by two. The floor is
  // what hangs together in patches of 16 x 16 pixels that are as steep as it.
  std::vector<FloorSample> samples(const Floor& floor) const;

  bool has_gravity() const { return gravity_frames_ > 0; }
  Vec3 up() const { return normalized(gravity_); }  // as the accelerometer has it, camera frame

 private:
  double mean(int u, int v) const;  // codes, 0: none
  // A patch beside the floor's plane: its mean, codes, where it is as steep as the floor; else a large
  // number.
  double patch_offset(const Floor& floor, int column, int row) const;
  std::vector<bool> floor_patches(const Floor& floor) const;

  DepthTables tables_;
  HeapMemory memory_;  // of the tables
  std::vector<std::uint16_t> code_, stored_;
  std::vector<std::uint32_t> sum_, count_;
  Vec3 gravity_{};
  int frames_ = 0, gravity_frames_ = 0;
};

}  // namespace st
