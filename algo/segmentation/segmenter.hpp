// From a stored depth frame to what moved: preprocessing, background, floor, things that stood there from the
// start, connected segments. One call a frame on memory bound once; the same frames give the same result bit
// for bit.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/calibration.hpp"
#include "algo/core/fixed_vector.hpp"
#include "algo/core/image.hpp"
#include "algo/core/records.hpp"
#include "algo/depth/depth_tables.hpp"
#include "algo/depth/preprocess.hpp"
#include "algo/segmentation/background.hpp"
#include "algo/segmentation/components.hpp"
#include "algo/segmentation/floor.hpp"
#include "algo/segmentation/proto_texture.hpp"
#include "algo/segmentation/protos.hpp"
#include "algo/segmentation/segment.hpp"

namespace st {

inline constexpr int kMaxSegments = 32;

struct SegmenterSettings {
  BackgroundSettings background;
  float least_area_cm2 = 12;
  int least_pixels = 40;      // at 640x480
  float least_top_m = 0.03f;  // above the floor; flatter segments on it are its noise
};

struct Segmentation {
  CleanDepth depth;                             // code image, stored values on the same grid, invalid count
  ImageView<const std::uint8_t> labels;         // 0 none, else index in `segments` + 1
  ImageView<const std::uint8_t> classes;        // PixelClass
  FixedVector<Segment, kMaxSegments> segments;  // largest area first
  bool background_ready = false;
  Rect view{};  // the part of the image in which the sensor has readings; known with the background
  bool restarted = false;  // the whole view has changed (camera moved): learning anew
  Floor floor;
  bool has_released = false;  // one thing a frame: it has just begun to move
  ReleasedProto released;
  ImageView<const std::uint16_t>
      released_code;               // how it looked at rest, averaged codes; valid inside released.box
  std::uint32_t refused_runs = 0;  // foreground runs beyond the capacity
  std::uint32_t held_back = 0;     // slivers beside a thing that has not (yet) been seen to move
};

class Segmenter {
 public:
  void bind(Bump& memory, const Calibration& calibration);
  // Starts anew. `calibration` is the one bind() was called with.
  void configure(const Calibration& calibration, const SegmenterSettings& settings = {});

  // One frame, in two steps: stored values to codes and metres on an undistorted grid, then what moved.
  // `owner` (may be empty): 0 none, else track slot + 1, from the frame before: those pixels never become
  // background. The views in the results hold until the next call.
  const CleanDepth& preprocess(const FrameInput& frame);
  const Segmentation& segment(const FrameInput& frame, ImageView<const std::uint8_t> owner);

  const DepthTables& tables() const { return tables_; }
  ImageView<const std::uint16_t> background_code8() const {
    return background_.code8();
  }  // eighths of a code
  const Protos& protos() const { return protos_; }

 private:
  void average_gravity(const FrameInput& frame);
  void learn();
  void update_protos();
  void release_moved(const FrameInput& frame);
  Rect seen_view() const;
  bool view_has_changed() const;
  void fill_cells(ImageView<std::uint16_t> cells) const;
  void make_segments();
  void add_run(const Components::Run& run, bool large, SegmentSums& sums) const;
  void measure(int u, int v, SegmentSums& sums) const;
  void paint_run(const Components::Run& run, std::uint8_t label);
  bool is_segment(const SegmentSums& sums, float area_cm2);

  SegmenterSettings settings_;
  int width_ = 0, height_ = 0, step_ = 1;
  DepthTables tables_;
  Background background_;
  FloorFinder floor_finder_;
  Protos protos_;
  ProtoTexture texture_;
  Components components_;
  std::span<std::uint16_t> code_, stored_, rest_;
  std::span<std::uint8_t> labels_;
  Segmentation out_;
  Vec3 gravity_{};
  int gravity_frames_ = 0;
  std::uint32_t frames_ready_ = 0;
  SegmentSums sums_[Components::kMaxSelected];
  int changed_pixels_ = 0, calm_frames_ = 0;
};

}  // namespace st
