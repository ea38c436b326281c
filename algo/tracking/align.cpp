#include "algo/tracking/align.hpp"

#include <cmath>
#include <iterator>

#include "algo/core/scalar_math.hpp"
#include "algo/core/solve.hpp"

namespace st {
namespace {

constexpr int kN = NormalEquations::kSize;

// Coarse to fine. The gate shrinks as the pose settles; colour has a basin of a few pixels only and comes in
// late.
struct Level {
  std::size_t points;  // at least so many are looked at, less than twice as many
  int iterations;
  double gate_m;  // least gate; the first level opens it to the start error
  float robust_sigmas;
  bool color;
};
constexpr Level kLevels[] = {
    {600, 4, 0.04, 8.0f, false},
    {2000, 3, 0.025, 5.0f, true},
    {6000, 3, 0.02, 4.0f, true},
};
constexpr double kLargestStep_m = 0.04, kLargestStep_rad = 0.2;
constexpr double kSettled_m = 2e-5, kSettled_rad = 5e-5;
constexpr double kShiftSigma_px =
    0.1;  // tight: a free shift would take the turn of an off-centre print for its own

void add_motion_prior(const AlignInput& in, const Pose& T, NormalEquations& eq) {
  // Deviation from the mean as a small motion about the pivot.
  const Vec3 pivot_object = in.prior.mean.inverse() * in.pivot;
  const Vec3 v = T * pivot_object - in.pivot;
  const Vec3 w = rotation_to_vector(T.R * in.prior.mean.R.transposed());
  const double e[6] = {v.x, v.y, v.z, w.x, w.y, w.z};
  for (int i = 0; i < 6; ++i) {
    double le = 0;
    for (int j = 0; j < 6; ++j) le += in.prior.information[6 * i + j] * e[j];
    eq.g[i] += le;
    for (int j = i; j < 6; ++j) eq.H[i * kN + j] += in.prior.information[6 * i + j];
  }
}

void add_floor_prior(const AlignInput& in, const Pose& T, NormalEquations& eq) {
  const FloorPrior& floor = in.floor;
  const Vec3& n = floor.up_camera;
  const Vec3 arm = T.t - in.pivot;
  const Vec3 turn = cross(arm, n);
  const double height = dot(n, T.t) + floor.d - floor.height_m;
  const double Jh[6] = {n.x, n.y, n.z, turn.x, turn.y, turn.z};
  eq.add(Jh, height, 1.0 / (floor.sigma_height_m * floor.sigma_height_m));

  eq.add_lean(n, T.R * floor.up_object, floor.sigma_tilt_rad);
}

// Chords of neighbouring frames overlap: so many say as much as one.
constexpr double kOverlappingChords = 10;

void add_heading_prior(const AlignInput& in, const Pose& T, NormalEquations& eq) {
  const Vec3& up = in.floor.up_camera;
  const double turned = dot(rotation_to_vector(T.R * in.prior.mean.R.transposed()), up);
  const double J[6] = {0, 0, 0, up.x, up.y, up.z};
  eq.add(J, turned - in.heading.turn_rad,
         1.0 / (kOverlappingChords * in.heading.sigma_rad * in.heading.sigma_rad));
}

void add_shift_prior(const double (&shift_px)[2], NormalEquations& eq) {
  constexpr double kInformation = 1.0 / (kShiftSigma_px * kShiftSigma_px);
  for (int k = 0; k < 2; ++k) {
    eq.H[(6 + k) * kN + 6 + k] += kInformation;
    eq.g[6 + k] += kInformation * shift_px[k];
  }
}

// Information about the pose once the image shift is marginalised out (Schur complement of the last two
// unknowns).
void marginal_information(const NormalEquations& eq, double (&pose)[36]) {
  eq.copy_pose_block(pose);
  const double a = eq.H[6 * kN + 6], b = eq.H[6 * kN + 7], d = eq.H[7 * kN + 7];
  const double det = a * d - b * b;
  if (!(det > 1e-12)) return;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const double iu = eq.H[i * kN + 6], iv = eq.H[i * kN + 7], ju = eq.H[j * kN + 6], jv = eq.H[j * kN + 7];
      pose[6 * i + j] -= (iu * (d * ju - b * jv) + iv * (a * jv - b * ju)) / det;
    }
}

// A round thing's noise stands still in the image while it turns, and its model has learned that noise: the
// turn that shape sees is partly its own. Where colour sees the turn, shape must not hold against it: it may
// be off by so many of its own sigmas.
constexpr double kOwnTurn = 3.0;

double own_turn_rad(const NormalEquations& shape, const PoseTie& axes) {
  double information[36];
  shape.copy_pose_block(information);
  return kOwnTurn * turn_sigma_rad(information, axes.R_frame_camera.transposed() * Vec3{0, 0, 1});
}

struct Step {
  double x[kN]{};
  bool solved = false;
  double translation() const { return std::sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]); }
  double rotation() const { return std::sqrt(x[3] * x[3] + x[4] * x[4] + x[5] * x[5]); }
};

Step solve(const NormalEquations& eq) {
  Step step;
  double b[kN];
  for (int i = 0; i < kN; ++i) b[i] = -eq.g[i];
  step.solved = solve_spd(eq.H, b, step.x, kN);
  if (!step.solved) return step;
  const double t = step.translation() / kLargestStep_m, r = step.rotation() / kLargestStep_rad;
  const double over = t > r ? t : r;
  if (over > 1.0)
    for (double& x : step.x) x /= over;
  return step;
}

}  // namespace

AlignResult align(const AlignInput& in, AlignScratch& scratch) {
  build_view_table(in.view, scratch.view);
  arrange_points(in.points, PointTable::kMost / static_cast<std::size_t>(in.point_stride), scratch.points);
  scratch.outline_count = in.terms.contour ? find_outline(scratch.view, in.camera, scratch.outline) : 0;
  return align_again(in, scratch);
}

AlignResult align_again(const AlignInput& in, AlignScratch& scratch) {
  AlignResult result;
  result.T_camera_object = in.start;
  Pose T = in.start;
  double shift_px[2] = {0, 0};
  const ContourTermOptions contour_options;
  NormalEquations shape, colour, data, all;
  std::size_t contour_count = 0;

  const Pose T_view_inverse = in.view.T_camera_object.inverse();
  const Vec3 pivot_then = in.color_time.motion * in.pivot;
  bool collected = false;
  const bool sees_color = in.color != nullptr && !in.color->empty();
  PoseTie own_turn;
  own_turn.R_frame_camera = in.color_time.tie.R_frame_camera;

  for (std::size_t l = 0; l < std::size(kLevels) && static_cast<int>(l) < in.levels; ++l) {
    const Level& level = kLevels[l];
    const std::size_t count = scratch.points.prefix(level.points / static_cast<std::size_t>(in.point_stride));
    DepthTermOptions depth_options;
    const double open = l == 0 ? 2.0 * in.largest_start_error_m : 0.0;
    depth_options.gate_m = static_cast<float>(open > level.gate_m ? open : level.gate_m);
    depth_options.robust_sigmas = level.robust_sigmas;
    const ColorTermOptions color_options;
    const bool use_color = sees_color && level.color;

    const Pose D0 = T * T_view_inverse;
    if (in.terms.contour)
      contour_count = find_contour({scratch.outline, scratch.outline_count}, in.camera, in.depth_z, D0,
                                   contour_options, scratch.contour);
    const auto look = [&] {
      return ColorLook{scratch.color_points,
                       scratch.color_points.prefix(level.points / static_cast<std::size_t>(in.point_stride)),
                       *in.color, pose_then(in.color_time, in.prior.mean, T, in.pivot) * T_view_inverse};
    };
    if (use_color && !collected)
      collect_color_points(scratch.view, in.camera, in.depth_z, D0, color_options,
                           PointTable::kMost / static_cast<std::size_t>(in.point_stride),
                           scratch.color_points);
    collected = collected || use_color;
    if (use_color) result.gain = fit_color_gain(look());

    for (int i = 0; i < level.iterations; ++i) {
      const Pose D = T * T_view_inverse;
      shape = NormalEquations{};
      result.depth =
          add_depth_term(scratch.points, count, scratch.view, in.camera, D, in.pivot, depth_options, shape);
      if (in.terms.contour)
        result.contour_used =
            add_contour_term({scratch.contour, contour_count}, in.camera, D, contour_options, shape);
      colour = NormalEquations{};
      if (use_color)
        result.color = add_color_term(look(), pivot_then, result.gain, shift_px, color_options, colour);
      if (i == 0) own_turn.sigma[5] = sees_color ? own_turn_rad(shape, own_turn) : 0;
      all = NormalEquations{};
      add_tied(shape, own_turn, all);
      result.color_rest = add_tied(colour, in.color_time.tie, all);
      add_shift_prior(shift_px, all);
      if (in.terms.motion) add_motion_prior(in, T, all);
      if (in.terms.motion && in.heading.on) add_heading_prior(in, T, all);
      if (in.terms.floor && in.floor.on) add_floor_prior(in, T, all);
      all.mirror();
      const Step step = solve(all);
      if (!step.solved) return result;
      ++result.iterations;
      T = moved_about(T, {{step.x[0], step.x[1], step.x[2]}, {step.x[3], step.x[4], step.x[5]}}, in.pivot);
      shift_px[0] += step.x[6];
      shift_px[1] += step.x[7];
      if (step.translation() < kSettled_m && step.rotation() < kSettled_rad) break;
    }
  }
  result.T_camera_object = T;
  result.color_motion = pose_then(in.color_time, in.prior.mean, T, in.pivot, result.color_rest) * T.inverse();
  data = shape;
  data.add(colour);
  add_shift_prior(shift_px, data);
  data.mirror();
  shape.copy_pose_block(result.shape_information);
  marginal_information(data, result.data_information);
  double marginal[36];
  marginal_information(all, marginal);
  result.solved = invert_spd(marginal, result.covariance, 6);
  return result;
}

double turn_sigma_rad(const double (&information)[36], const Vec3& axis) {
  // A weak prior (1 m, 1 rad) keeps unseen directions finite.
  double A[36], inverse[36];
  for (int i = 0; i < 36; ++i) A[i] = information[i] + (i % 7 == 0 ? 1.0 : 0.0);
  if (!invert_spd(A, inverse, 6)) return kPi;
  const double a[3] = {axis.x, axis.y, axis.z};
  double variance = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) variance += a[i] * inverse[6 * (3 + i) + 3 + j] * a[j];
  return variance > 0 ? std::sqrt(variance) : kPi;
}

}  // namespace st
