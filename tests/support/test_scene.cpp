#include "tests/support/test_scene.hpp"

#include <algorithm>
#include <cmath>

namespace st::test {
namespace {

constexpr double kBaseline_m = 0.075;
constexpr double kNothing = 1e9;

double uniform(std::uint32_t& state) {
  state = state * 1664525u + 1013904223u;
  return (state >> 8) / 16777216.0;
}

// Sums of twelve uniforms: close enough to a Gaussian, and bounded. Drawn from a fixed table, to be quick.
double gauss(std::uint32_t& state) {
  static const std::vector<double> table = [] {
    std::vector<double> t(65536, -6.0);
    std::uint32_t seed = 1;
    for (double& sum : t)
      for (int i = 0; i < 12; ++i) sum += uniform(seed);
    return t;
  }();
  return table[static_cast<std::size_t>(uniform(state) * 65536.0)];
}

struct Hit {
  double along = kNothing;
  std::uint8_t label = 0;
};

// Slab test in the box's own axes.
double hit_box(const SceneBox& box, const Vec3& from, const Vec3& ray) {
  const double c = box.yaw == 0 ? 1 : std::cos(box.yaw), s = box.yaw == 0 ? 0 : std::sin(box.yaw);
  const Vec3 o{c * (from.x - box.x) + s * (from.y - box.y), -s * (from.x - box.x) + c * (from.y - box.y),
               from.z - box.z};
  const Vec3 d{c * ray.x + s * ray.y, -s * ray.x + c * ray.y, ray.z};
  const Vec3 low{-box.width / 2, -box.depth / 2, 0}, high{box.width / 2, box.depth / 2, box.height};
  double first = 0, last = kNothing;
  for (int i = 0; i < 3; ++i) {
    if (std::fabs(d[i]) < 1e-12) {
      if (o[i] < low[i] || o[i] > high[i]) return kNothing;
      continue;
    }
    const double a = (low[i] - o[i]) / d[i], b = (high[i] - o[i]) / d[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first < last && first > 1e-6 ? first : kNothing;
}

Hit cast(const TestScene& scene, const Vec3& from, const Vec3& ray) {
  Hit hit;
  if (scene.floor && ray.z < 0) hit.along = -from.z / ray.z;
  if (ray.y > 0) hit.along = std::min(hit.along, (scene.wall_y - from.y) / ray.y);
  for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
    const double along = hit_box(scene.boxes[i], from, ray);
    if (along < hit.along) hit = {along, static_cast<std::uint8_t>(i + 1)};
  }
  return hit;
}

}  // namespace

Calibration kinect_calibration(int width, int height) {
  Calibration c;
  c.depth.width = width;
  c.depth.height = height;
  c.depth.fx = c.depth.fy = 575.8 * width / 640.0;
  c.depth.cx = width / 2.0;
  c.depth.cy = height / 2.0;
  return c;
}

void SceneCamera::trace(const TestScene& scene) {
  const Intrinsics& k = calibration_.depth;
  scene_ = scene;
  disparity_.assign(static_cast<std::size_t>(k.width * k.height), -1);
  out_.mask.assign(disparity_.size(), 0);
  out_.raw.assign(disparity_.size(), 2047);
  const double c = std::cos(scene.pitch_rad), s = std::sin(scene.pitch_rad);
  const Vec3 right{1, 0, 0}, down{0, -s, -c}, ahead{0, c, -s}, eye{0, 0, scene.camera_height};
  const Vec3 projector = eye - right * kBaseline_m;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const Vec3 ray = ahead + right * ((u - k.cx) / k.fx) + down * ((v - k.cy) / k.fy);  // along = z
      const Hit hit = cast(scene, eye, ray);
      if (hit.along >= kNothing) continue;
      const auto pixel = static_cast<std::size_t>(v * k.width + u);
      out_.mask[pixel] = hit.label;
      const Vec3 point = eye + ray * hit.along;
      if (cast(scene, projector, point - projector).along < 0.99)
        continue;  // the projector does not reach it
      disparity_[pixel] = calibration_.raw_b - calibration_.raw_a / hit.along;
    }
  }
}

const RenderedScene& SceneCamera::render(const TestScene& scene) {
  if (disparity_.empty() || !(scene == scene_)) trace(scene);
  for (std::size_t i = 0; i < disparity_.size(); ++i) {
    const double raw = std::floor(disparity_[i] + scene.noise_raw * gauss(random_) + 0.5);
    out_.raw[i] =
        disparity_[i] >= 0 && raw >= 0 && raw < 1055 ? static_cast<std::uint16_t>(raw) : std::uint16_t{2047};
  }
  return out_;
}

}  // namespace st::test
