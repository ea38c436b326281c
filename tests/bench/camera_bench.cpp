// Times of the camera's alignment in a room of three walls, 320x240, per vector set:
//   build/startrack_bench --benchmark_filter=Camera
#include <benchmark/benchmark.h>

#include "algo/core/simd.hpp"
#include "algo/tracking/camera_align.hpp"
#include "tests/algo/tracking/corner_room.hpp"

namespace {

using namespace st;
using namespace st::test;

void CameraAlign(benchmark::State& state) {
  const auto names = supported_simd();
  const auto which = static_cast<std::size_t>(state.range(0));
  if (which >= names.size()) {
    state.SkipWithError("not on this CPU");
    return;
  }
  select_simd(names[which]);
  state.SetLabel(names[which]);
  const Pose moved{rotation_from_vector({0.01, -0.01, 0.005}), {0.01, -0.01, 0.01}};
  const RoomFrame view(kCorner, Pose{}), frame(kCorner, moved);
  CameraAlignResult result;
  for (auto _ : state) result = align_camera({frame.depth, view.view, kRoomCamera, Pose{}, {}});
  state.counters["pixels"] = static_cast<double>(result.pixels_visited);
}

BENCHMARK(CameraAlign)->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

}  // namespace
