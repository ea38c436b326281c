// The colour camera beside the depth camera: lamps on the ceiling, a soft shadow under what stands on the
// floor, lens fall-off, exposure that drifts, and noise. Drawn at twice the size and brought down, as a lens
// and a colour filter would blur it.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "algo/core/image.hpp"
#include "hal/sim/random.hpp"
#include "hal/sim/raster.hpp"

namespace st::sim {

struct ColorSensorOptions {
  Pinhole camera{525, 525, 319.5f, 239.5f, 640, 480};
  std::vector<Vec3f> lamps;  // colour camera frame
  double exposure = 1.0;
  double noise = 4.0;      // grey levels
  double vignette = 0.18;  // light lost in the corners
  std::uint64_t seed = 1;
};

class ColorSensor {
 public:
  explicit ColorSensor(const ColorSensorOptions& options);

  void draw_still(const Mesh& mesh, const Pose& T_camera_mesh);
  void seal_still();
  // Where the lamps hang now, colour camera frame, when the camera moves.
  void hang_lamps(std::vector<Vec3f> lamps) { options_.lamps = std::move(lamps); }

  // A frame: begin_frame(), shadows, moving things, then develop() and sample().
  void begin_frame();
  // Darkens the floor (plane z = 0 of the room) round a thing of this radius.
  void cast_shadow(const Pose& T_camera_room, const Vec3& where_room, double radius_m, double strength);
  void draw_moving(const Mesh& mesh, const Pose& T_camera_mesh);
  void develop();
  // RGB, three bytes a pixel, width x height; `gain` times the exposure.
  void sample(std::uint64_t frame_seed, double gain, std::uint8_t* rgb) const;

 private:
  Rect draw(const Mesh& mesh, const Pose& T, std::vector<float>& inverse_z,
            std::vector<std::uint32_t>& picture);
  void develop_rect(Rect rect, const std::vector<std::uint32_t>& picture,
                    std::vector<std::uint8_t>& rgb) const;
  float brightness(const Vec3f& position, const Vec3f& normal) const;
  std::uint8_t tone(float light) const;
  void mark(Rect twice);

  ColorSensorOptions options_;
  int width_, height_;
  Pinhole twice_;
  Rasteriser rasteriser_;
  std::vector<float> still_inverse_z_, inverse_z_;
  std::vector<std::uint32_t> still_picture_, picture_;  // at twice the size: r, g, b in the low three bytes
  std::vector<std::uint8_t> still_rgb_, rgb_, vignette_, tones_;
  std::vector<Rect> dirty_;  // of the picture at twice the size
  std::vector<std::int8_t> noise_;
};

}  // namespace st::sim
