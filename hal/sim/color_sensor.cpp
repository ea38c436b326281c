#include "hal/sim/color_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "algo/core/scalar_math.hpp"

namespace st::sim {
namespace {

constexpr int kNoiseMargin = 256;
constexpr int kTones = 1024;

std::uint32_t scaled(std::uint32_t rgb, std::uint32_t of_256) {
  const std::uint32_t rb = ((rgb & 0xff00ff) * of_256 >> 8) & 0xff00ff;
  return rb | (((rgb & 0x00ff00) * of_256 >> 8) & 0x00ff00);
}

}  // namespace

ColorSensor::ColorSensor(const ColorSensorOptions& options)
    : options_(options), width_(options.camera.width), height_(options.camera.height) {
  const Pinhole& c = options.camera;
  twice_ = {2 * c.fx, 2 * c.fy, 2 * c.cx + 0.5f, 2 * c.cy + 0.5f, 2 * c.width, 2 * c.height};
  const auto image = static_cast<std::size_t>(width_ * height_);
  still_inverse_z_.assign(4 * image, 0.0f);
  still_picture_.assign(4 * image, 0);
  still_rgb_.assign(3 * image, 0);
  vignette_.resize(image);
  const double corner = 0.25 * (width_ * width_ + height_ * height_);
  for (int v = 0; v < height_; ++v)
    for (int u = 0; u < width_; ++u) {
      const double x = u - 0.5 * width_, y = v - 0.5 * height_;
      vignette_[static_cast<std::size_t>(v * width_ + u)] =
          static_cast<std::uint8_t>(255.0 * (1 - options.vignette * (x * x + y * y) / corner));
    }
  tones_.resize(kTones);
  for (int i = 0; i < kTones; ++i) {  // gamma 1/2.2
    const double x = (i + 0.5) / kTones;
    tones_[static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(255.0 * exponential(natural_log(x) / 2.2));
  }
  Random random(options.seed, 0xc010);
  noise_.resize(static_cast<std::size_t>(3 * (width_ + kNoiseMargin) * (height_ + kNoiseMargin)));
  double neighbour = 0;
  for (std::int8_t& n : noise_) {  // two fields are added; a little alike from pixel to pixel
    const double fresh = random.uniform() + random.uniform() + random.uniform() - 1.5;  // variance 1/4
    n = static_cast<std::int8_t>(
        std::lround(std::clamp(options.noise * 1.26 * (fresh + 0.5 * neighbour), -127.0, 127.0)));
    neighbour = fresh;
  }
}

float ColorSensor::brightness(const Vec3f& p, const Vec3f& n) const {
  float light = 0.30f;
  for (const Vec3f& lamp : options_.lamps) {
    const Vec3f d = lamp - p;
    const float r2 = dot(d, d);
    light += 2.4f * std::max(0.0f, dot(n, d)) / ((r2 + 0.5f) * std::sqrt(r2));
  }
  return light * static_cast<float>(options_.exposure);
}

std::uint8_t ColorSensor::tone(float light) const {
  return tones_[static_cast<std::size_t>(std::clamp(static_cast<int>(light * kTones), 0, kTones - 1))];
}

Rect ColorSensor::draw(const Mesh& mesh, const Pose& T, std::vector<float>& inverse_z,
                       std::vector<std::uint32_t>& picture) {
  const float pixel = 1 / twice_.fx;
  return rasteriser_.draw(
      mesh, T, twice_, inverse_z.data(), [&](const Vec3f& p, const Vec3f& n) { return brightness(p, n); },
      [&](const Fragment& f) {
        Paint p = f.material->paint;
        if (f.material->texture) {
          const std::uint32_t t =
              f.material->texture->at(f.s, f.t, pixel / (f.inverse_z * (std::sqrt(f.cos_view) + 0.05f)));
          p.r *= static_cast<float>(t & 255) * (1.0f / 255);
          p.g *= static_cast<float>((t >> 8) & 255) * (1.0f / 255);
          p.b *= static_cast<float>((t >> 16) & 255) * (1.0f / 255);
        }
        const auto byte = [&](float x) { return static_cast<std::uint32_t>(tone(x * f.light)); };
        picture[static_cast<std::size_t>(f.v * twice_.width + f.u)] =
            byte(p.r) | byte(p.g) << 8 | byte(p.b) << 16;
      });
}

void ColorSensor::draw_still(const Mesh& mesh, const Pose& T_camera_mesh) {
  draw(mesh, T_camera_mesh, still_inverse_z_, still_picture_);
}

void ColorSensor::seal_still() {
  inverse_z_ = still_inverse_z_;
  picture_ = still_picture_;
  develop_rect({0, 0, width_, height_}, still_picture_, still_rgb_);
  rgb_ = still_rgb_;
}

void ColorSensor::begin_frame() {
  for (const Rect& r : dirty_) {
    const auto n = static_cast<std::size_t>(r.width());
    for (int v = r.v0; v < r.v1; ++v) {
      const auto at = static_cast<std::size_t>(v * twice_.width + r.u0);
      std::copy_n(&still_inverse_z_[at], n, &inverse_z_[at]);
      std::copy_n(&still_picture_[at], n, &picture_[at]);
    }
    const Rect small = Rect{r.u0 / 2 - 1, r.v0 / 2 - 1, r.u1 / 2 + 2, r.v1 / 2 + 2}.clipped(width_, height_);
    for (int v = small.v0; v < small.v1; ++v) {
      const auto at = static_cast<std::size_t>(3 * (v * width_ + small.u0));
      std::copy_n(&still_rgb_[at], static_cast<std::size_t>(3 * small.width()), &rgb_[at]);
    }
  }
  dirty_.clear();
}

void ColorSensor::mark(Rect twice) {
  const Rect r = twice.clipped(twice_.width, twice_.height);
  if (!r.empty()) dirty_.push_back(r);
}

void ColorSensor::cast_shadow(const Pose& T_camera_room, const Vec3& where, double radius_m,
                              double strength) {
  const double reach = 1.5 * radius_m;
  Rect box = Rect::nothing();
  for (int k = 0; k < 16; ++k) {
    const SinCos sc = sin_cos(k * kPi / 8);
    const Vec3 p = T_camera_room * Vec3{where.x + 1.03 * reach * sc.cos, where.y + 1.03 * reach * sc.sin, 0};
    if (p.z < 0.2) return;
    box.include(static_cast<int>(std::clamp(twice_.fx * p.x / p.z + twice_.cx, -9999.0, 9999.0)),
                static_cast<int>(std::clamp(twice_.fy * p.y / p.z + twice_.cy, -9999.0, 9999.0)));
  }
  box = box.clipped(twice_.width, twice_.height);
  // On the floor n.p = distance, so 1/z is linear in the pixel.
  const Vec3f n = to_float(T_camera_room.R.col(2));
  const float distance = static_cast<float>(dot(T_camera_room.R.col(2), T_camera_room.t));
  const Vec3f middle = to_float(T_camera_room * Vec3{where.x, where.y, 0});
  for (int v = box.v0; v < box.v1; ++v)
    for (int u = box.u0; u < box.u1; ++u) {
      const Vec3f ray{(static_cast<float>(u) - twice_.cx) / twice_.fx,
                      (static_cast<float>(v) - twice_.cy) / twice_.fy, 1};
      const float floor_inverse = dot(n, ray) / distance;
      const auto at = static_cast<std::size_t>(v * twice_.width + u);
      if (floor_inverse <= 0 || std::fabs(inverse_z_[at] - floor_inverse) > 0.004f) continue;
      const Vec3f off = ray * (1 / floor_inverse) - middle;
      const float r = std::sqrt(dot(off, off)) / static_cast<float>(radius_m);
      if (r > 1.5f) continue;
      const float fade = r < 0.9f ? 1.0f : (1.5f - r) / 0.6f;
      picture_[at] =
          scaled(picture_[at],
                 static_cast<std::uint32_t>(256.0f * (1 - static_cast<float>(strength) * fade * fade)));
    }
  mark(box);
}

void ColorSensor::draw_moving(const Mesh& mesh, const Pose& T_camera_mesh) {
  mark(draw(mesh, T_camera_mesh, inverse_z_, picture_));
}

void ColorSensor::develop() {
  for (const Rect& r : dirty_)
    develop_rect(Rect{r.u0 / 2 - 1, r.v0 / 2 - 1, r.u1 / 2 + 2, r.v1 / 2 + 2}.clipped(width_, height_),
                 picture_, rgb_);
}

// Weights 1 3 3 1 in both directions, then the lens's fall-off.
void ColorSensor::develop_rect(Rect rect, const std::vector<std::uint32_t>& picture,
                               std::vector<std::uint8_t>& rgb) const {
  static constexpr std::uint32_t kWeight[4] = {1, 3, 3, 1};
  for (int v = rect.v0; v < rect.v1; ++v)
    for (int u = rect.u0; u < rect.u1; ++u) {
      std::uint32_t rb[2]{}, g = 0;  // sums of 64 times 255 fit 16 bits
      for (int j = 0; j < 4; ++j) {
        const std::uint32_t* row = &picture[static_cast<std::size_t>(
            std::clamp(2 * v - 1 + j, 0, twice_.height - 1) * twice_.width)];
        for (int i = 0; i < 4; ++i) {
          const std::uint32_t p = row[std::clamp(2 * u - 1 + i, 0, twice_.width - 1)],
                              w = kWeight[i] * kWeight[j];
          rb[0] += (p & 255) * w;
          g += ((p >> 8) & 255) * w;
          rb[1] += ((p >> 16) & 255) * w;
        }
      }
      const auto at = static_cast<std::size_t>(v * width_ + u);
      const std::uint32_t fall = vignette_[at];
      rgb[3 * at] = static_cast<std::uint8_t>(rb[0] * fall >> 14);
      rgb[3 * at + 1] = static_cast<std::uint8_t>(g * fall >> 14);
      rgb[3 * at + 2] = static_cast<std::uint8_t>(rb[1] * fall >> 14);
    }
}

void ColorSensor::sample(std::uint64_t frame_seed, double gain, std::uint8_t* rgb) const {
  Random random(options_.seed ^ mix64(frame_seed), 0xca3e);
  const int stride = 3 * (width_ + kNoiseMargin);
  const auto offset = [&] {
    const int u = random.below(kNoiseMargin), v = random.below(kNoiseMargin);
    return static_cast<std::size_t>(v * stride + 3 * u);
  };
  const std::size_t a = offset(), b = offset();
  const auto level = static_cast<std::uint16_t>(std::clamp(std::lround(gain * 128), 0L, 255L));
  for (int v = 0; v < height_; ++v) {
    const std::int8_t *na = &noise_[static_cast<std::size_t>(v * stride) + a],
                      *nb = &noise_[static_cast<std::size_t>(v * stride) + b];
    const std::uint8_t* in = &rgb_[static_cast<std::size_t>(3 * v * width_)];
    std::uint8_t* out = rgb + static_cast<std::ptrdiff_t>(3 * v) * width_;
    for (int k = 0; k < 3 * width_; ++k) {
      // Sixteen bits suffice (level is below 256), and eight pixels go at a time.
      const auto lit = static_cast<std::int16_t>(static_cast<std::uint16_t>(in[k] * level) >> 7);
      const auto noisy = static_cast<std::int16_t>(lit + na[k] + nb[k]);
      out[k] = static_cast<std::uint8_t>(std::clamp<std::int16_t>(noisy, 0, 255));
    }
  }
}

}  // namespace st::sim
