// startrack cut: an object out of a finished scan.
#include <cstdio>
#include <filesystem>
#include <memory>

#include "firmware_like/scene_cut.hpp"
#include "hal/error.hpp"
#include "hal/results/line_file.hpp"
#include "hal/results/tum_file.hpp"
#include "tools/startrack/commands.hpp"
#include "tools/startrack/out_file.hpp"

namespace st {
namespace {

struct CutOptions {
  std::string run;
  OutFile out;
  int cluster = 0;  // 0: the most central
  bool closed = false;
};

void print_clusters(const std::vector<Cluster>& clusters) {
  std::printf("  cluster   wide     high     triangles   off the camera's axis\n");
  for (std::size_t i = 0; i < clusters.size(); ++i)
    std::printf("  %-7zu %6.3f m %6.3f m   %9zu   %.3f m\n", i + 1, clusters[i].width_m, clusters[i].height_m,
                clusters[i].mesh.indices.size() / 3, clusters[i].off_centre_m);
}

void cut(const CutOptions& o) {
  constexpr float kHighestHole_m = 0.06f;
  if (!o.out.path.empty()) o.out.check(o.out.path);
  const std::string scene_file = o.run + "/scene.ply", pose_file = o.run + "/camera.tum";
  if (!std::filesystem::exists(scene_file))
    throw Failure(ExitCode::kBadInput,
                  o.run + ": has no scene.ply; make one with startrack replay REC --mode scan --out RUN");
  const Mesh scene = parse_ply(read_whole_file(scene_file), scene_file);
  std::vector<Pose> poses;
  for (const TumPose& pose : parse_tum(read_whole_file(pose_file)).poses) poses.push_back(pose.T);
  const SupportPlane plane = find_support(scene.view());
  if (!plane.found)
    throw Failure(ExitCode::kBadInput,
                  scene_file + ": no floor or table to cut from; scan more of what the object stands on");
  const std::vector<Cluster> clusters = find_clusters(scene.view(), plane, poses);
  if (clusters.empty())
    throw Failure(ExitCode::kBadInput,
                  scene_file + ": nothing stands on the plane; scan nearer, or with a smaller --extent");
  print_clusters(clusters);
  if (o.out.path.empty()) return;
  const auto chosen = static_cast<std::size_t>(o.cluster == 0 ? 1 : o.cluster);
  if (chosen > clusters.size())
    throw Failure(ExitCode::kBadInput, "--cluster " + std::to_string(o.cluster) + ": there are " +
                                           std::to_string(clusters.size()) + " clusters");
  Mesh object = in_own_frame(clusters[chosen - 1], plane);
  if (o.closed) close_bottom(object, kHighestHole_m);
  write_whole_file(o.out.path, format_ply(object.view()));
  std::printf("object: %s (cluster %zu)\n", o.out.path.c_str(), chosen);
}

}  // namespace

void add_cut(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CutOptions>();
  CLI::App* command = app.add_subcommand("cut", "Cut an object out of a finished scan");
  command->add_option("RUN", options->run, "run folder of replay or run --mode scan")->required();
  options->out.add_options(*command, "PLY file of the object; without it the clusters are only listed",
                           "FILE");
  command->add_option("--cluster", options->cluster, "which one (default: the most central)")
      ->check(CLI::Range(1, 1000));
  command->add_flag("--close-bottom", options->closed,
                    "go on with the walls down to the plane and close them there");
  command->footer("Example:\n  startrack cut runs/scan --out create.ply --close-bottom");
  command->callback([options, &exit_code] {
    cut(*options);
    exit_code = static_cast<int>(ExitCode::kDone);
  });
}

}  // namespace st
