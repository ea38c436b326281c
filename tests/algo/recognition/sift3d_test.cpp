#include "algo/recognition/sift3d.hpp"

#include "algo/core/scalar_math.hpp"
#include "algo/recognition/blur_kernel.hpp"
#include "algo/recognition/match.hpp"
#include "algo/recognition/upright_fit.hpp"
#include "tests/algo/recognition/blob_volume.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;
using namespace st::test;

namespace {

void run_blurs(SiftBench& bench) {
  bench.sift.start();
  while (bench.sift.stage() == Sift3d::Stage::kBlur) bench.sift.step();
}

// Share of the keypoints of `a` that have one of `b` within `voxels` of where the copy put them.
double repeatability(const Sift3d& a, const Sift3d& b, const Copy& copy, double voxels) {
  int found = 0, looked_at = 0;
  for (const Keypoint& p : a.keypoints()) {
    const Vec3 at = copy(to_double(a.scale_space().levels[p.octave][p.level].position(p.voxel)));
    if (norm(at) > 24) continue;
    ++looked_at;
    bool near = false;
    for (const Keypoint& q : b.keypoints())
      near =
          near || norm(to_double(b.scale_space().levels[q.octave][q.level].position(q.voxel)) - at) < voxels;
    found += near ? 1 : 0;
  }
  return looked_at > 0 ? static_cast<double>(found) / looked_at : 0;
}

struct MatchCounts {
  int made = 0, right = 0;
};

MatchCounts match_counts(const FeatureSet& a, const FeatureSet& b, const Copy& copy, double voxels,
                         Matches& matches) {
  Matcher matcher;
  const BoundMemory memory([&](Bump& bump) { matcher.bind(bump); });
  matcher.start(a, b);
  while (!matcher.step()) {
  }
  matcher.finish(kMatchRatio, matches);
  MatchCounts counts;
  for (const Match& m : matches) {
    const Vec3 from = to_double(a.features[static_cast<std::size_t>(m.a)].p_m);
    const Vec3 to = to_double(b.features[static_cast<std::size_t>(m.b)].p_m);
    ++counts.made;
    counts.right += norm(copy(from) - to) < voxels ? 1 : 0;
  }
  return counts;
}

}  // namespace

TEST_GROUP(Sift3d){};

TEST(Sift3d, TheTapsSumToOneAndAreGaussian) {
  float taps[kMostTaps + 1];
  const int radius = gaussian_taps(2.0f, taps);
  LONGS_EQUAL(6, radius);
  float sum = taps[0];
  for (int k = 1; k <= radius; ++k) sum += 2 * taps[k];
  DOUBLES_EQUAL(1, static_cast<double>(sum), 1e-6);
  DOUBLES_EQUAL(std::exp(-0.5), static_cast<double>(taps[2] / taps[0]), 1e-5);
}

// G(s1) * G(s2) = G(sqrt(s1^2 + s2^2)): a blob of sigma s comes out of level k with sqrt(s^2 + s_k^2 -
// s_0^2).
TEST(Sift3d, ABlobStaysGaussianOnEveryLevel) {
  SiftBench bench;
  constexpr double kSigma = 2.5;
  const Vec3 centre{0.5, 0.5, 0.5};  // on a voxel of every octave's grid
  bench.fill({{centre, {kSigma, kSigma, kSigma}}});
  run_blurs(bench);
  const ScaleSpace& space = bench.sift.scale_space();
  for (int level = 0; level < kGaussians; ++level) {
    const Grid& grid = space.levels[0][level];
    const double blur = static_cast<double>(ScaleSpace::sigma_of(static_cast<float>(level)));
    const double variance =
        kSigma * kSigma + blur * blur - static_cast<double>(kNominalSigma * kNominalSigma);
    const double height = std::pow(kSigma / std::sqrt(variance), 3);
    for (int off : {0, 2, 5}) {
      const double expected = height * std::exp(-0.5 * off * off / variance);
      DOUBLES_EQUAL(expected, static_cast<double>(grid(32 + off, 32, 32)), 0.015 * height);
      DOUBLES_EQUAL(expected, static_cast<double>(grid(32, 32, 32 - off)), 0.015 * height);
    }
  }
}

TEST(Sift3d, AConstantVolumeHasNoKeypoint) {
  SiftBench bench;
  for (float& v : bench.sift.input().values) v = 0.7f;
  LONGS_EQUAL(0, bench.run().features.size());
  LONGS_EQUAL(0, bench.sift.counts().extrema);
}

// At the middle of a blob of sigma s the DoG with blur t is t^2 / (s^2 + t^2 - n^2)^(5/2) to within a factor,
// n the blur that the input is taken to have: largest at t = sqrt(2/3 (s^2 - n^2)).
TEST(Sift3d, FindsBlobsAtTheirPlaceAndScale) {
  for (const double sigma : {3.2, 4.0, 6.5}) {
    SiftBench bench;
    const Vec3 centre{3.3, -5.1, 2.6};
    bench.fill({{centre, {sigma, sigma, sigma}}});
    bench.run();
    LONGS_EQUAL(1, bench.sift.keypoints().size());
    const Keypoint& best = bench.sift.keypoints()[0];
    const Grid& level = bench.sift.scale_space().levels[best.octave][best.level];
    CHECK_TRUE(norm(to_double(level.position(best.voxel)) - centre) < 0.5);
    const double nominal = static_cast<double>(kNominalSigma);
    const double expected = std::sqrt(2.0 / 3.0 * (sigma * sigma - nominal * nominal));
    const double found = static_cast<double>(best.sigma * level.voxel_m) * std::pow(2.0, 1.0 / 6);
    CHECK_TRUE(std::fabs(3 * std::log2(found / expected)) < 1.0);
  }
}

TEST(Sift3d, APlaneAndAnEdgeGiveNoKeypoint) {
  SiftBench plane, edge;
  plane.fill({{{}, {300, 300, 2.5}}});
  LONGS_EQUAL(0, plane.run().features.size());
  edge.fill({{{}, {300, 2.5, 2.5}}});
  LONGS_EQUAL(0, edge.run().features.size());
}

// The frame of a keypoint turns with the volume, in all three angles; checked where keypoints match.
TEST(Sift3d, FramesTurnWithTheVolume) {
  const std::vector<Blob> blobs = random_blobs(40, 21);
  SiftBench plain;
  plain.fill(blobs);
  const FeatureSet a = plain.run();
  for (const Vec3& turn :
       {Vec3{0, 0, kPi / 2}, Vec3{0, kPi / 2, 0}, Vec3{0.7, -0.4, 1.1}, Vec3{1.5, 1.2, -0.3}}) {
    const Copy copy{rotation_from_vector(turn)};
    SiftBench turned;
    turned.fill(blobs, copy);
    const FeatureSet b = turned.run();
    Matches matches;
    match_counts(a, b, copy, 2, matches);
    int close = 0;
    for (const Match& m : matches) {
      const Mat3f R = b.features[static_cast<std::size_t>(m.b)].R *
                      a.features[static_cast<std::size_t>(m.a)].R.transposed();
      Mat3 got;
      for (int k = 0; k < 9; ++k) got.m[k] = static_cast<double>(R.m[k]);
      close += rotation_angle(got * copy.R.transposed()) < 0.26 ? 1 : 0;  // 15 degrees
    }
    CHECK_TRUE(matches.size() >= 10);
    CHECK_TRUE(close >= 0.8 * static_cast<double>(matches.size()));
  }
}

// Two equal blobs on both sides of a third: two directions as strong as each other, so two frames at least.
TEST(Sift3d, AnAmbiguousNeighbourhoodHasSeveralFrames) {
  SiftBench bench;
  bench.fill({{{0, 0, 0}, {3, 3, 3}},
              {{7, 0, 0}, {2, 2, 2}},
              {{-7, 0, 0}, {2, 2, 2}},
              {{0, 5, 0}, {2, 2, 2}, {}, 0.3}});
  run_blurs(bench);
  Mat3f frames[kMaxOrientations];
  CHECK_TRUE(find_orientations(bench.sift.scale_space().levels[0][1], {31.5f, 31.5f, 31.5f}, 2.0f, frames) >=
             2);
}

TEST(Sift3d, ADescriptorHasUnitLengthAndIsCut) {
  SiftBench bench;
  bench.fill(random_blobs(20, 3));
  const FeatureSet set = bench.run();
  CHECK_TRUE(set.features.size() > 5);
  std::vector<float> histogram(kDescriptorLength);
  const Keypoint& keypoint = bench.sift.keypoints()[0];
  describe(bench.sift.scale_space().levels[keypoint.octave][keypoint.level], keypoint.voxel, keypoint.sigma,
           set.features[0].R, histogram);
  double sum = 0, most = 0;
  for (const float v : histogram) {
    CHECK_TRUE(v >= 0);
    sum += static_cast<double>(v * v);
    most = std::fmax(most, static_cast<double>(v));
  }
  DOUBLES_EQUAL(1, sum, 1e-4);
  CHECK_TRUE(most < 4 * static_cast<double>(kLargestElement));
}

// A plane's gradient, along the frame's x axis all over: azimuth bin 0, elevation bins 1 and 2, nothing else.
TEST(Sift3d, TheLayoutIsAsDocumented) {
  SiftBench bench;
  Grid& grid = bench.sift.input();
  for (int z = 0; z < grid.side; ++z)
    for (int y = 0; y < grid.side; ++y)
      for (int x = 0; x < grid.side; ++x) grid(x, y, z) = 0.01f * static_cast<float>(x);
  std::vector<float> histogram(kDescriptorLength);
  describe(grid, {32, 32, 32}, 2.0f, Mat3f{}, histogram);
  for (int cell = 0; cell < 64; ++cell)
    for (int bin = 0; bin < 32; ++bin) {
      const bool expected = bin == 8 || bin == 16;
      CHECK_EQUAL(expected, histogram[static_cast<std::size_t>(cell * 32 + bin)] > 0);
    }
}

TEST(Sift3d, TurnedScaledAndNoisyCopiesRepeatAndMatch) {
  const std::vector<Blob> blobs = random_blobs(40, 11);
  SiftBench original;
  original.fill(blobs);
  const FeatureSet a = original.run();
  CHECK_TRUE(a.features.size() >= 15);
  struct Case {
    const char* name;
    Copy copy;
    double least_repeated, least_right;
  } cases[] = {
      {"a quarter turn about z", {rotation_z(kPi / 2)}, 0.95, 0.95},
      {"a turn about a slanted axis", {rotation_from_vector({0.5, 0.9, -0.6})}, 0.75, 0.85},
      {"a shift", {{}, 1, {2.4, -1.7, 0.6}}, 0.75, 0.9},
      {"a scale", {{}, 1.2}, 0.7, 0.8},
      {"noise", {{}, 1, {}, 0.03}, 0.75, 0.85},
      {"all of it", {rotation_from_vector({-0.3, 0.4, 1.9}), 1.1, {1, 0.5, -0.7}, 0.02}, 0.65, 0.75}};
  for (const Case& c : cases) {
    SiftBench other;
    other.fill(blobs, c.copy);
    const FeatureSet b = other.run();
    Matches matches;
    const MatchCounts counts = match_counts(a, b, c.copy, 2.0, matches);
    const double repeated = repeatability(original.sift, other.sift, c.copy, 1.5);
    const std::string told =
        StringFromFormat("%s: %.2f repeated, %d of %d matches right, %d features", c.name, repeated,
                         counts.right, counts.made, static_cast<int>(a.features.size()))
            .asCharString();
    CHECK_TRUE_TEXT(repeated >= c.least_repeated, told.c_str());
    CHECK_TRUE_TEXT(counts.made >= 8, told.c_str());
    CHECK_TRUE_TEXT(counts.right >= c.least_right * counts.made, told.c_str());
  }
}

TEST(Sift3d, AnotherThingHardlyMatches) {
  SiftBench one, other;
  one.fill(random_blobs(40, 11));
  other.fill(random_blobs(40, 12));
  const FeatureSet a = one.run(), b = other.run();
  Matches matches;
  match_counts(a, b, {}, 2, matches);
  CHECK_TRUE(matches.size() * 5 < a.features.size());
  CHECK_FALSE(fit_upright(a, b, matches, 2.0f).inliers >= 6);
}

TEST(Sift3d, MatchesGiveTheTurnAndShiftOfAnUprightThing) {
  const std::vector<Blob> blobs = random_blobs(40, 5);
  const Copy copy{rotation_z(2.2), 1, {3, -2, 0.5}};
  SiftBench original, moved;
  original.fill(blobs);
  moved.fill(blobs, copy);
  const FeatureSet a = original.run(), b = moved.run();
  Matches matches;
  match_counts(a, b, copy, 2, matches);
  const UprightFit fit = fit_upright(a, b, matches, 2.0f);
  CHECK_TRUE(fit.found);
  CHECK_TRUE(norm(fit.T_b_a.t - copy.shift) < 0.4);
  CHECK_TRUE(rotation_angle(fit.T_b_a.R * copy.R.transposed()) < 0.03);
}

TEST(Sift3d, TheSameVolumeGivesTheSameBytes) {
  const std::vector<Blob> blobs = random_blobs(30, 2);
  SiftBench first, second;
  first.fill(blobs);
  second.fill(blobs);
  const FeatureSet a = first.run(), b = second.run();
  LONGS_EQUAL(a.features.size(), b.features.size());
  for (std::size_t i = 0; i < a.features.size(); ++i)
    MEMCMP_EQUAL(a.descriptors[i].bytes, b.descriptors[i].bytes, kDescriptorLength);
}
