#include "algo/recognition/orientation.hpp"

#include "algo/core/scalar_math.hpp"
#include "algo/recognition/direction.hpp"

namespace st {
namespace {

// Central differences at a voxel; zero on the border.
Vec3f gradient_at(const Grid& level, int x, int y, int z) {
  const int last = level.side - 1;
  if (x < 1 || y < 1 || z < 1 || x >= last || y >= last || z >= last) return {};
  const auto n = static_cast<std::size_t>(level.side);
  const float* const at = &level.values[level.index(x, y, z)];
  return Vec3f{at[1] - *(at - 1), at[n] - *(at - n), at[n * n] - *(at - n * n)} * 0.5f;
}

constexpr int kAzimuths = 16, kElevations = 8, kTilts = 36;
constexpr float kPif = static_cast<float>(kPi);
constexpr float kWindowSigmas = 1.5f, kWindowRadius = 2.0f;  // of the window; of it in its sigmas
constexpr int kMostRadius = 16;                              // voxels
constexpr float kPeakShare = 0.8f;
constexpr float kNoGradient = 1e-6f;
constexpr int kMaxDirections = 3, kMaxTilts = 2;
constexpr float kConeCos = 0.866f;  // 30 degrees: what a peak's direction is the mean of
constexpr float kSameCos = 0.94f;   // 20 degrees: two peaks of one direction

// Calls visit(gradient, weight) for every voxel in the window around the keypoint.
template <typename Visit>
void for_window(const Grid& level, const Vec3f& voxel, float sigma, const Visit& visit) {
  const float s = kWindowSigmas * sigma;
  int radius = static_cast<int>(kWindowRadius * s);
  if (radius > kMostRadius) radius = kMostRadius;
  // A Gaussian is a product: three short tables instead of one large one.
  float weights[3][2 * kMostRadius + 1];
  int middle[3];
  for (int axis = 0; axis < 3; ++axis) {
    middle[axis] = static_cast<int>(voxel[axis] + 0.5f);
    for (int i = -radius; i <= radius; ++i) {
      const float off = (static_cast<float>(middle[axis] + i) - voxel[axis]) / s;
      weights[axis][i + radius] = static_cast<float>(exponential(-0.5 * static_cast<double>(off * off)));
    }
  }
  for (int z = -radius; z <= radius; ++z)
    for (int y = -radius; y <= radius; ++y)
      for (int x = -radius; x <= radius; ++x) {
        if (x * x + y * y + z * z > radius * radius) continue;
        const Vec3f g = gradient_at(level, middle[0] + x, middle[1] + y, middle[2] + z);
        visit(g, weights[0][x + radius] * weights[1][y + radius] * weights[2][z + radius]);
      }
}

// A bin of the sphere of directions covers less of it towards the poles.
float solid_angle(int elevation_bin) {
  const double low = kPi * elevation_bin / kElevations - kPi / 2;
  const double high = kPi * (elevation_bin + 1) / kElevations - kPi / 2;
  return static_cast<float>((sin_cos(high).sin - sin_cos(low).sin) * 2 * kPi / kAzimuths);
}

struct Sphere {
  float weight[kElevations][kAzimuths]{};
  float angle[kElevations]{};

  Sphere() {
    for (int e = 0; e < kElevations; ++e) angle[e] = solid_angle(e);
  }
  void add(const Vec3f& g, float w) {
    const float length = norm(g);
    if (length < kNoGradient) return;
    const float azimuth = coarse_arc_tan2(g.y, g.x);
    const float elevation = coarse_arc_tan2(g.z, std::sqrt(g.x * g.x + g.y * g.y));
    int a = static_cast<int>((azimuth + kPif) / (2 * kPif) * kAzimuths) % kAzimuths;
    int e = static_cast<int>((elevation + kPif / 2) / kPif * kElevations);
    if (e >= kElevations) e = kElevations - 1;
    if (a < 0) a = 0;
    weight[e][a] += w * length / angle[e];
  }
  // Over the pole is the same row, half way round.
  float at(int e, int a) const {
    if (e < 0 || e >= kElevations)
      return weight[e < 0 ? 0 : kElevations - 1][(a + kAzimuths / 2) % kAzimuths];
    return weight[e][(a + kAzimuths) % kAzimuths];
  }
  bool is_peak(int e, int a) const {
    for (int de = -1; de <= 1; ++de)
      for (int da = -1; da <= 1; ++da)
        if ((de != 0 || da != 0) && at(e + de, a + da) > weight[e][a]) return false;
    return true;
  }
  static Vec3f direction(int e, int a) {
    const SinCos elevation = sin_cos(kPi * (e + 0.5) / kElevations - kPi / 2);
    const SinCos azimuth = sin_cos(2 * kPi * (a + 0.5) / kAzimuths - kPi);
    return to_float(Vec3{elevation.cos * azimuth.cos, elevation.cos * azimuth.sin, elevation.sin});
  }
};

// The bins around a pole are narrow and a direction near it falls into any: the peak's direction is the mean
// of what lies in a cone around it.
Vec3f refined(const Grid& level, const Vec3f& voxel, float sigma, const Vec3f& rough, float& strength) {
  Vec3f direction = rough;
  for (int pass = 0; pass < 2; ++pass) {
    Vec3f sum{};
    for_window(level, voxel, sigma, [&](const Vec3f& g, float w) {
      if (dot(g, direction) > kConeCos * norm(g)) sum += g * w;
    });
    strength = norm(sum);
    if (!(strength > 0)) return rough;
    direction = sum * (1.0f / strength);
  }
  return direction;
}

struct Direction {
  Vec3f d;
  float strength;
};

int find_directions(const Grid& level, const Vec3f& voxel, float sigma, Direction (&found)[kMaxDirections]) {
  Sphere sphere;
  for_window(level, voxel, sigma, [&](const Vec3f& g, float w) { sphere.add(g, w); });
  float most = 0;
  for (const auto& row : sphere.weight)
    for (const float w : row) most = w > most ? w : most;
  if (!(most > 0)) return 0;
  int count = 0;
  for (int e = 0; e < kElevations; ++e) {
    for (int a = 0; a < kAzimuths; ++a) {
      if (sphere.weight[e][a] < kPeakShare * most || !sphere.is_peak(e, a)) continue;
      Direction next{};
      next.d = refined(level, voxel, sigma, Sphere::direction(e, a), next.strength);
      bool known = false;
      for (int i = 0; i < count; ++i) known = known || dot(found[i].d, next.d) > kSameCos;
      if (known) continue;
      if (count < kMaxDirections)
        found[count++] = next;
      else if (next.strength > found[kMaxDirections - 1].strength)
        found[kMaxDirections - 1] = next;
      for (int i = count - 1; i > 0 && found[i].strength > found[i - 1].strength; --i) {
        const Direction swapped = found[i];
        found[i] = found[i - 1];
        found[i - 1] = swapped;
      }
    }
  }
  // A peak of the histogram that is weak as a direction was the narrow bins' doing.
  int strong = 0;
  while (strong < count && found[strong].strength >= kPeakShare * found[0].strength) ++strong;
  return strong;
}

// Frames about one dominant direction: by the angle of what lies across it.
int add_tilts(const Grid& level, const Vec3f& voxel, float sigma, const Vec3f& x_axis,
              Mat3f (&frames)[kMaxOrientations], int count) {
  const Vec3f helper = std::fabs(x_axis.z) < 0.7f ? Vec3f{0, 0, 1} : Vec3f{1, 0, 0};
  const Vec3f u = normalized(cross(helper, x_axis)), v = cross(x_axis, u);
  Vec3f sums[kTilts]{};
  float weights[kTilts]{};
  for_window(level, voxel, sigma, [&](const Vec3f& g, float w) {
    const float a = dot(g, u), b = dot(g, v);
    const float length = std::sqrt(a * a + b * b);
    if (length < kNoGradient) return;
    const int bin = static_cast<int>((coarse_arc_tan2(b, a) + kPif) / (2 * kPif) * kTilts) % kTilts;
    weights[bin] += w * length;
    sums[bin] += (u * a + v * b) * w;
  });
  float smooth[kTilts], most = 0, total = 0;
  for (int i = 0; i < kTilts; ++i) {
    smooth[i] = weights[(i + kTilts - 1) % kTilts] + weights[i] + weights[(i + 1) % kTilts];
    most = smooth[i] > most ? smooth[i] : most;
    total += smooth[i];
  }
  constexpr float kStandsOut = 1.3f;  // times what every angle has on average
  if (!(most > kStandsOut * total / kTilts)) return count;
  int tilts = 0;
  for (int i = 0; i < kTilts && count < kMaxOrientations && tilts < kMaxTilts; ++i) {
    const float before = smooth[(i + kTilts - 1) % kTilts], after = smooth[(i + 1) % kTilts];
    if (smooth[i] < kPeakShare * most || before > smooth[i] || after >= smooth[i]) continue;
    const Vec3f y_axis = normalized(sums[(i + kTilts - 1) % kTilts] + sums[i] + sums[(i + 1) % kTilts]);
    frames[count++] = Mat3f::from_columns(x_axis, y_axis, cross(x_axis, y_axis));
    ++tilts;
  }
  return count;
}

}  // namespace

int find_orientations(const Grid& level, const Vec3f& voxel, float sigma, Mat3f (&frames)[kMaxOrientations]) {
  Direction directions[kMaxDirections]{};
  const int dominant = find_directions(level, voxel, sigma, directions);
  int count = 0;
  for (int i = 0; i < dominant && count < kMaxOrientations; ++i)
    count = add_tilts(level, voxel, sigma, directions[i].d, frames, count);
  return count;
}

}  // namespace st
