#include "tools/calibrate/depth_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace st {
namespace {

constexpr double kCodesPerStep = 8;
// Of rounding to a step, times the pixels that share a matching window, and so an error (9 x 9, every fourth
// one sampled).
constexpr double kSampleVariance = 20 * kCodesPerStep * kCodesPerStep / 12;
constexpr double kBend_codes = 4;    // second difference between nodes, one sigma
constexpr double kUnseen_codes = 8;  // what a node that nothing was seen of may be
constexpr double kGates_codes[] = {32, 20, 12};

struct Grid {
  int columns = 0, rows = 0;
  int nodes() const { return columns * rows; }
};

constexpr Grid kGrid{11, 9};
static_assert(kGrid.columns <= DisparityCorrection::kMostColumns &&
              kGrid.rows <= DisparityCorrection::kMostRows);

// Unknowns: three numbers of each view's plane, then the nodes.
class Fit {
 public:
  Fit(const Calibration& calibration, std::size_t views, Grid grid)
      : camera_(calibration.depth), views_(views), solution_(Eigen::VectorXd::Zero(unknowns(views, grid))) {
    correction_.columns = grid.columns;
    correction_.rows = grid.rows;
  }

  // Samples that lie farther than `gate_codes` from the last solution take no part; all do at first.
  void solve(const std::vector<FloorSamples>& views, double gate_codes) {
    const Eigen::Index n = solution_.size();
    A_ = Eigen::MatrixXd::Zero(n, n);
    b_ = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < views.size(); ++i)
      for (const FloorSample& sample : views[i])
        if (!solved_ || std::fabs(residual(i, sample)) < gate_codes) add(i, sample);
    hold_together();
    solution_ = A_.ldlt().solve(b_);
    solved_ = true;
  }

  // What the plane has more than the corrected reading, codes.
  double residual(std::size_t view, const FloorSample& sample) const {
    double value = -sample.code;
    const Row row = row_of(view, sample);
    for (int k = 0; k < row.size; ++k) value += row.factor[k] * solution_[row.at[k]];
    return value;
  }

  FloorCodes floor(std::size_t view) const {
    const auto first = static_cast<Eigen::Index>(3 * view);
    return {solution_[first], solution_[first + 1], solution_[first + 2]};
  }

  DisparityCorrection correction() const {
    DisparityCorrection out = correction_;
    for (int i = 0; i < out.columns * out.rows; ++i) {
      const double steps = solution_[node(i)] / kCodesPerStep;
      out.steps[i] = static_cast<float>(std::round(1000 * steps) / 1000);
    }
    return out;
  }

 private:
  // Which unknowns a sample depends on, and how.
  struct Row {
    Eigen::Index at[7];
    double factor[7];
    int size;
  };

  static Eigen::Index unknowns(std::size_t views, Grid grid) {
    return static_cast<Eigen::Index>(3 * views) + grid.nodes();
  }
  Eigen::Index node(int i) const { return static_cast<Eigen::Index>(3 * views_) + i; }

  Row row_of(std::size_t view, const FloorSample& sample) const {
    const auto first = static_cast<Eigen::Index>(3 * view);
    Row row{{first, first + 1, first + 2},
            {(sample.u - camera_.cx) / camera_.fx, (sample.v - camera_.cy) / camera_.fy, 1},
            3};
    if (correction_.empty()) return row;
    const auto nodes = correction_.around(sample.u, sample.v, camera_.width, camera_.height);
    for (int k = 0; k < 4; ++k) {
      row.at[row.size] = node(nodes.node[k]);
      row.factor[row.size++] = -nodes.weight[k];
    }
    return row;
  }

  void add(std::size_t view, const FloorSample& sample) {
    const Row row = row_of(view, sample);
    for (int i = 0; i < row.size; ++i) {
      const double weighted = row.factor[i] / kSampleVariance;
      b_[row.at[i]] += weighted * sample.code;
      for (int j = 0; j < row.size; ++j) A_(row.at[i], row.at[j]) += weighted * row.factor[j];
    }
  }

  void hold_together() {
    for (int y = 0; y < correction_.rows; ++y) {
      for (int x = 0; x < correction_.columns; ++x) {
        const int i = y * correction_.columns + x;
        A_(node(i), node(i)) += 1 / (kUnseen_codes * kUnseen_codes);
        if (x > 0 && x + 1 < correction_.columns) keep_straight(i - 1, i, i + 1);
        if (y > 0 && y + 1 < correction_.rows)
          keep_straight(i - correction_.columns, i, i + correction_.columns);
      }
    }
  }

  void keep_straight(int before, int at, int after) {
    const Eigen::Index index[3] = {node(before), node(at), node(after)};
    const double factor[3] = {1, -2, 1};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        A_(index[i], index[j]) += factor[i] * factor[j] / (kBend_codes * kBend_codes);
  }

  Intrinsics camera_;
  std::size_t views_;
  DisparityCorrection correction_;  // its size; the solution has the values
  Eigen::VectorXd solution_;
  Eigen::MatrixXd A_;
  Eigen::VectorXd b_;
  bool solved_ = false;
};

// Means of residuals over patches of the image, where there are enough of them.
class Patches {
 public:
  explicit Patches(const Intrinsics& camera)
      : columns_((camera.width + kFloorPatch_px - 1) / kFloorPatch_px),
        means_(static_cast<std::size_t>(columns_ * ((camera.height + kFloorPatch_px - 1) / kFloorPatch_px))) {
  }

  void add(const FloorSample& sample, double residual) {
    Mean& mean =
        means_[static_cast<std::size_t>(sample.v / kFloorPatch_px * columns_ + sample.u / kFloorPatch_px)];
    mean.sum += residual;
    ++mean.count;
  }
  double square_sum() const {
    double sum = 0;
    for (const Mean& mean : means_)
      if (mean.known()) sum += mean.sum / mean.count * (mean.sum / mean.count);
    return sum;
  }
  int known() const {
    return static_cast<int>(std::ranges::count_if(means_, [](const Mean& mean) { return mean.known(); }));
  }
  double known_share() const { return static_cast<double>(known()) / static_cast<double>(means_.size()); }

 private:
  struct Mean {
    double sum = 0;
    int count = 0;
    bool known() const { return count >= kFloorPatch_px * kFloorPatch_px / 8; }
  };
  int columns_;
  std::vector<Mean> means_;
};

double smooth_rms_steps(const Calibration& calibration, const Fit& fit,
                        const std::vector<FloorSamples>& views) {
  double squares = 0;
  int known = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    Patches patches(calibration.depth);
    for (const FloorSample& sample : views[i]) patches.add(sample, fit.residual(i, sample));
    squares += patches.square_sum();
    known += patches.known();
  }
  return known > 0 ? std::sqrt(squares / known) / kCodesPerStep : 0;
}

Fit fitted(const Calibration& calibration, const std::vector<FloorSamples>& views, Grid grid) {
  Fit fit(calibration, views.size(), grid);
  for (const double gate : kGates_codes) fit.solve(views, gate);
  return fit;
}

// The patches of one colour of a chessboard.
std::vector<FloorSamples> half_of(const std::vector<FloorSamples>& views, int color) {
  std::vector<FloorSamples> out(views.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    for (const FloorSample& sample : views[i])
      if ((sample.u / kFloorPatch_px + sample.v / kFloorPatch_px) % 2 == color) out[i].push_back(sample);
  return out;
}

double codes_per_inverse_m(const Calibration& calibration) { return kCodesPerStep * calibration.raw_a; }

}  // namespace

DepthFit fit_depth(const Calibration& calibration, const std::vector<FloorSamples>& views) {
  const std::vector<FloorSamples> black = half_of(views, 0), white = half_of(views, 1);
  DepthFit out;
  out.before_steps = smooth_rms_steps(calibration, fitted(calibration, black, {}), white);
  out.after_steps = smooth_rms_steps(calibration, fitted(calibration, black, kGrid), white);
  const Fit fit = fitted(calibration, views, kGrid);
  out.correction = fit.correction();
  Patches seen(calibration.depth);
  for (std::size_t i = 0; i < views.size(); ++i) {
    out.floors.push_back(fit.floor(i));
    for (const FloorSample& sample : views[i]) {
      seen.add(sample, 0);
      const double steps =
          out.correction.at(sample.u, sample.v, calibration.depth.width, calibration.depth.height);
      out.largest_steps = std::max(out.largest_steps, std::fabs(steps));
    }
  }
  out.seen_share = seen.known_share();
  return out;
}

FloorPlane plane_of(const Calibration& calibration, const FloorCodes& floor) {
  const Vec3 upside_down{floor.a, floor.b, floor.c};
  const double length = norm(upside_down);
  return {codes_per_inverse_m(calibration) / length, upside_down * (-1 / length)};
}

HeightFit fit_heights(const Calibration& calibration, const std::vector<FloorCodes>& floors,
                      const std::vector<double>& heights_m) {
  constexpr double kTape_m = 0.003;
  const double K = codes_per_inverse_m(calibration);
  double information = 0, sum = 0;
  for (std::size_t i = 0; i < floors.size(); ++i) {
    // |(a, b, c + e)| = K / h, with e codes more everywhere.
    const FloorCodes& f = floors[i];
    const double length = K / heights_m[i];
    const double square = length * length - f.a * f.a - f.b * f.b;
    const double c = std::sqrt(std::max(square, 1.0));
    const double sigma_codes = length * length / c / heights_m[i] * kTape_m;
    information += 1 / (sigma_codes * sigma_codes);
    sum += (c - f.c) / (sigma_codes * sigma_codes);
  }
  return {calibration.raw_b + sum / information / kCodesPerStep, 1 / std::sqrt(information) / kCodesPerStep};
}

}  // namespace st
