#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "algo/tracking/track.hpp"

namespace st {

Support make_support(const Vec3& up, double d, bool found) {
  Support support;
  support.found = found;
  support.up = normalized(up);
  support.d = d;
  // x: the camera's viewing axis laid on the floor. A camera that looks straight down has none; its image's
  // upper edge takes that part.
  Vec3 forward = Vec3{0, 0, 1} - support.up * support.up.z;
  if (norm(forward) < 0.05) forward = Vec3{0, -1, 0} - support.up * -support.up.y;
  const Vec3 x = normalized(forward);
  support.R_camera_floor = Mat3::from_columns(x, cross(support.up, x), support.up);
  return support;
}

Pose2 Support::on_floor(const Pose& T_camera_object) const {
  const Mat3 R_floor_camera = R_camera_floor.transposed();
  const Vec3 p = R_floor_camera * T_camera_object.t;
  return {p.x, p.y, to_roll_pitch_yaw(R_floor_camera * T_camera_object.R).z};
}

std::uint8_t& SeenSides::side_of(const Pose& T_camera_object) {
  const Vec3 camera = normalized(T_camera_object.inverse().t);
  const double azimuth = (arc_tan2(camera.y, camera.x) + kPi) / (2 * kPi) * kAzimuths;
  const double elevation =
      (arc_tan2(camera.z, std::sqrt(camera.x * camera.x + camera.y * camera.y)) / kPi + 0.5) * kElevations;
  const int a = static_cast<int>(azimuth) % kAzimuths;
  const int e = static_cast<int>(elevation) < kElevations ? static_cast<int>(elevation) : kElevations - 1;
  return fused[e * kAzimuths + a];
}

}  // namespace st
