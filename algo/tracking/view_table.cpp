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

bool continues(const ViewPixel& pixel, float z) {
  return pixel.z > 0 && pixel.luminance != kNoColor && std::fabs(pixel.z - z) <= 0.02f + 0.01f * z;
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
  ViewPixel* out = table.pixels.data() + 1;
  for (int v = 0; v < height; ++v) {
    const std::size_t row = static_cast<std::size_t>(v) * static_cast<std::size_t>(maps.stride);
    for (int u = 0; u < width; ++u) *out++ = surface_pixel(maps, row + static_cast<std::size_t>(u));
  }
  for (int v = 1; v + 1 < height; ++v) {
    ViewPixel* row = table.pixels.data() + 1 + static_cast<std::ptrdiff_t>(v) * width;
    for (int u = 1; u + 1 < width; ++u) {
      ViewPixel& here = row[u];
      if (!(here.z > 0) || here.luminance == kNoColor) continue;
      const ViewPixel &left = row[u - 1], &right = row[u + 1], &up = row[u - width], &down = row[u + width];
      if (!continues(left, here.z) || !continues(right, here.z) || !continues(up, here.z) ||
          !continues(down, here.z))
        continue;
      here.du = static_cast<std::int16_t>(right.luminance - left.luminance);
      here.dv = static_cast<std::int16_t>(down.luminance - up.luminance);
    }
  }
}

}  // namespace st
