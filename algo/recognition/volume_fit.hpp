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
  Vec3f p{};  // of its own frame, metres
  ColorSample color;
};

// Height above the lowest point up to which a surface of this height is left out: floor that hangs together
// with what stands on it, where its shadow hides the floor's own depth, spreads round it like a skirt.
float skirt_m(float height_m);

// Points all over the volume's surface above its skirt, with their colours, and the box round them, which
// reaches down to the floor. `scratch` as long as `out`.
struct SampledSurface {
  std::size_t points = 0;  // written
  Bounds bounds;
};
SampledSurface sample_surface(const Volume& volume, std::span<SurfacePoint> out, std::span<Vec3f> scratch);

inline constexpr int kLeastColoured = 60;  // points with a colour, from which on the print counts

struct VolumeFit {
  Pose T_model_seen;
  float explained = 0;  // share of the points within the tolerance of the model's surface
  float likeness = 0;   // of the colours, -1 to 1: the same in any light
  int colored = 0;      // points that it was taken over
  float score() const;  // 0-1: explained, less where the print differs
};

// How far a point of a volume may lie from the surface that it belongs to: far away depth comes in steps of
// one or two centimetres. The truncation is three sigma of the depth that the volume was begun with.
inline constexpr float kFitTolerance_m = 0.008f;
inline float fit_tolerance_m(float truncation_m) {
  const float by_noise = 0.45f * truncation_m;
  return by_noise > kFitTolerance_m ? by_noise : kFitTolerance_m;
}

struct SeenSurface {
  std::span<const SurfacePoint> points;
  float tolerance_m = kFitTolerance_m;
};

// Moves the points from `start` onto the model's surface, in a fixed number of iterations. Only every
// `stride`th point is looked at.
VolumeFit fit_to_volume(const Volume& model, const SeenSurface& seen, const Pose& start, int iterations,
                        int stride = 1);

// Where the shape leaves the turn open the print decides: of turns about the points' middle, `steps` of
// step_rad to either side, the one with the best score.
VolumeFit turn_to_print(const Volume& model, const SeenSurface& seen, const VolumeFit& fit, int steps,
                        double step_rad, int stride = 1);

// What is seen from one side: how far the thing reaches towards the viewer, and to both sides.
struct Silhouette {
  float nearest = 0, low = 0, high = 0;
  float width() const { return high - low; }
  float middle() const { return 0.5f * (low + high); }
};
// `towards`: horizontal unit vector to the viewer. Without the outermost 2 % on each side.
Silhouette silhouette(std::span<const SurfacePoint> points, const Vec3f& towards);

// The motion with this turn about z that lays the seen silhouette over the model's. `towards`: to the viewer,
// in the seen frame. False when the model is far wider or narrower from there.
bool start_from_silhouette(std::span<const SurfacePoint> model, std::span<const SurfacePoint> seen,
                           const Vec3f& towards, double yaw_rad, Pose& T_model_seen);

}  // namespace st
