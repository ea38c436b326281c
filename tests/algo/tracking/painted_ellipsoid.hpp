// A painted ellipsoid before a wall, with exact depth, normal and luminance at any pose: truth for the
// alignment that shares no code with it.
#pragma once

#include <cmath>
#include <vector>

#include "algo/core/pinhole.hpp"
#include "algo/core/pose.hpp"
#include "algo/tracking/model_view.hpp"
#include "algo/volume/voxel.hpp"
#include "tests/algo/tracking/seen_colors.hpp"

namespace st::test {

struct PaintedEllipsoid {
  Vec3 half_axes{0.16, 0.11, 0.07};
  double wall_m = 2.6;
  Pinhole camera{300, 300, 159.5, 119.5, 320, 240};

  // Depth along the pixel's ray; 0 where it misses.
  double depth(const Pose& T_camera_object, double u, double v, Vec3* on_object = nullptr) const {
    const Pose inverse = T_camera_object.inverse();
    const Vec3 ray{(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1};
    const Vec3 o = scaled(inverse.t), d = scaled(inverse.R * ray);
    const double a = dot(d, d), b = dot(o, d), c = dot(o, o) - 1;
    const double root = b * b - a * c;
    if (root <= 0) return 0;
    const double z = (-b - std::sqrt(root)) / a;
    if (on_object != nullptr) *on_object = inverse * (ray * z);
    return z;
  }
  Vec3 scaled(const Vec3& p) const { return {p.x / half_axes.x, p.y / half_axes.y, p.z / half_axes.z}; }
  Vec3 normal(const Vec3& on_object) const {
    const Vec3 s = scaled(on_object);
    return normalized(scaled(s));
  }
  static double luminance(const Vec3& p) {
    return 120 + 50 * std::sin(55 * p.x + 0.4) + 45 * std::cos(60 * p.y - 20 * p.z);
  }
};

// The model's view of it, in memory of its own.
struct PaintedView {
  std::vector<float> z;
  std::vector<std::uint32_t> normal, color;
  std::vector<std::uint8_t> weight;
  ModelView view;

  PaintedView(const PaintedEllipsoid& thing, const Pose& T, const Rect& roi) {
    const std::size_t n = static_cast<std::size_t>(roi.width()) * static_cast<std::size_t>(roi.height());
    z.resize(n), normal.resize(n), color.resize(n), weight.resize(n);
    view.T_camera_object = T;
    view.maps.roi = roi;
    view.maps.stride = roi.width();
    view.maps.z = z;
    view.maps.normal = normal;
    view.maps.color = color;
    view.maps.weight = weight;
    for (int v = roi.v0; v < roi.v1; ++v) {
      for (int u = roi.u0; u < roi.u1; ++u) {
        Vec3 p;
        const std::size_t at = view.maps.at(u, v);
        z[at] = static_cast<float>(thing.depth(T, u, v, &p));
        if (!(z[at] > 0)) continue;
        normal[at] = packed(T.R * thing.normal(p));
        const auto grey = static_cast<std::uint8_t>(PaintedEllipsoid::luminance(p) + 0.5);
        color[at] = pack_rgb(grey, grey, grey);
      }
    }
  }
  static std::uint32_t packed(const Vec3& n) {
    const auto half = [](double x) {
      return static_cast<std::uint32_t>(static_cast<std::uint16_t>(static_cast<std::int16_t>(x * 32767.0)));
    };
    return half(n.x) | half(n.y) << 16;
  }
};

// What a colour camera in the depth camera's place sees of it, before a grey wall.
inline double painted_grey(const PaintedEllipsoid& thing, const Pose& T, int u, int v) {
  Vec3 p;
  return thing.depth(T, u, v, &p) > 0 ? PaintedEllipsoid::luminance(p) : 128.0;
}

// A frame of it before the wall, and its pixels.
struct PaintedFrame {
  std::vector<float> z;
  std::vector<ObservedPoint> points;
  ImageView<const float> depth_z;
  SeenColors colors;

  PaintedFrame(const PaintedEllipsoid& thing, const Pose& T)
      : colors(thing.camera, [&](int u, int v) { return painted_grey(thing, T, u, v); }) {
    const int width = thing.camera.width, height = thing.camera.height;
    z.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    depth_z = {z.data(), width, height};
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        Vec3 p;
        const double d = thing.depth(T, u, v, &p);
        z[static_cast<std::size_t>(v * width + u)] = static_cast<float>(d > 0 ? d : thing.wall_m);
        if (!(d > 0)) continue;
        ObservedPoint point;
        point.p = to_float(T * p);
        point.u = static_cast<std::uint16_t>(u);
        point.v = static_cast<std::uint16_t>(v);
        points.push_back(point);
      }
    }
  }
};

}  // namespace st::test
