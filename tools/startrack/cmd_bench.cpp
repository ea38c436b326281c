// startrack bench: this machine's timing table over a recording, beside what its memory would allow.
#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "algo/volume/voxel.hpp"
#include "hal/clock.hpp"
#include "hal/results/line_file.hpp"
#include "tools/startrack/session_command.hpp"

namespace st {
namespace {

using Json = nlohmann::json;

// Bytes a second that one thread reads from memory: the best of some passes over more than any cache holds.
double read_bandwidth() {
  constexpr std::size_t kWords = std::size_t{16} << 20;  // 128 MiB
  const std::vector<std::uint64_t> memory(kWords, 1);
  double best = 0;
  std::uint64_t sum = 0;
  for (int pass = 0; pass < 5; ++pass) {
    const std::int64_t begin = system_clock().monotonic_ns();
    for (const std::uint64_t word : memory) sum += word;
    const double seconds = static_cast<double>(system_clock().monotonic_ns() - begin) * 1e-9;
    const double rate = static_cast<double>(kWords * sizeof(std::uint64_t)) / seconds;
    if (rate > best) best = rate;
  }
  return sum == 0 ? 0 : best;  // the sum is used, so that it is computed
}

// The least that a stage of scan mode has to move, bytes a frame: every array once for each pass over it.
double least_bytes(const std::string& stage, const Json& summary, double pixels) {
  if (summary["mode"] != "scan") return 0;
  // Stored value in, metres out; each half reads four and writes one.
  if (stage == "preprocess") return pixels * (2 + 4 + 1.25 * (4 + 1));
  // Guess, depth out and in again, normal and weight out; two cells of eight voxels, one weight.
  if (stage == "render") return pixels * (4 + 4 + 4 + 4 + 4 + 1 + 2 * 8 * 2 + 1);
  // Depth, and the depth and normal of the view.
  if (stage == "align") return summary["scan"]["pixels_aligned_mean"].get<double>() * 12;
  // Evidence: depth in, copied, read; record out and in. Then distance, weight and count of each voxel, in
  // and out.
  const double voxels =
      summary["scan"]["bricks_fused_mean"].get<double>() * kBrickSide * kBrickSide * kBrickSide;
  return stage == "integrate" ? pixels * (4 + 4 + 4 + 8 + 8) + voxels * 2 * (2 + 1 + 1) : 0;
}

void print_row(const std::string& name, const Json& us, double bytes, double rate) {
  std::printf("  %-12s", name.c_str());
  for (const char* quantile : {"p50", "p99", "p999", "max"})
    std::printf(" %8.3f", us[quantile].get<double>() / 1000);
  const double p50_s = us["p50"].get<double>() * 1e-6, least_s = bytes / rate;
  if (bytes > 0 && p50_s > 0)
    std::printf(" %9.2f %9.3f %7.0f %%", bytes / 1e6, least_s * 1e3, 100 * least_s / p50_s);
  std::printf("\n");
}

int bench(const SessionOptions& options) {
  const SessionResult result = run_session(options);
  if (!result.trouble.empty()) std::fprintf(stderr, "startrack: %s\n", result.trouble.c_str());
  const Json summary = Json::parse(read_whole_file(result.folder + "/summary.json"));
  const Intrinsics camera = open_source(options.source)->info().calibration.depth;
  const double rate = read_bandwidth(), pixels = static_cast<double>(camera.width) * camera.height;
  std::printf("  %s mode, %s, %dx%d, %llu frames; one thread reads %.1f GB/s\n",
              summary["mode"].get<std::string>().c_str(), summary["simd"].get<std::string>().c_str(),
              camera.width, camera.height, summary["frames"].get<unsigned long long>(), rate * 1e-9);
  std::printf("  %-12s %8s %8s %8s %8s %9s %9s %9s\n", "stage, ms", "p50", "p99", "p99.9", "max", "MB",
              "at least", "roofline");
  const Json& timing = summary["timing"];
  for (const auto& [name, us] : timing["stages"].items())
    if (us["max"].get<double>() > 0) print_row(name, us, least_bytes(name, summary, pixels), rate);
  print_row("frame, wall", timing["frame_us"], 0, rate);
  print_row("frame, CPU", timing["cpu_us"], 0, rate);
  std::printf("run: %s\n", result.folder.c_str());
  return static_cast<int>(result.code);
}

}  // namespace

void add_bench(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SessionOptions>();
  CLI::App* command = app.add_subcommand("bench", "Time every stage over a recording on this machine");
  command->footer("Example:\n  startrack bench kitchen-scan --mode scan --volume 256");
  command
      ->add_option("REC", options->source.spec, "folder with INDEX.txt (fakenect) or depth.txt (TUM RGB-D)")
      ->required();
  add_session_options(*command, *options);
  command->callback([options, &exit_code] { exit_code = bench(*options); });
}

}  // namespace st
