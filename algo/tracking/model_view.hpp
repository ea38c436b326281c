// What the alignment works on: the object's model as the camera would see it at the predicted pose, and the
// pixels of the present frame that belong to the object.
#pragma once

#include <cmath>
#include <cstdint>

#include "algo/core/pinhole.hpp"
#include "algo/core/pose.hpp"
#include "algo/volume/raycast.hpp"

namespace st {

struct ModelView {
  ModelMaps maps;        // z, normal, colour of the rendered rectangle
  Pose T_camera_object;  // pose that it was rendered at

  // Depth at the pixel, metres; 0 outside of the view and where the model is not seen.
  float z(int u, int v) const { return maps.contains(u, v) ? maps.z[maps.at(u, v)] : 0.0f; }
};

// Pixels of `box` in which two surfaces, each a function from pixel to depth (0: none), lie within near_m.
template <typename A, typename B>
int count_same_surface(const A& a, const B& b, const Rect& box, float near_m) {
  int same = 0;
  for (int v = box.v0; v < box.v1; ++v) {
    for (int u = box.u0; u < box.u1; ++u) {
      const float za = a(u, v), zb = b(u, v);
      same += za > 0 && zb > 0 && std::fabs(za - zb) < near_m ? 1 : 0;
    }
  }
  return same;
}

// A pixel of the object in the present frame.
struct ObservedPoint {
  Vec3f p;  // camera frame, metres
  std::uint16_t u = 0, v = 0;
};

// One-sigma depth noise of a structured-light camera, metres: a constant error in disparity grows with the
// square of distance (Khoshelham and Elberink 2012: half a disparity step, 1.425e-3 z^2), on a floor for the
// near range.
inline constexpr float kLeastDepthSigma_m = 0.0007f, kDepthSigmaPerSquare = 0.001425f;
inline float depth_sigma_m(float z_m) { return kLeastDepthSigma_m + kDepthSigmaPerSquare * z_m * z_m; }

}  // namespace st
