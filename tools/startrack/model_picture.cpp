#include "tools/startrack/model_picture.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "tools/report/mesh_picture.hpp"

namespace st {
namespace {

constexpr int kThumbnail_px = 128, kPicture_px = 480;

void put(RgbaImage& image, int u, int v) {
  if (u < 0 || v < 0 || u >= image.width || v >= image.height) return;
  std::uint8_t* const pixel = &image.pixels[4 * static_cast<std::size_t>(v * image.width + u)];
  pixel[0] = 230, pixel[1] = 60, pixel[2] = 20, pixel[3] = 255;
}

void ring(RgbaImage& image, double u, double v, double radius_px) {
  const int steps = static_cast<int>(8 * radius_px) + 8;
  for (int i = 0; i < steps; ++i) {
    const SinCos a = sin_cos(2 * kPi * i / steps);
    for (const double r : {radius_px, radius_px - 0.7})
      put(image, static_cast<int>(u + r * a.cos), static_cast<int>(v + r * a.sin));
  }
}

// The mesh from one side, on white, with its keypoints.
RgbaImage with_keypoints(const MeshView& mesh, const MeshFrame& frame, const ViewDirection& view,
                         std::span<const Feature> features) {
  RgbaImage image = render_mesh(mesh, frame, view, kPicture_px);
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
    const int alpha = image.pixels[i + 3];
    for (std::size_t c = 0; c < 3; ++c)
      image.pixels[i + c] =
          static_cast<std::uint8_t>((image.pixels[i + c] * alpha + 255 * (255 - alpha)) / 255);
    image.pixels[i + 3] = 255;
  }
  const double scale = 0.5 * kPicture_px / std::max(1e-9, frame.radius_m * 1.03);  // as render_mesh() has it
  for (const Feature& f : features) {
    const Vec3 p = view.R * (to_double(f.p_m) - frame.middle);
    ring(image, 0.5 * kPicture_px + p.x * scale, 0.5 * kPicture_px - p.y * scale,
         std::max(2.0, static_cast<double>(f.sigma_m) * scale));
  }
  return image;
}

}  // namespace

std::string model_thumbnail(const MeshView& mesh) {
  if (mesh.vertices.empty()) return {};
  return encode_png(render_mesh(mesh, frame_of(mesh), view_oblique(0), kThumbnail_px));
}

std::string model_picture(const MeshView& mesh, std::span<const Feature> features) {
  const MeshFrame frame = frame_of(mesh);
  const RgbaImage above = with_keypoints(mesh, frame, view_from_above(0), features);
  const RgbaImage oblique = with_keypoints(mesh, frame, view_oblique(0), features);
  RgbaImage both{2 * kPicture_px, kPicture_px, {}};
  for (int v = 0; v < kPicture_px; ++v)
    for (const RgbaImage* half : {&above, &oblique}) {
      const auto row = half->pixels.begin() + static_cast<std::ptrdiff_t>(4 * v) * kPicture_px;
      both.pixels.insert(both.pixels.end(), row, row + 4 * kPicture_px);
    }
  return encode_png(both);
}

}  // namespace st
