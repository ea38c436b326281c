// Times of 3-D SIFT by step, on 64 and 128 voxels a side, of matching against 1, 10 and 100 models, and of
// the other slices of a recognition:
//   build/startrack_bench --benchmark_filter=Sift
#include <benchmark/benchmark.h>

#include <memory>
#include <random>

#include "algo/recognition/match.hpp"
#include "algo/recognition/volume_fit.hpp"
#include "algo/volume/packed_volume.hpp"
#include "tests/algo/recognition/blob_volume.hpp"
#include "tests/algo/volume/analytic_view.hpp"

namespace {

using namespace st;
using namespace st::test;

// As many details in a larger volume as in a small one, at the same scale.
SiftBench& filled(int side) {
  static std::unique_ptr<SiftBench> kept;
  if (kept == nullptr || kept->sift.input().side != side) {
    kept = std::make_unique<SiftBench>(side);
    kept->fill(random_blobs(80, 4));
  }
  return *kept;
}

void until(Sift3d& sift, Sift3d::Stage stage) {
  while (sift.stage() != stage) sift.step();
}

void SiftScaleSpace(benchmark::State& state) {
  Sift3d& sift = filled(static_cast<int>(state.range(0))).sift;
  for (auto _ : state) {
    sift.start();
    until(sift, Sift3d::Stage::kExtrema);
  }
}

void SiftExtrema(benchmark::State& state) {
  Sift3d& sift = filled(static_cast<int>(state.range(0))).sift;
  for (auto _ : state) {
    state.PauseTiming();
    sift.start();
    until(sift, Sift3d::Stage::kExtrema);
    state.ResumeTiming();
    until(sift, Sift3d::Stage::kDescribe);
  }
  state.counters["keypoints"] = static_cast<double>(sift.keypoints().size());
}

void SiftFramesAndDescriptors(benchmark::State& state) {
  Sift3d& sift = filled(static_cast<int>(state.range(0))).sift;
  for (auto _ : state) {
    state.PauseTiming();
    sift.start();
    until(sift, Sift3d::Stage::kDescribe);
    state.ResumeTiming();
    until(sift, Sift3d::Stage::kDone);
  }
  const double features = static_cast<double>(sift.features().features.size());
  state.counters["features"] = features;
  state.counters["per_feature"] = benchmark::Counter(
      features, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void SiftOneOrientation(benchmark::State& state) {
  Sift3d& sift = filled(64).sift;
  sift.start();
  until(sift, Sift3d::Stage::kDescribe);
  const Keypoint& k = sift.keypoints()[0];
  Mat3f frames[kMaxOrientations];
  for (auto _ : state)
    benchmark::DoNotOptimize(
        find_orientations(sift.scale_space().levels[k.octave][k.level], k.voxel, k.sigma, frames));
}

// 80 features of the object against so many models of 100 each.
void SiftMatching(benchmark::State& state) {
  Sift3d& sift = filled(64).sift;
  sift.start();
  until(sift, Sift3d::Stage::kDone);
  const FeatureSet one = sift.features();
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;
  for (std::size_t i = 0; i < 100; ++i) {
    features.push_back(one.features[i % one.features.size()]);
    features.back().keypoint = static_cast<int>(i);
    descriptors.push_back(one.descriptors[i % one.descriptors.size()]);
  }
  const std::size_t seen = std::min<std::size_t>(80, one.features.size());
  const FeatureSet object{one.features.first(seen), one.descriptors.first(seen)},
      model{features, descriptors};
  Matcher matcher;
  const BoundMemory memory([&](Bump& bump) { matcher.bind(bump); });
  Matches matches;
  for (auto _ : state)
    for (std::int64_t m = 0; m < state.range(0); ++m) {
      matcher.start(object, model);
      while (!matcher.step()) {
      }
      matcher.finish(kMatchRatio, matches);
    }
}

struct Robot {
  Robot() : bench(128), spare(128), points(kFitPoints), scratch(kFitPoints) {
    bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
    spare.volume.reset(0.004f, 0.016f, {0, 0, 0});
    std::mt19937 random(1);
    for (int i = 0; i < 12; ++i)
      bench.fuse(render(Disc(0.17, 0.045), looking_at(1.0, 0.5 * i, 0.7), {}, random));
    bricks.resize(count_packed(bench.volume));
    packed = pack(bench.volume, bricks);
    points.resize(sample_surface(bench.volume, points, scratch).points);
  }
  Bench bench, spare;
  std::vector<PackedBrick> bricks;
  PackedVolume packed;
  std::vector<SurfacePoint> points;
  std::vector<Vec3f> scratch;
};

void SiftUnpackModel(benchmark::State& state) {
  Robot robot;
  for (auto _ : state) benchmark::DoNotOptimize(unpack(robot.packed, robot.spare.volume));
}

void SiftSurfacePoints(benchmark::State& state) {
  Robot robot;
  std::vector<SurfacePoint> points(kFitPoints);
  std::vector<Vec3f> scratch(kFitPoints);
  for (auto _ : state) benchmark::DoNotOptimize(sample_surface(robot.bench.volume, points, scratch));
}

void SiftOneHeading(benchmark::State& state) {
  Robot robot;
  for (auto _ : state) {
    Pose start;
    start_from_silhouette(robot.points, robot.points, {1, 0, 0}, 0.1, start);
    benchmark::DoNotOptimize(fit_to_volume(robot.bench.volume, {robot.points}, start, 8));
  }
}

}  // namespace

BENCHMARK(SiftScaleSpace)->Arg(64)->Arg(128)->Unit(benchmark::kMillisecond);
BENCHMARK(SiftExtrema)->Arg(64)->Arg(128)->Unit(benchmark::kMillisecond);
BENCHMARK(SiftFramesAndDescriptors)->Arg(64)->Arg(128)->Unit(benchmark::kMillisecond);
BENCHMARK(SiftOneOrientation)->Unit(benchmark::kMillisecond);
BENCHMARK(SiftMatching)->Arg(1)->Arg(10)->Arg(100)->Unit(benchmark::kMillisecond);
BENCHMARK(SiftUnpackModel)->Unit(benchmark::kMillisecond);
BENCHMARK(SiftSurfacePoints)->Unit(benchmark::kMillisecond);
BENCHMARK(SiftOneHeading)->Unit(benchmark::kMillisecond);
