// Verification: does what was seen lie on a known model's surface, and where? Upright things on one floor
// differ by a shift and a turn about z: every heading is tried from the silhouette, then the distance field
// pulls the points onto the surface (Gauss-Newton on the TSDF, Bylow et al. 2013).
#pragma once

#include <span>

#include "algo/core/pose.hpp"
#include "algo/tracking/track.hpp"
#include "algo/volume/volume.hpp"

namespace st {

inline constexpr std::size_t kFitPoints = 800;

struct SurfacePoint {
  Vec3f p{};             // of its own frame, metres
  float luminance = -1;  // 0-255; negative: none
};

// Points all over the volume's surface, with their colours. `scratch` as long as `out`.
std::size_t sample_surface(const Volume& volume, std::span<SurfacePoint> out, std::span<Vec3f> scratch);

struct VolumeFit {
  Pose T_model_seen;
  float explained = 0;  // share of the points within kFitTolerance_m of the model's surface
  float likeness = 0;   // correlation of the luminances, -1 to 1: the same in any light
  int colored = 0;      // points that it was taken over
  float score() const;  // 0-1: explained, less where the print differs
};
inline constexpr float kFitTolerance_m = 0.008f;

// Moves the points from `start` onto the model's surface, in a fixed number of iterations.
VolumeFit fit_to_volume(const Volume& model, std::span<const SurfacePoint> seen, const Pose& start,
                        int iterations);

// What is seen from one side: how far the thing reaches towards the viewer, and to both sides.
struct Silhouette {
  float nearest = 0, low = 0, high = 0;
  float width() const { return high - low; }
  float middle() const { return 0.5f * (low + high); }
};
// `towards`: horizontal unit vector to the viewer. Without the outermost 2 % on each side.
Silhouette silhouette(std::span<const SurfacePoint> points, const Vec3f& towards);

// The box around the points, trimmed in the same way: floor that clings to an object does not widen it.
Bounds surface_bounds(std::span<const SurfacePoint> points);

// The motion with this turn about z that lays the seen silhouette over the model's. `towards`: to the viewer,
// in the seen frame. False when the model is far wider or narrower from there.
bool start_from_silhouette(std::span<const SurfacePoint> model, std::span<const SurfacePoint> seen,
                           const Vec3f& towards, double yaw_rad, Pose& T_model_seen);

}  // namespace st
