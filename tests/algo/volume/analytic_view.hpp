// Shapes with known surfaces, seen by an ideal or a noisy depth camera: the truth that the volume is held
// against.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "algo/core/pinhole.hpp"
#include "algo/core/pose.hpp"
#include "algo/volume/integrate.hpp"
#include "algo/volume/raycast.hpp"

namespace st::test {

// A convex solid about the origin of its frame: where a ray enters it, the outward normal there, and the
// signed distance.
struct Solid {
  virtual ~Solid() = default;
  virtual double enter(const Vec3& from,
                       const Vec3& along) const = 0;  // parameter along the ray; < 0: missed
  virtual Vec3 normal(const Vec3& at) const = 0;
  virtual double distance(const Vec3& p) const = 0;
};

struct Sphere : Solid {
  explicit Sphere(double radius) : r(radius) {}
  double r;
  double enter(const Vec3& o, const Vec3& d) const override {
    const double a = dot(d, d), b = dot(o, d), c = dot(o, o) - r * r, q = b * b - a * c;
    return q < 0 ? -1.0 : (-b - std::sqrt(q)) / a;
  }
  Vec3 normal(const Vec3& at) const override { return normalized(at); }
  double distance(const Vec3& p) const override { return norm(p) - r; }
};

struct Box : Solid {
  explicit Box(const Vec3& half_sides) : h(half_sides) {}
  Vec3 h;
  double enter(const Vec3& o, const Vec3& d) const override {
    double t0 = -1e9, t1 = 1e9;
    for (int i = 0; i < 3; ++i) {
      const double a = (-h[i] - o[i]) / d[i], b = (h[i] - o[i]) / d[i];
      t0 = std::fmax(t0, std::fmin(a, b));
      t1 = std::fmin(t1, std::fmax(a, b));
    }
    return t0 <= t1 ? t0 : -1.0;
  }
  Vec3 normal(const Vec3& p) const override {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (std::fabs(p[i]) - h[i] > std::fabs(p[axis]) - h[axis]) axis = i;
    Vec3 n{};
    n[axis] = p[axis] > 0 ? 1 : -1;
    return n;
  }
  double distance(const Vec3& p) const override {
    Vec3 outside{};
    double inside = -1e9;
    for (int i = 0; i < 3; ++i) {
      const double q = std::fabs(p[i]) - h[i];
      outside[i] = std::fmax(q, 0.0);
      inside = std::fmax(inside, q);
    }
    return norm(outside) + std::fmin(inside, 0.0);
  }
};

// A cylinder about z: the shape of a floor robot.
struct Disc : Solid {
  Disc(double radius, double half_height) : r(radius), h(half_height) {}
  double r, h;
  double enter(const Vec3& o, const Vec3& d) const override {
    const double a = d.x * d.x + d.y * d.y, b = o.x * d.x + o.y * d.y, c = o.x * o.x + o.y * o.y - r * r;
    const double q = b * b - a * c;
    if (q < 0) return -1.0;
    const double z0 = (-h - o.z) / d.z, z1 = (h - o.z) / d.z;
    const double t0 = std::fmax((-b - std::sqrt(q)) / a, std::fmin(z0, z1));
    const double t1 = std::fmin((-b + std::sqrt(q)) / a, std::fmax(z0, z1));
    return t0 <= t1 ? t0 : -1.0;
  }
  Vec3 normal(const Vec3& p) const override {
    const double radial = std::sqrt(p.x * p.x + p.y * p.y);
    return radial - r > std::fabs(p.z) - h ? normalized(Vec3{p.x, p.y, 0}) : Vec3{0, 0, p.z > 0 ? 1.0 : -1.0};
  }
  double distance(const Vec3& p) const override {
    const double a = std::sqrt(p.x * p.x + p.y * p.y) - r, b = std::fabs(p.z) - h;
    const double u = std::fmax(a, 0.0), v = std::fmax(b, 0.0);
    return std::sqrt(u * u + v * v) + std::fmin(std::fmax(a, b), 0.0);
  }
};

using Paint = std::function<std::uint32_t(const Vec3&)>;  // object frame to pack_rgb

// One frame: the solid before a wall that faces the camera.
struct View {
  Pinhole camera{575.8f, 575.8f, 319.5f, 239.5f, 640, 480};
  std::vector<float> depth;
  std::vector<std::uint8_t> owners;
  std::vector<std::uint32_t> color;
  Rect roi = Rect::nothing();  // of the solid, grown by a margin
  Pose T_camera_object;

  EvidenceInput input() const {
    EvidenceInput in;
    in.camera = camera;
    in.roi = roi;
    in.depth_m = {depth.data(), camera.width, camera.height};
    in.owners = {owners.data(), camera.width, camera.height};
    if (!color.empty()) in.color = {color.data(), camera.width, camera.height};
    return in;
  }
};

struct Rendering {
  double wall_m = 2.5;
  double noise = 0;  // share of the noise model's sigma
  int margin_px = 8;
  Paint paint;  // no colour when empty
};

inline double gaussian(std::mt19937& random) {  // sum of twelve uniforms: the same on every standard library
  double s = -6;
  for (int i = 0; i < 12; ++i) s += static_cast<double>(random()) / 4294967296.0;
  return s;
}

inline View render(const Solid& solid, const Pose& T_camera_object, const Rendering& how,
                   std::mt19937& random, const Pinhole& camera = View{}.camera) {
  View view;
  view.camera = camera;
  view.T_camera_object = T_camera_object;
  const std::size_t n = static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  view.depth.assign(n, 0);
  view.owners.assign(n, 0);
  if (how.paint) view.color.assign(n, 0);
  const Pose back = T_camera_object.inverse();
  const NoiseWeights noise;
  std::size_t i = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u, ++i) {
      const Vec3 ray = to_double(camera.ray(static_cast<float>(u), static_cast<float>(v)));
      const Vec3 along = back.R * ray;
      double z = solid.enter(back.t, along);
      const bool hit = z > 0;
      if (!hit) z = how.wall_m;
      if (hit) {
        view.owners[i] = 1;
        view.roi.include(u, v);
        if (how.paint) view.color[i] = how.paint(back.t + along * z);
      }
      const double sigma = static_cast<double>(sigma_z_m(noise, static_cast<float>(z)));
      view.depth[i] = static_cast<float>(how.noise > 0 ? z + how.noise * sigma * gaussian(random) : z);
    }
  view.roi = view.roi.grown(how.margin_px).clipped(camera.width, camera.height);
  return view;
}

// The object `distance_m` before the camera, turned by yaw about its z axis (which points up), seen from
// above at `pitch`.
inline Pose looking_at(double distance_m, double yaw_rad, double pitch_rad) {
  // Object z up is camera -y; looking down tilts it towards the camera.
  const Mat3 upright{{1, 0, 0, 0, 0, -1, 0, 1, 0}};
  return {rotation_from_vector({pitch_rad, 0, 0}) * upright * rotation_z(yaw_rad), {0, 0, distance_m}};
}

// Volume, scratch and images on one piece of memory.
struct Bench {
  explicit Bench(int side, int width = 640, int height = 480) {
    Bump measure;
    bind(measure, side, width, height);
    memory.resize(measure.used() + Bump::kAlign);
    void* start = memory.data();
    std::size_t room = memory.size();
    std::align(Bump::kAlign, measure.used(), start, room);
    Bump real(start, room);
    bind(real, side, width, height);
  }
  void bind(Bump& bump, int side, int width, int height) {
    volume.bind(bump, side);
    integrating.bind(bump, width, height, side);
    raycasting.bind(bump, width, height);
    maps.bind(bump, width, height);
  }
  IntegrateStats fuse(const View& view, const IntegrateOptions& options = {}) {
    return integrate(volume, view.input(), view.T_camera_object, options, integrating);
  }
  std::vector<std::uint8_t> memory;
  Volume volume;
  IntegrateScratch integrating;
  RaycastScratch raycasting;
  ModelMaps maps;
};

}  // namespace st::test
