#include "tools/evaluate/alignment.hpp"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace st {
namespace {

using Matrix = Eigen::Matrix3d;

Matrix to_eigen(const Mat3& a) { return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(a.m); }
Mat3 from_eigen(const Matrix& a) {
  Mat3 out;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) out(r, c) = a(r, c);
  return out;
}

Mat3 nearest_rotation(const Mat3& a) {
  const Eigen::JacobiSVD<Matrix> svd(to_eigen(a), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix U = svd.matrixU(), V = svd.matrixV();
  const Eigen::Vector3d signs(1, 1, (U * V.transpose()).determinant() < 0 ? -1 : 1);
  return from_eigen(U * signs.asDiagonal() * V.transpose());
}

double median(std::vector<double> values) {
  const std::size_t half = values.size() / 2;
  std::ranges::sort(values);
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

// The start is the best of a sample, so that a third of wild poses does no harm.
Mat3 best_of_sample(std::span<const Mat3> Rs) {
  constexpr std::size_t kSample = 40;
  constexpr double kCapRad = 0.5;
  const std::size_t count = std::min(Rs.size(), kSample);
  const double step = count > 1 ? static_cast<double>(Rs.size() - 1) / static_cast<double>(count - 1) : 0;
  double least = -1;
  Mat3 best;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = i + 1 == count ? (count > 1 ? Rs.size() - 1 : 0)
                                          : static_cast<std::size_t>(static_cast<double>(i) * step);
    double cost = 0;
    for (const Mat3& R : Rs) cost += std::min(rotation_angle(R.transposed() * Rs[at]), kCapRad);
    if (least < 0 || cost < least) least = cost, best = Rs[at];
  }
  return best;
}

Mat3 robust_rotation(std::span<const Mat3> Rs) {
  constexpr int kSteps = 60;
  constexpr double kFloorRad = 0.2 * 3.14159265358979323846 / 180, kFarRad = 1.0, kFarWeight = 0.05,
                   kDoneRad = 1e-10;
  Mat3 R = best_of_sample(Rs);
  for (int step = 0; step < kSteps; ++step) {
    Vec3 sum{};
    double weights = 0;
    for (const Mat3& other : Rs) {
      const Vec3 v = rotation_to_vector(R.transposed() * other);
      const double weight = (1.0 / std::max(norm(v), kFloorRad)) * (norm(v) > kFarRad ? kFarWeight : 1.0);
      sum += v * weight;
      weights += weight;
    }
    const Vec3 d = sum * (1.0 / weights);
    R = R * rotation_from_vector(d);
    if (norm(d) < kDoneRad) break;
  }
  return nearest_rotation(R);
}

Vec3 robust_point(std::span<const Vec3> points) {
  constexpr int kSteps = 100;
  constexpr double kFloorM = 5e-4, kDoneM = 1e-9;
  Vec3 m{};
  for (int i = 0; i < 3; ++i) {
    std::vector<double> axis;
    for (const Vec3& p : points) axis.push_back(p[i]);
    m[i] = median(axis);
  }
  for (int step = 0; step < kSteps; ++step) {
    Vec3 sum{};
    double weights = 0;
    for (const Vec3& p : points) {
      const double weight = 1.0 / std::max(norm(p - m), kFloorM);
      sum += p * weight;
      weights += weight;
    }
    const Vec3 next = sum * (1.0 / weights);
    if (norm(next - m) < kDoneM) break;
    m = next;
  }
  return m;
}

Vec3 mean_position(std::span<const Pose> poses) {
  Vec3 sum{};
  for (const Pose& T : poses) sum += T.t;
  return sum * (1.0 / static_cast<double>(poses.size()));
}

}  // namespace

Pose solve_offset(std::span<const Pose> estimate, std::span<const Pose> truth) {
  std::vector<Mat3> rotations;
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const Pose D = estimate[i].inverse() * truth[i];
    rotations.push_back(D.R);
    points.push_back(D.t);
  }
  return {robust_rotation(rotations), robust_point(points)};
}

Alignment align_positions(std::span<const Pose> estimate, std::span<const Pose> truth) {
  const Vec3 mean_e = mean_position(estimate), mean_t = mean_position(truth);
  const double n = static_cast<double>(estimate.size());
  Matrix S = Matrix::Zero();
  double spread = 0;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const Vec3 e = estimate[i].t - mean_e, t = truth[i].t - mean_t;
    S += Eigen::Vector3d(t.x, t.y, t.z) * Eigen::RowVector3d(e.x, e.y, e.z) / n;
    spread += dot(e, e) / n;
  }
  const Eigen::JacobiSVD<Matrix> svd(S, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix U = svd.matrixU(), V = svd.matrixV();
  const Eigen::Vector3d signs(1, 1, U.determinant() * V.determinant() < 0 ? -1 : 1);
  const Mat3 R = from_eigen(U * signs.asDiagonal() * V.transpose());
  constexpr double kLeastSpread = 1e-12;
  return {{R, mean_t - R * mean_e}, svd.singularValues().dot(signs) / std::max(spread, kLeastSpread)};
}

}  // namespace st
