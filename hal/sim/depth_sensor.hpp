// A projected-pattern depth camera (Kinect v1): it sees the projector's dots from 75 mm beside it and finds,
// for a window round each pixel, how far they have shifted. What it gets wrong follows from that: shadows
// where the dots do not reach, ragged fattened edges where a window holds two surfaces, noise that is alike
// within a window, steps of 1/8 pixel, and nothing where dots are too dim or the surface too steep. Figures
// of reference/kinect-libfreenect.md, section 4, and of recordings of real ones: noise frozen to the pattern
// 0.45 steps, flicker 0.15-0.3 steps, correlation falling to nothing over nine pixels.
#pragma once

#include <cstdint>
#include <vector>

#include "algo/core/image.hpp"
#include "hal/sim/dot_pattern.hpp"
#include "hal/sim/raster.hpp"

namespace st::sim {

struct DepthSensorOptions {
  Pinhole camera;
  double baseline_m = 0.075;                  // the projector stands at +x of the camera
  double raw_a = 345.4894, raw_b = 1089.408;  // z = raw_a / (raw_b - raw)
  double frozen_noise = 0.45;                 // standard deviations, in steps of the raw value
  double flicker_noise = 0.15;                // on a bright surface; up to four times as much on dim ones
  double bias = 0.25;                         // smooth error over the image, peak, in steps
  std::uint64_t seed = 1;
};

class DepthSensor {
 public:
  static constexpr std::uint16_t kNoReading = 2047;
  static constexpr int kHalfWindow = 4;   // the matcher looks at 9 x 9 pixels
  static constexpr int kDeadColumns = 8;  // at the right border

  explicit DepthSensor(const DepthSensorOptions& options);

  // The still scene is drawn first, part by part, then sealed: matched once, and kept.
  void draw_still(const Mesh& mesh, const Pose& T_camera_mesh);
  void seal_still();

  // A frame: begin_frame(), the moving things, then match() and sample(). Ids are 1 to 255.
  void begin_frame();
  void draw_moving(const Mesh& mesh, const Pose& T_camera_mesh, std::uint8_t id);
  void match();
  // Raw values of the frame, noise of `frame_seed` included. `raw` is width x height.
  void sample(std::uint64_t frame_seed, ImageView<std::uint16_t> raw) const;

  // Which moving thing each pixel shows (0: none), occlusion included; before matching, so without fattened
  // edges.
  ImageView<const std::uint8_t> ids() const { return {id_.data(), width_, height_}; }
  // Pixels of thing `id` if nothing stood before it.
  int unoccluded_pixels(std::uint8_t id) const { return unoccluded_[id]; }
  // True inverse depth (1/m; 0: nothing there).
  ImageView<const float> inverse_depth() const { return {inverse_z_.data(), width_, height_}; }

 private:
  struct Matched {
    std::vector<std::uint16_t> raw32;  // raw value in 1/32 steps, frozen noise included
    std::vector<std::uint8_t> spread;  // flicker, 16 is the brightest surface's
    std::vector<std::uint8_t> trust;   // a reading comes where trust and flicker exceed 128
  };

  Rect draw_camera(const Mesh& mesh, const Pose& T, float* inverse_z, float* signal);
  Rect draw_projector(const Mesh& mesh, const Pose& T, float* inverse_z);
  void match_rect(Rect rect, Matched& out);
  void find_lit(Rect rect);
  void sum_row(int v, int u0, int u1);
  void match_row(int v, int u0, int u1, Matched& out);
  void vote(int u, int v, Matched& out) const;
  void store(int u, int v, float raw, float signal, float share, Matched& out) const;
  int pattern_column(int u, float raw) const;
  void restore(Rect rect);

  DepthSensorOptions options_;
  int width_, height_;
  Pinhole projector_camera_;
  Rasteriser rasteriser_;
  std::vector<float> still_inverse_z_, still_signal_, still_projector_, inverse_z_, signal_, projector_;
  std::vector<std::uint8_t> id_;
  std::vector<float> own_inverse_z_,
      own_signal_;  // one moving thing by itself, to count what is hidden of it
  std::vector<float> disparity_, weight_, expected_, low_, high_, sum_,
      signal_sum_;  // of the rectangle being matched, image-sized
  std::vector<float> padded_;
  Matched still_, live_;
  std::vector<Rect> dirty_, projector_dirty_;
  int unoccluded_[256]{};
  DotPattern pattern_;
  std::vector<float> bias_;
  std::vector<std::int8_t> flicker_;
};

}  // namespace st::sim
