#include "algo/recognition/keypoints.hpp"

#include <cmath>

#include "algo/recognition/blur_kernel.hpp"

namespace st {
namespace {

// DoG values about one voxel of one octave.
struct Around {
  const ScaleSpace& space;
  int octave, level;
  std::ptrdiff_t at, row, slab;

  float operator()(int x, int y, int z, int l = 0) const {
    return space.dog(octave, level + l, static_cast<std::size_t>(at + x + y * row + z * slab));
  }
};

// A strict extremum among its neighbours in x, y, z and scale.
bool is_extremum(const Around& dog, float value, Neighbours neighbours) {
  const float sign = value > 0 ? 1.0f : -1.0f, strength = sign * value;
  for (int l = 0; l < 3; ++l)
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const int level = l == 0 ? 0 : l == 1 ? -1 : 1;
          const int off = (x != 0 ? 1 : 0) + (y != 0 ? 1 : 0) + (z != 0 ? 1 : 0) + (level != 0 ? 1 : 0);
          if (off == 0 || (off > 1 && neighbours == Neighbours::kNearest8)) continue;
          if (sign * dog(x, y, z, level) >= strength) return false;
        }
  return true;
}

struct Shape {
  double gradient[3], hessian[9];
};

Shape shape_of(const Around& dog) {
  constexpr int kUnit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double middle = dog(0, 0, 0);
  Shape s;
  for (int i = 0; i < 3; ++i) {
    const auto& a = kUnit[i];
    const double plus = dog(a[0], a[1], a[2]), minus = dog(-a[0], -a[1], -a[2]);
    s.gradient[i] = 0.5 * (plus - minus);
    s.hessian[4 * i] = plus - 2 * middle + minus;
    for (int j = i + 1; j < 3; ++j) {
      const auto& b = kUnit[j];
      const auto corner = [&](int p, int q) {
        return static_cast<double>(dog(p * a[0] + q * b[0], p * a[1] + q * b[1], p * a[2] + q * b[2]));
      };
      const double mixed = 0.25 * (corner(1, 1) - corner(1, -1) - corner(-1, 1) + corner(-1, -1));
      s.hessian[3 * i + j] = s.hessian[3 * j + i] = mixed;
    }
  }
  return s;
}

double determinant(const double (&h)[9]) {
  return h[0] * (h[4] * h[8] - h[5] * h[7]) - h[1] * (h[3] * h[8] - h[5] * h[6]) +
         h[2] * (h[3] * h[7] - h[4] * h[6]);
}

bool is_round(const double (&h)[9], double largest_ratio) {
  const double trace = h[0] + h[4] + h[8], det = determinant(h);
  if (!(trace * det > 0)) return false;  // no extremum in some direction
  const double r = largest_ratio;
  const double limit = (2 * r + 1) * (2 * r + 1) * (2 * r + 1) / (r * r);
  return trace * trace * trace / det < limit;
}

// The peak of the fitted quadric, at most half a voxel off.
Vec3f peak_offset(const Shape& s) {
  const double det = determinant(s.hessian);
  Vec3f offset{};
  for (int c = 0; c < 3; ++c) {  // Cramer's rule
    double with[9];
    for (int i = 0; i < 9; ++i) with[i] = i % 3 == c ? -s.gradient[i / 3] : s.hessian[i];
    const double step = determinant(with) / det;
    offset[c] = static_cast<float>(step > 0.5 ? 0.5 : step < -0.5 ? -0.5 : step);
  }
  return offset;
}

void keep(const Keypoint& keypoint, Keypoints& found, KeypointCounts& counts) {
  if (!found.full()) {
    found.push_back(keypoint);
    return;
  }
  ++counts.crowded_out;
  std::size_t weakest = 0;
  for (std::size_t i = 1; i < found.size(); ++i)
    if (found[i].contrast < found[weakest].contrast) weakest = i;
  if (found[weakest].contrast < keypoint.contrast) found[weakest] = keypoint;
}

}  // namespace

void find_keypoints(const ScaleSpace& space, int octave, int level, const KeypointLimits& limits,
                    Keypoints& found, KeypointCounts& counts) {
  const Grid& below = space.levels[octave][level];
  const Grid& above = space.levels[octave][level + 1];
  const float most = largest_difference(below.values.data(), above.values.data(), below.count());
  const float relative = limits.least_contrast_share * most;
  const float least = relative > limits.least_contrast ? relative : limits.least_contrast;
  const int n = below.side;
  for (int z = 1; z < n - 1; ++z) {
    for (int y = 1; y < n - 1; ++y) {
      for (int x = 1; x < n - 1; ++x) {
        const std::size_t at = below.index(x, y, z);
        const float value = space.dog(octave, level, at);
        // A tenth of the limit: what lies far below is not even counted among the extrema.
        if (std::fabs(value) < 0.1f * least || value == 0) continue;
        const Around dog{
            space, octave, level, static_cast<std::ptrdiff_t>(at), n, static_cast<std::ptrdiff_t>(n) * n};
        if (!is_extremum(dog, value, limits.neighbours)) continue;
        ++counts.extrema;
        if (std::fabs(value) < least) {
          ++counts.low_contrast;
          continue;
        }
        const Shape shape = shape_of(dog);
        if (!is_round(shape.hessian, limits.largest_curvature_ratio)) {
          ++counts.flat;
          continue;
        }
        const Vec3f place{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
        keep({octave, level, place + peak_offset(shape), ScaleSpace::sigma_of(static_cast<float>(level)),
              std::fabs(value)},
             found, counts);
      }
    }
  }
}

}  // namespace st
