#include "hal/sim/camera_rig.hpp"

#include "algo/core/scalar_math.hpp"

namespace st::sim {

CameraRig::CameraRig(Scene scene) : scene_(std::move(scene)) {
  const bool stands = !scene_.camera_motion;  // before a camera in a hand nothing stands still
  const Pose T_color_room = color_room_at(0);
  depth_ = std::make_unique<DepthSensor>(scene_.depth);
  if (stands) depth_->draw_still(scene_.still, scene_.T_camera_room);
  depth_->seal_still();
  ColorSensorOptions color;
  const Intrinsics& k = scene_.calibration.color;
  color.camera = {static_cast<float>(k.fx),
                  static_cast<float>(k.fy),
                  static_cast<float>(k.cx),
                  static_cast<float>(k.cy),
                  k.width,
                  k.height};
  color.lamps = lamps_at(T_color_room);
  color.exposure = scene_.color_exposure;
  color.noise = scene_.color_noise;
  color.seed = scene_.seed;
  color_ = std::make_unique<ColorSensor>(color);
  if (stands) color_->draw_still(scene_.still, T_color_room);
  color_->seal_still();
}

std::vector<Vec3f> CameraRig::lamps_at(const Pose& T_color_room) const {
  std::vector<Vec3f> lamps;
  for (const Vec3& lamp : scene_.lamps_room) lamps.push_back(to_float(T_color_room * lamp));
  return lamps;
}

void CameraRig::drive_part(int part, Motion motion) {
  scene_.parts[static_cast<std::size_t>(part)].motion = std::move(motion);
}

void CameraRig::depth_frame(double t_s, std::uint64_t index, ImageView<std::uint16_t> raw) {
  constexpr std::uint8_t kNobodys = 255;
  const Pose T_camera_room = scene_.camera_at(t_s);
  depth_->begin_frame();
  if (scene_.camera_motion) depth_->draw_moving(scene_.still, T_camera_room, kNobodys);
  Pose T_room_part;
  for (const Part& part : scene_.parts)
    if (part.motion(t_s, T_room_part))
      depth_->draw_moving(part.mesh, T_camera_room * T_room_part,
                          static_cast<std::uint8_t>(part.object < 0 ? kNobodys : part.object + 1));
  depth_->match();
  depth_->sample(index, raw);
}

void CameraRig::color_frame(double t_s, std::uint64_t index, std::uint8_t* rgb) {
  const Pose T_color_room = color_room_at(t_s);
  color_->begin_frame();
  if (scene_.camera_motion) {
    color_->hang_lamps(lamps_at(T_color_room));
    color_->draw_moving(scene_.still, T_color_room);
  }
  Pose T_room_part;
  for (const Part& part : scene_.parts)
    if (part.shadow_radius_m > 0 && part.motion(t_s, T_room_part)) {
      // The higher it hangs, the paler and wider its shadow.
      const double lift = T_room_part.t.z > 0 ? T_room_part.t.z : 0;
      color_->cast_shadow(T_color_room, T_room_part.t, part.shadow_radius_m * (1 + lift),
                          0.45 / (1 + 12 * lift));
    }
  for (const Part& part : scene_.parts)
    if (part.motion(t_s, T_room_part)) color_->draw_moving(part.mesh, T_color_room * T_room_part);
  color_->develop();
  // Automatic exposure and mains flicker: slow and small, never still.
  const double phase = static_cast<double>(scene_.seed % 97);
  const double gain = 1 + scene_.color_drift * (0.6 * sin_cos(0.31 * t_s + phase).sin +
                                                0.25 * sin_cos(1.9 * t_s + 2 * phase).sin);
  color_->sample(index, gain, rgb);
}

std::vector<Visibility> CameraRig::visibility(ImageView<const std::uint16_t> raw) const {
  std::vector<Visibility> all(scene_.objects.size());
  const ImageView<const std::uint8_t> ids = depth_->ids();
  for (int i = 0; i < ids.pixels(); ++i) {
    const std::size_t object = static_cast<std::size_t>(ids.data[i]) - 1;
    if (object >= all.size()) continue;
    ++all[object].pixels;
    all[object].valid += raw.data[i] != DepthSensor::kNoReading ? 1 : 0;
  }
  for (std::size_t k = 0; k < all.size(); ++k)
    all[k].whole_pixels = depth_->unoccluded_pixels(static_cast<std::uint8_t>(k + 1));
  return all;
}

}  // namespace st::sim
