#include "algo/tracking/closest_point.hpp"

#include "algo/core/solve.hpp"
#include "algo/tracking/rigid_fit.hpp"
#include "algo/volume/surface_points.hpp"

namespace st {
namespace {

// As the other trackers' finest look has it, so that one judge can compare them.
constexpr float kGate_m = 0.02f;
// Directions that depth does not see stay this uncertain.
constexpr double kUnseen_m = 1.0, kUnseen_rad = 1.0;

void describe(const AlignInput& in, AlignScratch& scratch, AlignResult& result) {
  constexpr int kN = NormalEquations::kSize;
  build_view_table(in.view, scratch.view);
  arrange_points(in.points, PointTable::kMost / static_cast<std::size_t>(in.point_stride), scratch.points);
  DepthTermOptions options;
  options.gate_m = kGate_m;
  NormalEquations eq;
  const Pose D = result.T_camera_object * in.view.T_camera_object.inverse();
  result.depth =
      add_depth_term(scratch.points, scratch.points.count, scratch.view, in.camera, D, in.pivot, options, eq);
  eq.mirror();
  double information[36];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const double unseen = i < 3 ? kUnseen_m : kUnseen_rad;
      result.shape_information[6 * i + j] = result.data_information[6 * i + j] = eq.H[kN * i + j];
      information[6 * i + j] = eq.H[kN * i + j] + (i == j ? 1 / (unseen * unseen) : 0.0);
    }
  result.solved = invert_spd(information, result.covariance, 6);
}

}  // namespace

ClosestPointResult closest_point_icp(std::span<const ObservedPoint> observed, const KdTree& model,
                                     const Pose& T_camera_object_start, const ClosestPointOptions& options) {
  ClosestPointResult result;
  result.T_camera_object = T_camera_object_start;
  const std::size_t count = observed.size() < options.points ? observed.size() : options.points;
  Pose T_object_camera = T_camera_object_start.inverse();
  double last_m2 = 0;
  for (int i = 0; i < options.iterations && i < ClosestPointOptions::kMostIterations; ++i) {
    RigidFit fit;
    double square_sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3 p = to_double(observed[k * observed.size() / count].p);
      const Vec3f moved = to_float(T_object_camera * p);
      const KdTree::Nearest nearest = model.nearest(moved);  // step 1
      square_sum += static_cast<double>(nearest.distance2_m2);
      fit.add(p, to_double(model.points()[nearest.index]));
    }
    const double mean_m2 = square_sum / static_cast<double>(count > 0 ? count : 1);
    result.mean_square_m2[result.iterations++] = mean_m2;
    if (i > 0 && last_m2 - mean_m2 <= options.settled_share * last_m2) break;
    if (!fit.solve(T_object_camera)) break;  // step 2; step 3 is done above, on the untouched points
    if (mean_m2 < options.settled_m2) break;
    last_m2 = mean_m2;
  }
  result.T_camera_object = T_object_camera.inverse();
  return result;
}

void ModelCloud::take(const Volume& volume) { tree.build(surface_points(volume, tree.room())); }

AlignResult align_closest_point(const AlignInput& in, const ModelCloud& model, AlignScratch& scratch) {
  AlignResult result;
  result.T_camera_object = in.start;
  if (model.tree.points().empty()) return result;
  ClosestPointOptions options;
  options.points /= static_cast<std::size_t>(in.point_stride);
  const ClosestPointResult found = closest_point_icp(in.points, model.tree, in.start, options);
  result.T_camera_object = found.T_camera_object;
  result.iterations = found.iterations;
  describe(in, scratch, result);
  return result;
}

}  // namespace st
