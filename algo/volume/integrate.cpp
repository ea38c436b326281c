#include "algo/volume/integrate.hpp"

#include <cmath>

#include "algo/volume/brick_view.hpp"

namespace st {
namespace {

// How far before and behind a pixel's depth, in truncations, a voxel may be updated: a plane seen at 48
// degrees still has its whole band, a steeper one its middle.
constexpr float kReachTruncations = 1.5f;
// Colour is kept where a view of the surface will look for it.
constexpr float kColorVoxels = 1.5f, kColorBand = 0.25f;
constexpr int kGroup = 4;  // bricks a side of the coarser boxes that are tested first

// Collects the bricks that the evidence may change.
class BrickFinder {
 public:
  BrickFinder(const Volume& volume, const Evidence& evidence, const Pinhole& camera,
              const Pose& T_camera_object, float reach_m, std::span<FuseBrick> list)
      : volume_(volume),
        evidence_(evidence),
        reach_m_(reach_m),
        list_(list),
        groups_(volume, camera, evidence.roi, T_camera_object, kGroup * kBrickSide, 0.0f),
        bricks_(volume, camera, evidence.roi, T_camera_object, kBrickSide, 0.0f) {}

  std::size_t find() {
    const DepthCell& all = evidence_.everything();
    near_m_ = all.nearest - reach_m_;
    far_m_ = all.farthest + reach_m_;
    empty_to_m_ = all.empty_to;
    const int b = volume_.bricks_a_side();
    for (int z = 0; z < b; z += kGroup)
      for (int y = 0; y < b; y += kGroup)
        for (int x = 0; x < b; x += kGroup) {
          const BrickBounds bounds = groups_.of(x * kBrickSide, y * kBrickSide, z * kBrickSide);
          const Evidence::Answer a = evidence_.ask(bounds.rect, bounds.near_m, bounds.far_m, reach_m_);
          if (a.surface || a.empties) descend(x, y, z);
        }
    return found_;
  }

 private:
  void descend(int x0, int y0, int z0) {
    const int b = volume_.bricks_a_side();
    for (int z = z0; z < z0 + kGroup && z < b; ++z)
      for (int y = y0; y < y0 + kGroup && y < b; ++y)
        for (int x = x0; x < x0 + kGroup && x < b; ++x) consider(x, y, z);
  }

  void consider(int x, int y, int z) {
    const bool solid = (volume_.bricks[volume_.brick_index(x, y, z)] & kBrickSolid) != 0;
    const float depth = bricks_.depth_of(x * kBrickSide, y * kBrickSide, z * kBrickSide),
                half = bricks_.half_depth();
    const bool in_band = depth - half <= far_m_ && depth + half >= near_m_;
    if (!in_band && !(solid && depth - half <= empty_to_m_)) return;
    const BrickBounds bounds = bricks_.of(x * kBrickSide, y * kBrickSide, z * kBrickSide);
    const Evidence::Answer a = evidence_.ask(bounds.rect, bounds.near_m, bounds.far_m, reach_m_);
    const bool carve = solid && a.empties;
    if (!a.surface && !carve) return;
    list_[found_++] = {static_cast<std::uint16_t>(x),
                       static_cast<std::uint16_t>(y),
                       static_cast<std::uint16_t>(z),
                       carve,
                       a.near_m,
                       a.far_m};
  }

  const Volume& volume_;
  const Evidence& evidence_;
  float reach_m_;
  std::span<FuseBrick> list_;
  BrickView groups_, bricks_;
  float near_m_ = 0, far_m_ = 0, empty_to_m_ = 0;
  std::size_t found_ = 0;
};

// A different fraction each frame, spread evenly over the unit interval (multiples of the golden ratio).
void set_dither(std::uint32_t frame, float (&dither)[3]) {
  for (int c = 0; c < 3; ++c) {
    const double x = 0.5 + 0.61803398874989485 * static_cast<double>(frame) + c / 3.0;
    dither[c] = static_cast<float>(0.999 * (x - std::floor(x)));
  }
}

FuseKernel prepared(Volume& v, const Pinhole& camera, const Evidence& e, const Pose& T,
                    const IntegrateOptions& o) {
  FuseKernel k{};
  k.side = v.side;
  k.tsdf = v.tsdf.data();
  k.weight = v.weight.data();
  k.observations = v.observations.data();
  k.color = v.color.data();
  k.bricks = v.bricks.data();
  k.octants = v.octants.data();
  const PoseF Tf = to_float(T);
  const Vec3f first = Tf * v.origin;
  for (int a = 0; a < 3; ++a) {
    k.first[a] = first[a];
    k.step_x[a] = Tf.R(a, 0) * v.voxel_m;
    k.step_y[a] = Tf.R(a, 1) * v.voxel_m;
    k.step_z[a] = Tf.R(a, 2) * v.voxel_m;
  }
  k.fx = camera.fx;
  k.fy = camera.fy;
  k.cx = camera.cx - static_cast<float>(e.roi.u0);
  k.cy = camera.cy - static_cast<float>(e.roi.v0);
  k.per_fx = 1.0f / camera.fx;
  k.per_fy = 1.0f / camera.fy;
  k.width = e.roi.width();
  k.height = e.roi.height();
  k.stride = e.stride;
  k.z = e.z.data();
  k.meta = e.meta.data();
  k.per_truncation = 1.0f / v.truncation_m;
  k.reach = kReachTruncations * v.truncation_m;
  k.cap = o.weight_cap < kMaxWeightCap ? o.weight_cap : kMaxWeightCap;
  k.carve_weight = o.carve_weight;
  k.color_cap = o.color_cap;
  const float band = kColorVoxels * v.voxel_m * k.per_truncation;
  k.color_band = band > kColorBand ? band : kColorBand;
  set_dither(v.integrations, k.dither);
  return k;
}

}  // namespace

void IntegrateScratch::bind(Bump& memory, int max_width, int max_height, int max_side) {
  evidence.bind(memory, max_width, max_height);
  const std::size_t b = static_cast<std::size_t>(max_side / kBrickSide);
  list = memory.take<FuseBrick>(b * b * b);
}

IntegrateStats integrate(Volume& volume, const EvidenceInput& input, const Pose& T_camera_object,
                         const IntegrateOptions& options, IntegrateScratch& scratch) {
  Evidence& e = scratch.evidence;
  const float edge = volume.extent_m();
  e.evaluate(input, options.noise, T_camera_object, volume.origin, volume.origin + Vec3f{edge, edge, edge});
  FuseKernel k = prepared(volume, input.camera, e, T_camera_object, options);
  if (!input.color.empty()) {
    k.pixel_color = input.color.row(e.roi.v0) + e.roi.u0;
    k.color_stride = input.color.width;
  }
  k.list = scratch.list.data();
  k.listed = BrickFinder(volume, e, input.camera, T_camera_object, k.reach, scratch.list).find();
  fuse_bricks(k);
  ++volume.integrations;
  return {e.surface_pixels,           e.refused_pixels, e.outside_pixels, e.low,     e.high,
          static_cast<int>(k.listed), k.updated,        k.carved,         k.colored, k.color_refused};
}

}  // namespace st
