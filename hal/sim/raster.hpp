// Draws triangles into an inverse-depth buffer. Inverse depth is what both a pinhole and a disparity sensor
// see linearly, so planes stay exact.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "algo/core/image.hpp"
#include "algo/core/pose.hpp"
#include "hal/sim/surface.hpp"

namespace st::sim {

struct Pinhole {
  float fx = 575.8f, fy = 575.8f, cx = 320, cy = 240;
  int width = 640, height = 480;
};

// What a pixel is told about the surface it shows.
struct Fragment {
  int u = 0, v = 0;
  float inverse_z = 0;  // 1/m
  float light = 0;      // whatever the pass's lighting said at the vertices, interpolated
  float s = 0, t = 0;   // metres on the texture
  float cos_view = 1;   // between the face's normal and the way back to the camera
  const Material* material = nullptr;
};

// Where the triangles of one mesh fall in one picture. Keeps its memory between calls.
class Rasteriser {
 public:
  // Draws `mesh` at T_camera_mesh. `light(position, normal)` in camera coordinates is asked once a vertex.
  // `shade(fragment)` is called where the fragment is nearer than `inverse_z` (width * height, zero:
  // nothing), which is updated. Returns the rectangle that may have changed. Triangles that face away are
  // left out.
  template <class Light, class Shade>
  Rect draw(const Mesh& mesh, const Pose& T_camera_mesh, const Pinhole& camera, float* inverse_z,
            const Light& light, const Shade& shade) {
    const PoseF T = to_float(T_camera_mesh);
    placed_.resize(mesh.vertices.size());
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      const Vertex& v = mesh.vertices[i];
      const Vec3f p = T * v.position;
      placed_[i] = {p, light(p, T.R * v.normal), v.u, v.v};
    }
    Rect touched = Rect::nothing();
    for (const Face& f : mesh.faces) {
      const Corner corner[3] = {placed_[f.a], placed_[f.b], placed_[f.c]};
      const Vec3f n = cross(corner[1].p - corner[0].p, corner[2].p - corner[0].p);
      const Vec3f middle = (corner[0].p + corner[1].p + corner[2].p) * (1.0f / 3);
      const float facing = -dot(n, middle);
      if (facing <= 0) continue;
      const float cos_view = facing / std::sqrt(dot(n, n) * dot(middle, middle) + 1e-20f);
      Corner clipped[4];
      const int count = clip_near(corner, clipped);
      for (int k = 2; k < count; ++k)
        fill({clipped[0], clipped[k - 1], clipped[k]}, camera, cos_view, &mesh.materials[f.material],
             inverse_z, touched, shade);
    }
    return touched;
  }

 private:
  struct Corner {
    Vec3f p;
    float light, s, t;
  };
  struct Triangle {
    Corner a, b, c;
  };
  // a + (u - u0) du + (v - v0) dv
  struct Plane {
    float at0, du, dv;
  };

  static constexpr float kNear_m = 0.05f;

  static Corner between(const Corner& a, const Corner& b) {
    const float w = (kNear_m - a.p.z) / (b.p.z - a.p.z);
    return {a.p + (b.p - a.p) * w, a.light + (b.light - a.light) * w, a.s + (b.s - a.s) * w,
            a.t + (b.t - a.t) * w};
  }
  static int clip_near(const Corner in[3], Corner out[4]) {
    int n = 0;
    for (int i = 0; i < 3; ++i) {
      const Corner &a = in[i], &b = in[(i + 1) % 3];
      if (a.p.z >= kNear_m) out[n++] = a;
      if ((a.p.z >= kNear_m) != (b.p.z >= kNear_m)) out[n++] = between(a, b);
    }
    return n;
  }

  template <class Shade>
  void fill(const Triangle& t, const Pinhole& camera, float cos_view, const Material* material,
            float* inverse_z, Rect& touched, const Shade& shade) {
    const Corner* corner[3] = {&t.a, &t.b, &t.c};
    float x[3], y[3], iz[3];
    for (int i = 0; i < 3; ++i) {
      iz[i] = 1 / corner[i]->p.z;
      x[i] = camera.fx * corner[i]->p.x * iz[i] + camera.cx;
      y[i] = camera.fy * corner[i]->p.y * iz[i] + camera.cy;
    }
    const float area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
    if (std::fabs(area) < 1e-6f) return;
    const float low_x = std::min({x[0], x[1], x[2]}), high_x = std::max({x[0], x[1], x[2]});
    const float low_y = std::min({y[0], y[1], y[2]}), high_y = std::max({y[0], y[1], y[2]});
    if (high_x < 0 || high_y < 0 || low_x > static_cast<float>(camera.width) ||
        low_y > static_cast<float>(camera.height))
      return;
    const Rect box =
        Rect{static_cast<int>(std::ceil(std::max(low_x, 0.0f))),
             static_cast<int>(std::ceil(std::max(low_y, 0.0f))),
             static_cast<int>(std::min(high_x, 4096.0f)) + 1, static_cast<int>(std::min(high_y, 4096.0f)) + 1}
            .clipped(camera.width, camera.height);
    if (box.empty()) return;
    const auto plane = [&](float f0, float f1, float f2) {
      const float du = ((f1 - f0) * (y[2] - y[0]) - (f2 - f0) * (y[1] - y[0])) / area;
      const float dv = ((f2 - f0) * (x[1] - x[0]) - (f1 - f0) * (x[2] - x[0])) / area;
      return Plane{f0 - du * x[0] - dv * y[0], du, dv};
    };
    const Plane pz = plane(iz[0], iz[1], iz[2]);
    const Plane pl = plane(t.a.light * iz[0], t.b.light * iz[1], t.c.light * iz[2]);
    const Plane ps = plane(t.a.s * iz[0], t.b.s * iz[1], t.c.s * iz[2]);
    const Plane pt = plane(t.a.t * iz[0], t.b.t * iz[1], t.c.t * iz[2]);
    const Plane weight[3] = {plane(1, 0, 0), plane(0, 1, 0), plane(0, 0, 1)};
    bool any = false;
    for (int v = box.v0; v < box.v1; ++v) {
      const float fv = static_cast<float>(v);
      // Where the row is inside all three edges.
      float from = static_cast<float>(box.u0), to = static_cast<float>(box.u1 - 1);
      for (const Plane& w : weight) {
        const float at = w.at0 + w.dv * fv;
        if (std::fabs(w.du) < 1e-12f) {
          if (at < 0) to = from - 1;
        } else if (w.du > 0) {
          from = std::max(from, -at / w.du);
        } else {
          to = std::min(to, -at / w.du);
        }
      }
      const int last = static_cast<int>(std::floor(to));
      for (int u = static_cast<int>(std::ceil(from)); u <= last; ++u) {
        const float fu = static_cast<float>(u);
        const float inv = pz.at0 + pz.du * fu + pz.dv * fv;
        float& stored = inverse_z[v * camera.width + u];
        if (inv <= stored) continue;
        stored = inv;
        const float z = 1 / inv;
        shade(Fragment{u, v, inv, (pl.at0 + pl.du * fu + pl.dv * fv) * z,
                       (ps.at0 + ps.du * fu + ps.dv * fv) * z, (pt.at0 + pt.du * fu + pt.dv * fv) * z,
                       cos_view, material});
        any = true;
      }
    }
    if (any) {
      touched.include(box.u0, box.v0);
      touched.include(box.u1 - 1, box.v1 - 1);
    }
  }

  std::vector<Corner> placed_;
};

}  // namespace st::sim
