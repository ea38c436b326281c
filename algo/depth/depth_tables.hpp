// From stored depth values to inverse-depth codes and metres, once per calibration.
//
// Everything before the alignment works on codes q = round(K / z - offset): a triangulating camera's noise
// and steps are constant in 1/z, and a plane is linear in it over the image (algo/segmentation/floor.hpp).
// For Kinect raw values K = 8 raw_a, so that one raw step is exactly 8 codes; a code of 0 is "no reading".
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/calibration.hpp"
#include "algo/core/image.hpp"

namespace st {

inline constexpr int kCodes = 8192;         // codes are below this; eight times a code still fits 16 bits
inline constexpr double kNearest_m = 0.35;  // readings outside of this range are not believed
inline constexpr double kFarthest_m = 10.0;

class DepthTables {
 public:
  // Memory for this calibration: a camera with lens distortion needs a remap table besides, one whose own
  // error is known a correction a pixel.
  void bind(Bump& memory, const Calibration& calibration);
  // Fills the tables. `calibration` is the one bind() was called with.
  void configure(const Calibration& calibration);

  const Calibration& calibration() const { return calibration_; }
  int width() const { return calibration_.depth.width; }
  int height() const { return calibration_.depth.height; }
  double codes_per_inverse_m() const { return k_; }  // K
  double code_offset() const { return offset_; }     // K / z = q + offset
  // Codes per stored step at code q is q * q * this (zero for raw values, whose step is 8 codes everywhere).
  double step_per_squared_code() const { return step_per_squared_code_; }

  std::span<const std::uint16_t> code_of_stored() const { return code_of_stored_; }
  std::span<const float> z_of_stored() const { return z_of_stored_; }  // metres, 0: no reading
  std::span<const float> z_of_code() const { return z_of_code_; }      // kCodes entries, metres, [0] = 0

  // Ideal pinhole rays: the point at depth z seen by pixel (u, v) is z * (ray_x()[u], ray_y()[v], 1).
  std::span<const float> ray_x() const { return ray_x_; }
  std::span<const float> ray_y() const { return ray_y_; }

  // For each pixel of the ideal image the nearest source pixel (kNoSource: outside). Empty without lens
  // distortion.
  static constexpr std::uint32_t kNoSource = 0xFFFFFFFFu;
  std::span<const std::uint32_t> remap() const { return remap_; }

  // Codes to add to each pixel's reading. Empty where the calibration has no correction.
  std::span<const std::int16_t> correction() const { return correction_; }

  // Raw encoding only: q = raw_origin - 8 raw where raw is within [raw_first, raw_last].
  int raw_origin() const { return raw_origin_; }
  int raw_first() const { return raw_first_; }
  int raw_last() const { return raw_last_; }

 private:
  void fill_codes();
  void fill_remap();
  void fill_correction();
  double metres_of_stored(int stored) const;

  Calibration calibration_;
  double k_ = 0, offset_ = 0, step_per_squared_code_ = 0;
  int raw_origin_ = 0, raw_first_ = 0, raw_last_ = -1;
  std::span<std::uint16_t> code_of_stored_;
  std::span<float> z_of_stored_, z_of_code_, ray_x_, ray_y_;
  std::span<std::uint32_t> remap_;
  std::span<std::int16_t> correction_;
};

}  // namespace st
