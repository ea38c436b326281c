// What is known about a camera: camera.toml in memory. Metres, pixels, row-major rotation.
#pragma once

#include "algo/core/pose.hpp"

namespace st {

inline constexpr int kMaxWidth = 640;
inline constexpr int kMaxHeight = 480;

// Pinhole with Brown-Conrady distortion k1 k2 p1 p2 k3 (OpenCV's order and meaning).
struct Intrinsics {
  int width = 640, height = 480;
  double fx = 575.8, fy = 575.8, cx = 320.0, cy = 240.0;
  double k[5] = {0, 0, 0, 0, 0};

  bool distorted() const { return k[0] != 0 || k[1] != 0 || k[2] != 0 || k[3] != 0 || k[4] != 0; }
};

enum class DepthEncoding {
  kRaw11,     // Kinect disparity: z = raw_a / (raw_b - raw), 2047 is no reading
  kScaled16,  // TUM PNG: z = stored / depth_scale, 0 and 65535 are no reading
};

struct Calibration {
  Intrinsics depth;
  DepthEncoding encoding = DepthEncoding::kRaw11;
  double depth_scale = 1000.0;
  double raw_a = 345.4894, raw_b = 1089.408;

  bool has_color = false;  // a [color] table, or the default of a Kinect
  Intrinsics color;
  bool color_registered = false;  // colour is already in the depth camera's pixels
  Pose T_color_depth;             // p_color = T_color_depth * p_depth
};

// Ideal (undistorted) image coordinates (x/z, y/z) <-> distorted ones.
struct Normalized {
  double x, y;
};
Normalized distort(const Intrinsics& camera, Normalized ideal);
Normalized undistort(const Intrinsics& camera, Normalized distorted);  // fixed-point iteration, 20 steps

}  // namespace st
