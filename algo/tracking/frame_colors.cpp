#include "algo/tracking/frame_colors.hpp"

#include "algo/tracking/frame_colors_kernel.hpp"

namespace st {

bool frame_colors(const Calibration& calibration, const ColorImage& image, const PoseF& motion,
                  ImageView<const float> depth_z, const Pinhole& camera, ImageView<std::uint32_t> color) {
  const bool registered = calibration.color_registered;
  // Registered colour stands in the depth camera's pixels, with that one's distortion.
  const Intrinsics& lens = registered ? calibration.depth : calibration.color;
  if (image.rgb.width != 3 * lens.width || image.rgb.height != lens.height) return false;
  FrameColorsKernel k{};
  k.z = depth_z.data;
  k.width = depth_z.width;
  k.height = depth_z.height;
  k.cx = camera.cx;
  k.cy = camera.cy;
  k.per_fx = 1.0f / camera.fx;
  k.per_fy = 1.0f / camera.fy;
  const PoseF T = registered ? PoseF{} : to_float(calibration.T_color_depth);
  const Mat3f R = T.R * motion.R;
  const Vec3f t = T * motion.t;
  for (int i = 0; i < 9; ++i) k.R[i] = R.m[i];
  for (int i = 0; i < 3; ++i) k.t[i] = t[i];
  k.rgb = image.rgb.data;
  k.color_width = lens.width;
  k.color_height = lens.height;
  k.color_fx = static_cast<float>(lens.fx);
  k.color_fy = static_cast<float>(lens.fy);
  k.color_cx = static_cast<float>(lens.cx);
  k.color_cy = static_cast<float>(lens.cy);
  k.distorted = lens.distorted();
  for (int i = 0; i < 5; ++i) k.k[i] = static_cast<float>(lens.k[i]);
  k.out = color.data;
  sample_colors(k);
  return true;
}

}  // namespace st
