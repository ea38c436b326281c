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

// The sensor's own smooth error over the image: nodes in a grid from corner pixel to corner pixel, bilinear
// between them, row by row. What they say is taken off a raw reading, in its steps (an eighth of a pixel of
// disparity).
struct DisparityCorrection {
  static constexpr int kMostColumns = 17, kMostRows = 13;
  int columns = 0, rows = 0;  // 0: none; else at least 2
  float steps[kMostColumns * kMostRows] = {};

  // The four nodes round a pixel of an image of that size, and their weights, which sum up to 1.
  struct Around {
    int node[4];
    double weight[4];
  };
  Around around(double u, double v, int width, int height) const;

  bool empty() const { return columns == 0; }
  double at(double u, double v, int width, int height) const;
};

struct Calibration {
  Intrinsics depth;
  DepthEncoding encoding = DepthEncoding::kRaw11;
  double depth_scale = 1000.0;
  double raw_a = 345.4894, raw_b = 1089.408;
  DisparityCorrection correction;  // on the ideal pinhole grid

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
