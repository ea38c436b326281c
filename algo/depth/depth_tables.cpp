#include "algo/depth/depth_tables.hpp"

#include <cmath>

namespace st {
namespace {

constexpr double kKinectRawA = 345.4894;  // gives TUM images the same scale of codes as a Kinect's own values
constexpr double kCodesPerRaw = 8.0;

int stored_values(const Calibration& calibration) {
  return calibration.encoding == DepthEncoding::kRaw11 ? 2048 : 65536;
}

}  // namespace

void DepthTables::bind(Bump& memory, const Calibration& calibration) {
  const auto values = static_cast<std::size_t>(stored_values(calibration));
  const auto width = static_cast<std::size_t>(calibration.depth.width);
  const auto height = static_cast<std::size_t>(calibration.depth.height);
  code_of_stored_ = memory.take<std::uint16_t>(values);
  z_of_stored_ = memory.take<float>(values);
  z_of_code_ = memory.take<float>(kCodes);
  ray_x_ = memory.take<float>(width);
  ray_y_ = memory.take<float>(height);
  remap_ = memory.take<std::uint32_t>(calibration.depth.distorted() ? width * height : 0);
  correction_ = memory.take<std::int16_t>(calibration.correction.empty() ? 0 : width * height);
}

double DepthTables::metres_of_stored(int stored) const {
  if (calibration_.encoding == DepthEncoding::kRaw11) {
    const double disparity = calibration_.raw_b - stored;
    return stored < 2047 && disparity > 0 ? calibration_.raw_a / disparity : 0;
  }
  return stored == 65535 ? 0 : stored / calibration_.depth_scale;
}

void DepthTables::configure(const Calibration& calibration) {
  calibration_ = calibration;
  const bool raw = calibration.encoding == DepthEncoding::kRaw11;
  k_ = kCodesPerRaw * (raw ? calibration.raw_a : kKinectRawA);
  const double exact_origin = kCodesPerRaw * calibration.raw_b;
  raw_origin_ = raw ? static_cast<int>(std::floor(exact_origin + 0.5)) : 0;
  offset_ = raw ? exact_origin - raw_origin_ : 0;
  step_per_squared_code_ = raw ? 0 : 1.0 / (k_ * calibration.depth_scale);
  fill_codes();
  const Intrinsics& camera = calibration.depth;
  for (int u = 0; u < camera.width; ++u)
    ray_x_[static_cast<std::size_t>(u)] = static_cast<float>((u - camera.cx) / camera.fx);
  for (int v = 0; v < camera.height; ++v)
    ray_y_[static_cast<std::size_t>(v)] = static_cast<float>((v - camera.cy) / camera.fy);
  if (!remap_.empty()) fill_remap();
  if (!correction_.empty()) fill_correction();
}

void DepthTables::fill_codes() {
  raw_first_ = 0;
  raw_last_ = -1;
  for (std::size_t i = 0; i < code_of_stored_.size(); ++i) {
    const double z = metres_of_stored(static_cast<int>(i));
    const double code = z > 0 ? std::floor(k_ / z - offset_ + 0.5) : 0;
    const bool valid = z >= kNearest_m && z <= kFarthest_m && code >= 1 && code < kCodes;
    code_of_stored_[i] = valid ? static_cast<std::uint16_t>(code) : std::uint16_t{0};
    z_of_stored_[i] = valid ? static_cast<float>(z) : 0.0f;
    if (valid && calibration_.encoding == DepthEncoding::kRaw11) {
      if (raw_last_ < 0) raw_first_ = static_cast<int>(i);
      raw_last_ = static_cast<int>(i);
    }
  }
  z_of_code_[0] = 0;
  for (std::size_t q = 1; q < kCodes; ++q)
    z_of_code_[q] = static_cast<float>(k_ / (static_cast<double>(q) + offset_));
}

void DepthTables::fill_remap() {
  const Intrinsics& camera = calibration_.depth;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Normalized at = distort(camera, {(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy});
      const double su = std::floor(at.x * camera.fx + camera.cx + 0.5);
      const double sv = std::floor(at.y * camera.fy + camera.cy + 0.5);
      const bool inside = su >= 0 && sv >= 0 && su < camera.width && sv < camera.height;
      const auto pixel = static_cast<std::size_t>(v * camera.width + u);
      remap_[pixel] = inside ? static_cast<std::uint32_t>(sv) * static_cast<std::uint32_t>(camera.width) +
                                   static_cast<std::uint32_t>(su)
                             : kNoSource;
    }
  }
}

void DepthTables::fill_correction() {
  const Intrinsics& camera = calibration_.depth;
  std::size_t pixel = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double codes = kCodesPerRaw * calibration_.correction.at(u, v, camera.width, camera.height);
      correction_[pixel++] = static_cast<std::int16_t>(std::floor(codes + 0.5));
    }
  }
}

}  // namespace st
