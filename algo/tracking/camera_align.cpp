#include "algo/tracking/camera_align.hpp"

#include <cmath>

#include "algo/core/solve.hpp"
#include "algo/tracking/camera_kernel.hpp"
#include "algo/tracking/normal_equations.hpp"

namespace st {
namespace {

struct Level {
  int of_pyramid;
  int iterations;
  double gate;  // share of the input's
  float robust_sigmas;
  double settled_m, settled_rad;  // a smaller step is the last of the level
};
constexpr Level kLevels[] = {
    {2, 6, 1.0, 8.0f, 5e-4, 5e-4},
    {1, 5, 0.5, 5.0f, 2e-4, 2e-4},
    {0, 4, 0.25, 3.0f, 5e-5, 4e-5},
};
constexpr double kLargestStep_m = 0.1, kLargestStep_rad = 0.15;
// Neighbouring pixels share the sensor's matching window: so many count as one measurement.
constexpr double kCorrelatedPixels = 30;

CameraKernel prepared(const CameraAlignInput& in, const Level& level) {
  const DepthPyramid::Level& image = in.depth.levels[level.of_pyramid];
  CameraKernel k{};
  k.z = image.z.data;
  k.width = image.z.width;
  k.height = image.z.height;
  k.cx = image.camera.cx;
  k.cy = image.camera.cy;
  k.per_fx = 1.0f / image.camera.fx;
  k.per_fy = 1.0f / image.camera.fy;
  k.view_z = in.view.z.data();
  k.view_normal = in.view.normal.data();
  k.view_width = in.view.roi.width();
  k.view_height = in.view.roi.height();
  k.view_stride = in.view.stride;
  k.view_fx = in.camera.fx;
  k.view_fy = in.camera.fy;
  k.view_cx = in.camera.cx - static_cast<float>(in.view.roi.u0);
  k.view_cy = in.camera.cy - static_cast<float>(in.view.roi.v0);
  const double gate = level.gate * in.gate_m;
  k.gate2_m2 = static_cast<float>(gate * gate);
  k.robust2 = level.robust_sigmas * level.robust_sigmas;
  return k;
}

void sum_up(CameraKernel& k, const Pose& T) {
  const PoseF Tf = to_float(T);
  for (int i = 0; i < 9; ++i) k.R[i] = Tf.R.m[i];
  for (int i = 0; i < 3; ++i) k.t[i] = Tf.t[i];
  for (double& x : k.triangle) x = 0;
  for (double& x : k.gradient) x = 0;
  k.square_sum = 0;
  k.readings = k.facing = k.paired = k.inliers = 0;
  accumulate_camera(k);
}

void add_prior(const CameraPrior& prior, const Pose& T, NormalEquations& eq) {
  const Vec3 turned = rotation_to_vector(T.R);
  for (int a = 0; a < 3; ++a) {
    double Jv[6]{}, Jw[6]{};
    Jv[a] = Jw[3 + a] = 1;
    eq.add(Jv, T.t[a], 1.0 / (prior.sigma_m * prior.sigma_m));
    eq.add(Jw, turned[a], 1.0 / (prior.sigma_rad * prior.sigma_rad));
  }
  if (!prior.has_up) return;
  eq.add_lean(prior.up_view, T.R * prior.up_frame, prior.sigma_up_rad);
}

struct Step {
  Twist twist;
  bool solved = false;
  double move_m = 0, turn_rad = 0;
};

Step solve(const NormalEquations& eq) {
  double A[36], b[6], x[6];
  eq.copy_pose_block(A);
  for (int i = 0; i < 6; ++i) b[i] = -eq.g[i];
  Step step;
  step.solved = solve_spd(A, b, x, 6);
  if (!step.solved) return step;
  step.twist = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
  step.move_m = norm(step.twist.v);
  step.turn_rad = norm(step.twist.w);
  const double m = step.move_m / kLargestStep_m, r = step.turn_rad / kLargestStep_rad;
  const double over = m > r ? m : r;
  if (over > 1.0) step.twist = {step.twist.v * (1.0 / over), step.twist.w * (1.0 / over)};
  return step;
}

}  // namespace

CameraAlignResult align_camera(const CameraAlignInput& in) {
  CameraAlignResult result;
  Pose T = in.start;
  for (const Level& level : kLevels) {
    if (level.of_pyramid < in.finest) break;
    CameraKernel k = prepared(in, level);
    // A coarse pixel stands for the readings that it was averaged from.
    const double pixels = static_cast<double>(1 << (2 * level.of_pyramid));
    const double information = pixels < kCorrelatedPixels ? pixels / kCorrelatedPixels : 1.0;
    for (int i = 0; i < level.iterations; ++i) {
      sum_up(k, T);
      for (double& x : k.triangle) x *= information;
      for (double& x : k.gradient) x *= information;
      NormalEquations eq;
      eq.add_sums(k.triangle, k.gradient, NormalEquations::kPose);
      eq.copy_pose_block(result.data_information);
      add_prior(in.prior, T, eq);
      const Step step = solve(eq);
      result.solved = step.solved;
      if (!step.solved) return result;
      result.pixels_visited += static_cast<long>(k.width) * k.height;
      T = moved_about(T, step.twist, Vec3{});
      if (step.move_m < level.settled_m && step.turn_rad < level.settled_rad) break;
    }
    result.pixels = k.width * k.height;
    result.readings = k.readings;
    result.facing = k.facing;
    result.paired = k.paired;
    result.inliers = k.inliers;
    result.rms_m = k.inliers > 0 ? std::sqrt(k.square_sum / k.inliers) : 0;
  }
  T.R = orthonormalized(T.R);
  result.T_view_camera = T;
  return result;
}

double least_seen_sigma_m(const double (&information)[36], double distance_m) {
  double scaled[36], values[6], vectors[36];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      scaled[6 * i + j] = information[6 * i + j] / ((i < 3 ? 1.0 : distance_m) * (j < 3 ? 1.0 : distance_m));
  eigen_symmetric(scaled, values, vectors, 6);
  constexpr double kUnseen_m = 1e3;
  return values[0] > 1.0 / (kUnseen_m * kUnseen_m) ? 1.0 / std::sqrt(values[0]) : kUnseen_m;
}

}  // namespace st
