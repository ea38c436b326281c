#include "algo/recognition/patch_check.hpp"

#include <cmath>

namespace st {
namespace {

constexpr float kPatch_m = 0.03f;

struct Rgb {
  float c[3]{};
  void add(std::uint32_t color) {
    c[0] += static_cast<float>(red_of(color));
    c[1] += static_cast<float>(green_of(color));
    c[2] += static_cast<float>(blue_of(color));
  }
};

struct Patch {
  int same = 0, off = 0, colored = 0;
  Rgb model, seen;  // sums over the coloured pixels
};

class Checker {
 public:
  explicit Checker(const PatchInput& in)
      : in_(in), T_object_camera_(to_float(in.view->T_camera_object.inverse())) {
    const float z_m = static_cast<float>(in.view->T_camera_object.t.z);
    const int side = static_cast<int>(kPatch_m * in.camera.fx / (z_m > 0.1f ? z_m : 0.1f));
    side_ = side < 6 ? 6 : side;
  }

  int side() const { return side_; }
  int least_pixels() const { return side_ * side_ / 2; }

  Patch look(int u0, int v0) const {
    Patch patch;
    const Rect box = Rect{u0, v0, u0 + side_, v0 + side_}.clipped(in_.depth_z.width, in_.depth_z.height);
    for (int v = box.v0; v < box.v1; ++v)
      for (int u = box.u0; u < box.u1; ++u) look_at(u, v, patch);
    return patch;
  }

 private:
  float height(int u, int v, float z) const {
    return (T_object_camera_ * (in_.camera.ray(static_cast<float>(u), static_cast<float>(v)) * z)).z;
  }
  void look_at(int u, int v, Patch& patch) const {
    const float model = in_.view->z(u, v), seen = in_.depth_z(u, v);
    const bool own = in_.owners(u, v) == in_.owner;
    if (!(seen > 0)) return;
    if (!(model > 0)) {
      patch.off += own && height(u, v, seen) > in_.skirt_z_m ? 1 : 0;
      return;
    }
    if (height(u, v, model) < in_.skirt_z_m) return;
    const float reach = 0.012f + 2 * depth_sigma_m(model);
    if (seen < model - reach && !own) return;  // something else stands before it
    if (std::fabs(seen - model) > reach) {
      ++patch.off;
      return;
    }
    ++patch.same;
    if (!own || in_.color.data == nullptr) return;
    const std::uint32_t a = in_.view->maps.color[in_.view->maps.at(u, v)], b = in_.color(u, v);
    if (alpha_of(a) == 0 || alpha_of(b) == 0) return;
    patch.model.add(a);
    patch.seen.add(b);
    ++patch.colored;
  }

  const PatchInput& in_;
  PoseF T_object_camera_;
  int side_;
};

// How much brighter the frame is than the model was.
struct Gain {
  double ab = 0, aa = 0;
  void add(const Patch& p) {
    for (int i = 0; i < 3; ++i) {
      const double a = static_cast<double>(p.model.c[i]), b = static_cast<double>(p.seen.c[i]);
      ab += a * b / p.colored;
      aa += a * a / p.colored;
    }
  }
  float value() const { return aa > 0 ? static_cast<float>(ab / aa) : 1.0f; }
};

// Largest of the three channels' differences, grey levels.
float difference(const Patch& p, float gain) {
  float most = 0;
  for (int i = 0; i < 3; ++i) {
    const float d = std::fabs(gain * p.model.c[i] - p.seen.c[i]) / static_cast<float>(p.colored);
    most = d > most ? d : most;
  }
  return most;
}

}  // namespace

PatchCheck check_patches(const PatchInput& in) {
  constexpr float kMostDifference = 40;  // grey levels
  const Checker checker(in);
  PatchCheck check;
  const Rect& roi = in.view->maps.roi;
  Gain gain;
  for (const bool second : {false, true}) {
    for (int v = roi.v0; v < roi.v1; v += checker.side()) {
      for (int u = roi.u0; u < roi.u1; u += checker.side()) {
        const Patch patch = checker.look(u, v);
        const bool colored = patch.colored >= checker.least_pixels();
        if (!second) {
          if (colored) gain.add(patch);
          if (patch.same + patch.off < checker.least_pixels()) continue;
          ++check.shape;
          check.shape_off += patch.off > patch.same ? 1 : 0;
        } else if (colored) {
          ++check.print;
          check.print_off += difference(patch, gain.value()) > kMostDifference ? 1 : 0;
        }
      }
    }
  }
  return check;
}

bool PatchCheck::refutes(const PatchCheck& other) const {
  return other.shape_off + other.print_off >= 2 + 2 * (shape_off + print_off);
}

bool PatchCheck::agrees() const {
  constexpr int kLeastPatches = 6;  // fewer show nothing
  return shape >= kLeastPatches && 20 * shape_off <= shape && 20 * print_off <= print;
}

}  // namespace st
