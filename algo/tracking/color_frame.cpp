#include "algo/tracking/color_frame.hpp"

#include <cmath>

namespace st {
namespace {

constexpr int kMargin_px = 10;  // for motion between the two images, and the smoothing

Rect where(const ColorRegistration& registration, const Pinhole& camera, const Rect& box) {
  constexpr float kNearest_m = 0.4f, kFarthest_m = 10.0f;
  const Pinhole color = Pinhole::of(registration.camera());
  const PoseF T = registration.T_color_depth();
  if (box.empty()) return {0, 0, 0, 0};
  Rect all = Rect::nothing();
  for (const float z : {kNearest_m, kFarthest_m})
    for (const int u : {box.u0, box.u1 - 1})
      for (const int v : {box.v0, box.v1 - 1}) {
        const Vec3f p = T * (camera.ray(static_cast<float>(u), static_cast<float>(v)) * z);
        if (!(p.z > 0.05f)) continue;
        const Pinhole::Pixel at = color.pixel_of(p);
        all.include(at.u, at.v);
      }
  return all.grown(kMargin_px).clipped(color.width, color.height);
}

std::int16_t grey_of(const std::uint8_t* rgb) {
  // Rec. 601 weights in 256ths; the sum is at most 255 * 256.
  const int sum = 77 * rgb[0] + 150 * rgb[1] + 29 * rgb[2];
  return static_cast<std::int16_t>(sum / (256 / static_cast<int>(kLuminanceScale)));
}

// The distorted image's grey value where an ideal camera would have the pixel; kNoColor outside.
std::int16_t ideal_grey(const ColorRegistration& registration, const ColorImage& image, int u, int v) {
  const Intrinsics& k = registration.camera();
  float rgb[3];
  if (!registration.sample_pixel(image, (u - k.cx) / k.fx, (v - k.cy) / k.fy, rgb)) return kNoColor;
  return static_cast<std::int16_t>((0.30078f * rgb[0] + 0.58594f * rgb[1] + 0.11328f * rgb[2]) *
                                   kLuminanceScale);
}

void fill_grey(const ColorRegistration& registration, const ColorImage& image, const Rect& roi,
               std::span<std::int16_t> grey) {
  const bool distorted = registration.camera().distorted();
  std::int16_t* out = grey.data();
  for (int v = roi.v0; v < roi.v1; ++v) {
    const std::uint8_t* row = image.rgb.row(v);
    for (int u = roi.u0; u < roi.u1; ++u)
      *out++ = distorted ? ideal_grey(registration, image, u, v) : grey_of(row + 3 * u);
  }
}

}  // namespace

void ColorFrame::bind(Bump& memory, int width, int height) {
  const std::size_t n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  pixels = memory.take<ColorPixel>(n + 1);
  grey = memory.take<std::int16_t>(n);
}

void build_color_frame(const ColorRegistration& registration, const ColorImage& image,
                       const Pinhole& depth_camera, const Rect& depth_box, ColorFrame& frame) {
  frame.camera = Pinhole::of(registration.camera());
  frame.T_color_depth = registration.T_color_depth();
  frame.roi = where(registration, depth_camera, depth_box);
  frame.pixels[0] = ColorPixel{};
  if (frame.roi.empty()) {
    frame.roi = {0, 0, 0, 0};
    return;
  }
  fill_grey(registration, image, frame.roi, frame.grey);
  const int width = frame.roi.width(), height = frame.roi.height();
  // A 3x3 binomial for the value, Sobel's two masks for the slopes: rows first, sums kept exact.
  for (int v = 0; v < height; ++v) {
    const std::int16_t* here = frame.grey.data() + static_cast<std::ptrdiff_t>(v) * width;
    const std::int16_t *above = v > 0 ? here - width : here, *below = v + 1 < height ? here + width : here;
    ColorPixel* out = frame.pixels.data() + 1 + static_cast<std::ptrdiff_t>(v) * width;
    const bool inner_row = v > 0 && v + 1 < height;
    for (int u = 0; u < width; ++u) {
      ColorPixel pixel;
      if (inner_row && u > 0 && u + 1 < width) {
        int left = 0, middle = 0, right = 0, top = 0, bottom = 0;
        bool known = true;
        const std::int16_t* rows[3] = {above, here, below};
        for (int r = 0; r < 3; ++r) {
          const int weight = r == 1 ? 2 : 1;
          const int a = rows[r][u - 1], b = rows[r][u], c = rows[r][u + 1];
          known = known && a != kNoColor && b != kNoColor && c != kNoColor;
          left += weight * a, middle += weight * b, right += weight * c;
          if (r == 0) top = a + 2 * b + c;
          if (r == 2) bottom = a + 2 * b + c;
        }
        if (known) {
          pixel.luminance = static_cast<std::int16_t>((left + 2 * middle + right) / 16);
          pixel.du = static_cast<std::int16_t>((right - left) / 8);
          pixel.dv = static_cast<std::int16_t>((bottom - top) / 8);
        }
      }
      out[u] = pixel;
    }
  }
}

}  // namespace st
