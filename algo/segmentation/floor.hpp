// The plane that things stand on, found in the learned background.
//
// A plane n.p + d = 0 is linear in inverse depth over the image, q = a u + b v + c, and disparity noise and
// steps are the same at every depth in q. So the fit is linear least squares in (u, v, q), free of the bias
// that quantised depth gives a fit in metres.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/image.hpp"
#include "algo/core/linear.hpp"
#include "algo/depth/depth_tables.hpp"

namespace st {

// q at pixel (u, v) of the plane, in codes.
struct PlaneCodes {
  float a = 0, b = 0, c = 0;
  float at(int u, int v) const { return a * static_cast<float>(u) + b * static_cast<float>(v) + c; }
};

struct Floor {
  bool found = false;
  Vec3 n{};                 // unit, camera optical frame, towards the camera's side: up
  double d = 0;             // n.p + d = 0; the camera's height above the plane, metres
  double sigma_code = 0;    // residual of the fit, codes (robust standard deviation)
  double inlier_share = 0;  // of the pixels with a background
  PlaneCodes codes{};

  // Height above the plane, metres, of a pixel with code q where the plane has code `plane_q`.
  float height_m(float q, float plane_q) const {
    return q > 0 ? static_cast<float>(d) * (q - plane_q) / q : 0;
  }
};

class FloorFinder {
 public:
  void bind(Bump& memory);

  // Bounded RANSAC with a fixed seed, then robust least squares. `background`: codes with kFractionBits more
  // bits, 0 unknown. The plane must be support: its normal within 10 degrees of `up` where the accelerometer
  // gave one (has_up, any length, camera frame), else within 25 degrees of the image's vertical sideways and
  // no steeper than a camera that looks down by 70 degrees. found = false when no such plane holds a tenth of
  // the known pixels.
  Floor find(const DepthTables& tables, ImageView<const std::uint16_t> background, bool has_up,
             const Vec3& up);

 private:
  static constexpr int kAcross = 64, kDown = 48, kSamples = kAcross * kDown;
  int sample(ImageView<const std::uint16_t> background);
  bool propose(std::uint32_t& random, PlaneCodes& plane) const;
  int count_inliers(const PlaneCodes& plane, float tolerance) const;
  PlaneCodes refine(PlaneCodes plane) const;
  double residual_sigma(const PlaneCodes& plane) const;

  std::span<float> u_, v_, q_;              // known samples, packed
  std::span<std::int16_t> packed_of_cell_;  // grid cell -> packed sample, -1 none
  std::span<std::int16_t> cell_of_packed_;
  int known_ = 0;
  float smallest_area_ = 0;  // pixels, of a proposal's triangle, twice
};

}  // namespace st
