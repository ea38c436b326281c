// Where the bricks of a volume fall in an image: the same for every brick but for its centre, so it is
// prepared once a frame.
#pragma once

#include <cmath>

#include "algo/core/image.hpp"
#include "algo/core/pinhole.hpp"
#include "algo/core/pose.hpp"
#include "algo/volume/volume.hpp"

namespace st {

// A group of `voxels`^3 voxels seen by a camera: the pixels and depths that it cannot leave.
struct BrickBounds {
  Rect rect;  // pixels whose centre is nearest to some point of the group, relative to the given rectangle's
              // corner
  float near_m, far_m;
  bool in_front;  // false: it reaches the camera's plane, and rect is everything
};

class BrickView {
 public:
  // margin_voxels: how far the box reaches beyond the outermost voxel centres.
  BrickView(const Volume& volume, const Pinhole& camera, const Rect& roi, const Pose& T_camera_object,
            int voxels, float margin_voxels)
      : T_(to_float(T_camera_object)),
        camera_(camera),
        roi_(roi),
        voxel_m_(volume.voxel_m),
        origin_(volume.origin) {
    const float half = (0.5f * static_cast<float>(voxels - 1) + margin_voxels) * voxel_m_;
    for (int a = 0; a < 3; ++a)
      half_[a] = half * (std::fabs(T_.R(a, 0)) + std::fabs(T_.R(a, 1)) + std::fabs(T_.R(a, 2))) + kRounding_m;
    middle_ = 0.5f * static_cast<float>(voxels - 1);
  }

  // Depth of the group's middle, and how far it reaches before and behind it: for a cheap first test.
  float depth_of(int x, int y, int z) const { return dot(T_.R.row(2), place(x, y, z)) + T_.t.z; }
  float half_depth() const { return half_.z; }

  // The group whose first voxel is (x, y, z).
  BrickBounds of(int x, int y, int z) const {
    const Vec3f c = T_ * place(x, y, z);
    BrickBounds b{{0, 0, roi_.width(), roi_.height()}, c.z - half_.z, c.z + half_.z, true};
    if (b.far_m < kNearest_m) return {{0, 0, 0, 0}, 0, 0, false};
    if (b.near_m < kNearest_m) return {b.rect, kNearest_m, b.far_m, false};
    const float per_z = 1.0f / c.z, per_near = 1.0f / b.near_m;
    const float x_z = c.x * per_z, y_z = c.y * per_z;
    const float u = camera_.fx * x_z + camera_.cx - static_cast<float>(roi_.u0);
    const float v = camera_.fy * y_z + camera_.cy - static_cast<float>(roi_.v0);
    // |u - u_c| = f |ex - (X/Z) ez| / (Z + ez) for every point c + e of the box; one pixel for rounding to
    // centres.
    const float du = camera_.fx * (half_.x + std::fabs(x_z) * half_.z) * per_near + 1.0f;
    const float dv = camera_.fy * (half_.y + std::fabs(y_z) * half_.z) * per_near + 1.0f;
    b.rect = {pixel(u - du, roi_.width()), pixel(v - dv, roi_.height()), pixel(u + du, roi_.width()) + 1,
              pixel(v + dv, roi_.height()) + 1};
    if (u + du < 0) b.rect.u1 = 0;
    if (v + dv < 0) b.rect.v1 = 0;
    return b;
  }

 private:
  Vec3f place(int x, int y, int z) const {
    const Vec3f q{static_cast<float>(x) + middle_, static_cast<float>(y) + middle_,
                  static_cast<float>(z) + middle_};
    return origin_ + q * voxel_m_;
  }
  static constexpr float kRounding_m = 1e-4f, kNearest_m = 0.05f;
  // Clamped so that the conversion is defined; anything outside of the image stays outside.
  static int pixel(float x, int size) {
    const float limit = static_cast<float>(size);
    return x > 0 ? static_cast<int>(x < limit ? x : limit) : 0;
  }

  PoseF T_;
  Pinhole camera_;
  Rect roi_;
  float voxel_m_, middle_;
  Vec3f origin_, half_{};
};

}  // namespace st
