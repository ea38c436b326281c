#include "algo/tracking/view_table.hpp"

#include <cmath>

namespace st {
namespace {

std::int16_t rounded(float x) { return static_cast<std::int16_t>(x < 0 ? x - 0.5f : x + 0.5f); }

ViewPixel surface_pixel(const ModelMaps& maps, std::size_t at) {
  ViewPixel pixel;
  pixel.z = maps.z[at];
  if (!(pixel.z > 0)) return ViewPixel{};
  const Vec3f n = unpack_normal(maps.normal[at]);
  pixel.nx = rounded(n.x * kNormalScale);
  pixel.ny = rounded(n.y * kNormalScale);
  pixel.nz = rounded(n.z * kNormalScale);
  const std::uint32_t color = maps.color[at];
  pixel.luminance = alpha_of(color) != 0 ? rounded(luminance_of(color) * kLuminanceScale) : kNoColor;
  return pixel;
}

bool continues(const ModelMaps& maps, std::size_t at, float z) {
  return maps.z[at] > 0 && alpha_of(maps.color[at]) != 0 && std::fabs(maps.z[at] - z) <= 0.02f + 0.01f * z;
}

}  // namespace

void ViewTable::bind(Bump& memory, int max_width, int max_height) {
  pixels =
      memory.take<ViewPixel>(static_cast<std::size_t>(max_width) * static_cast<std::size_t>(max_height) + 1);
}

void build_view_table(const ModelView& view, ViewTable& table) {
  const ModelMaps& maps = view.maps;
  table.roi = maps.roi;
  table.T_camera_object = view.T_camera_object;
  table.pixels[0] = ViewPixel{};
  const int width = maps.roi.width(), height = maps.roi.height();
  const std::size_t stride = static_cast<std::size_t>(maps.stride);
  ViewPixel* out = table.pixels.data() + 1;
  for (int v = 0; v < height; ++v) {
    const std::size_t row = static_cast<std::size_t>(v) * stride;
    for (int u = 0; u < width; ++u, ++out) {
      const std::size_t at = row + static_cast<std::size_t>(u);
      *out = surface_pixel(maps, at);
      if (out->luminance == kNoColor) continue;
      const bool inner = u > 0 && u + 1 < width && v > 0 && v + 1 < height;
      if (!inner || !continues(maps, at - 1, out->z) || !continues(maps, at + 1, out->z) ||
          !continues(maps, at - stride, out->z) || !continues(maps, at + stride, out->z))
        out->luminance = kNoColor;
    }
  }
}

}  // namespace st
