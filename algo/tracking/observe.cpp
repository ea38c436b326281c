#include "algo/tracking/observe.hpp"

#include <cmath>

#include "algo/depth/edge_step.hpp"

namespace st {

namespace {

// The matching window is about nine pixels of a 640-pixel image wide, and pulls what is near over its edge by
// half that.
class EdgeProbe {
 public:
  explicit EdgeProbe(int width) {
    const int reach = (4 * width + 320) / 640, diagonal = (3 * reach + 2) / 4;
    const int steps[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    for (int i = 0; i < 8; ++i)
      for (int a = 0; a < 2; ++a) around_[i][a] = steps[i][a] * (i < 4 ? reach : diagonal);
  }
  bool is_edge(ImageView<const float> depth_z, int u, int v) const {
    const float z = depth_z(u, v), step = edge_step_m(z);
    for (const auto& a : around_) {
      if (!depth_z.contains(u + a[0], v + a[1])) continue;
      const float other = depth_z(u + a[0], v + a[1]);
      if (other > 0 && std::fabs(other - z) >= step) return true;
    }
    return false;
  }

 private:
  int around_[8][2];
};

}  // namespace

void mark_edges(ImageView<const float> depth_z, std::uint8_t owner, const Rect& roi,
                ImageView<std::uint8_t> owners) {
  const EdgeProbe probe(depth_z.width);
  const Rect box = roi.clipped(depth_z.width, depth_z.height);
  for (int v = box.v0; v < box.v1; ++v)
    for (int u = box.u0; u < box.u1; ++u)
      if (owners(u, v) == owner && probe.is_edge(depth_z, u, v)) owners(u, v) = kEdge;
}

int count_solid(ImageView<const float> depth_z, ImageView<const std::uint8_t> owners, std::uint8_t owner,
                ImageView<const std::uint8_t> labels, std::uint8_t label, const Rect& roi) {
  const EdgeProbe probe(depth_z.width);
  const Rect box = roi.clipped(depth_z.width, depth_z.height);
  int solid = 0;
  for (int v = box.v0; v < box.v1; ++v)
    for (int u = box.u0; u < box.u1; ++u)
      if (owners(u, v) == owner && labels(u, v) == label && depth_z(u, v) > 0)
        solid += probe.is_edge(depth_z, u, v) ? 0 : 1;
  return solid;
}

namespace {

// The pixels of `box` for which keep(u, v) holds, thinned evenly to the capacity of `out`.
template <typename Keep>
std::size_t gather(ImageView<const float> depth_z, const Rect& box, const Pinhole& camera,
                   std::span<ObservedPoint> out, const Keep& keep) {
  std::size_t candidates = 0;
  for (int v = box.v0; v < box.v1; ++v)
    for (int u = box.u0; u < box.u1; ++u) candidates += keep(u, v) ? 1 : 0;
  if (candidates == 0 || out.empty()) return 0;
  const std::size_t every = (candidates + out.size() - 1) / out.size();

  std::size_t seen = 0, used = 0;
  for (int v = box.v0; v < box.v1; ++v) {
    for (int u = box.u0; u < box.u1; ++u) {
      if (!keep(u, v) || seen++ % every != 0) continue;
      ObservedPoint& point = out[used++];
      point.p = camera.ray(static_cast<float>(u), static_cast<float>(v)) * depth_z(u, v);
      point.u = static_cast<std::uint16_t>(u);
      point.v = static_cast<std::uint16_t>(v);
    }
  }
  return used;
}

}  // namespace

std::size_t gather_points(ImageView<const float> depth_z, ImageView<const std::uint8_t> owners,
                          std::uint8_t owner, const Rect& roi, const Pinhole& camera,
                          std::span<ObservedPoint> out) {
  return gather(depth_z, roi.clipped(depth_z.width, depth_z.height), camera, out,
                [&](int u, int v) { return owners(u, v) == owner && depth_z(u, v) > 0; });
}

std::size_t gather_near_view(ImageView<const float> depth_z, ImageView<const std::uint8_t> owners,
                             std::uint8_t owner, const ModelView& view, const Pinhole& camera,
                             std::span<ObservedPoint> out) {
  constexpr float kNear_m = 0.08f;
  const int reach = depth_z.width / 80;
  const auto near_model = [&](int u, int v) {
    const int around[5][2] = {{0, 0}, {-reach, 0}, {reach, 0}, {0, -reach}, {0, reach}};
    for (const auto& o : around) {
      const float model = view.z(u + o[0], v + o[1]);
      if (model > 0 && std::fabs(depth_z(u, v) - model) < kNear_m) return true;
    }
    return false;
  };
  return gather(depth_z, view.maps.roi.grown(reach).clipped(depth_z.width, depth_z.height), camera, out,
                [&](int u, int v) { return owners(u, v) == owner && depth_z(u, v) > 0 && near_model(u, v); });
}

void ColorRegistration::configure(const Calibration& calibration) {
  if (calibration.color_registered) {
    color_ =
        calibration
            .depth;  // with its distortion: the depth frame is made ideal on the way in, the colour is not
    T_color_depth_ = PoseF{};
  } else {
    color_ = calibration.color;
    T_color_depth_ = to_float(calibration.T_color_depth);
  }
}

bool ColorRegistration::sample(const ColorImage& image, const PoseF& motion, const Vec3f& p,
                               float (&rgb)[3]) const {
  const Vec3f c = T_color_depth_ * (motion * p);
  if (!(c.z > 0.05f)) return false;
  return sample_pixel(image, static_cast<double>(c.x / c.z), static_cast<double>(c.y / c.z), rgb);
}

bool ColorRegistration::sample_pixel(const ColorImage& image, double x, double y, float (&rgb)[3]) const {
  if (color_.distorted()) {
    const Normalized d = distort(color_, {x, y});
    x = d.x;
    y = d.y;
  }
  const float fu = static_cast<float>(color_.fx * x + color_.cx),
              fv = static_cast<float>(color_.fy * y + color_.cy);
  const int width = image.rgb.width / 3, height = image.rgb.height;
  if (!(fu >= 0) || !(fv >= 0) || fu >= static_cast<float>(width - 1) || fv >= static_cast<float>(height - 1))
    return false;
  const int u = static_cast<int>(fu), v = static_cast<int>(fv);
  const float a = fu - static_cast<float>(u), b = fv - static_cast<float>(v);
  const std::uint8_t* top = image.rgb.row(v) + 3 * u;
  const std::uint8_t* bottom = image.rgb.row(v + 1) + 3 * u;
  for (int k = 0; k < 3; ++k) {
    const float upper = static_cast<float>(top[k]) * (1 - a) + static_cast<float>(top[k + 3]) * a;
    const float lower = static_cast<float>(bottom[k]) * (1 - a) + static_cast<float>(bottom[k + 3]) * a;
    rgb[k] = upper * (1 - b) + lower * b;
  }
  return true;
}

void register_color(const ColorRegistration& registration, const ColorImage& image, const PoseF& motion,
                    ImageView<const float> depth_z, ImageView<const std::uint8_t> owners, std::uint8_t owner,
                    const Rect& roi, const Pinhole& camera, ImageView<std::uint32_t> color) {
  const Rect box = roi.clipped(depth_z.width, depth_z.height);
  for (int v = box.v0; v < box.v1; ++v) {
    for (int u = box.u0; u < box.u1; ++u) {
      if (owners(u, v) != owner) continue;
      const float z = depth_z(u, v);
      float rgb[3];
      const bool seen =
          z > 0 && registration.sample(image, motion,
                                       camera.ray(static_cast<float>(u), static_cast<float>(v)) * z, rgb);
      color(u, v) =
          seen ? pack_rgb(static_cast<std::uint8_t>(rgb[0] + 0.5f), static_cast<std::uint8_t>(rgb[1] + 0.5f),
                          static_cast<std::uint8_t>(rgb[2] + 0.5f))
               : 0;
    }
  }
}

}  // namespace st
