// Times of the volume's stages for an object of about 21,000 pixels, per vector set:
//   build/startrack_bench --benchmark_filter=Volume
#include <benchmark/benchmark.h>

#include <memory>

#include "algo/core/simd.hpp"
#include "tests/algo/volume/analytic_view.hpp"

namespace {

using namespace st;
using namespace st::test;

// A floor robot's disc, 12 views around it already fused; the frame that is timed is the next one.
struct Fused {
  explicit Fused(int side) : bench(side) {
    const Disc disc(0.17, 0.045);
    std::mt19937 random(1);
    Rendering how;
    how.noise = 0.5;
    how.paint = [](const Vec3& p) { return pack_rgb(static_cast<std::uint8_t>(128 + 300 * p.x), 90, 60); };
    const float voxel_m = 0.5f / static_cast<float>(side);
    bench.volume.reset(voxel_m, 0.016f, {0, 0, 0});
    for (int i = 0; i < 13; ++i) {
      view = render(disc, looking_at(1.0, 0.5 * i, 0.7), how, random);
      if (i < 12) bench.fuse(view);
    }
  }
  Bench bench;
  View view;
};

Fused& fused(int side) {
  static std::unique_ptr<Fused> kept;
  if (kept == nullptr || kept->bench.volume.side != side) kept = std::make_unique<Fused>(side);
  return *kept;
}

bool choose(benchmark::State& state) {
  const auto names = supported_simd();
  const auto which = static_cast<std::size_t>(state.range(1));
  if (which >= names.size()) {
    state.SkipWithError("not on this CPU");
    return false;
  }
  select_simd(names[which]);
  state.SetLabel(names[which]);
  return true;
}

void VolumeIntegrate(benchmark::State& state) {
  Fused& f = fused(static_cast<int>(state.range(0)));
  if (!choose(state)) return;
  IntegrateStats stats;
  for (auto _ : state) stats = f.bench.fuse(f.view);
  state.counters["pixels"] = stats.surface_pixels;
  state.counters["bricks"] = stats.bricks;
  state.counters["updated"] = stats.updated;
  state.counters["colored"] = stats.colored;
}

void VolumeEvidence(benchmark::State& state) {
  Fused& f = fused(static_cast<int>(state.range(0)));
  if (!choose(state)) return;
  for (auto _ : state)
    f.bench.integrating.evidence.evaluate(f.view.input(), {}, f.view.T_camera_object, {-1, -1, -1},
                                          {1, 1, 1});
}

void VolumeRaycast(benchmark::State& state) {
  Fused& f = fused(static_cast<int>(state.range(0)));
  if (!choose(state)) return;
  RaycastStats stats;
  for (auto _ : state)
    stats = raycast(f.bench.volume, f.view.camera, f.view.roi, f.view.T_camera_object, f.bench.raycasting,
                    f.bench.maps);
  state.counters["rays"] = stats.rays;
  state.counters["hits"] = stats.hits;
}

const std::vector<std::vector<std::int64_t>> kSizes{{128, 256}, {0, 1, 2, 3}};
BENCHMARK(VolumeEvidence)->ArgsProduct(kSizes)->Unit(benchmark::kMillisecond);
BENCHMARK(VolumeIntegrate)->ArgsProduct(kSizes)->Unit(benchmark::kMillisecond);
BENCHMARK(VolumeRaycast)->ArgsProduct(kSizes)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
