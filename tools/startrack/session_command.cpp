#include "tools/startrack/session_command.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

#include "hal/recording/text.hpp"
#include "tools/report/run_report.hpp"
#include "tools/startrack/model_picture.hpp"
#include "tools/startrack/run_table.hpp"

namespace st {
namespace {

struct Term {
  const char* name;
  bool LoopConfig::*used;
};
constexpr Term kTerms[] = {{"edges", &LoopConfig::use_contour},   {"colour", &LoopConfig::use_color},
                           {"floor", &LoopConfig::use_floor},     {"motion", &LoopConfig::use_motion},
                           {"odometry", &LoopConfig::use_wheels}, {"cleaning", &LoopConfig::use_cleaning}};

void leave_out(LoopConfig& config, const std::string& name) {
  for (const Term& term : kTerms) {
    if (name != term.name) continue;
    config.*term.used = false;
    return;
  }
  throw Failure(ExitCode::kBadInput, "--without " + name +
                                         ": no such term; there are edges, colour, floor, motion, odometry, "
                                         "cleaning");
}

// "x1,y1;x2,y2;..."
void read_arena(LoopConfig& config, const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    throw Failure(ExitCode::kBadInput, "--arena " + text + ": " + why +
                                           "; give three to sixteen corners in metres, such as "
                                           "\"0.5,-1;3,-1;3,1;0.5,1\"");
  };
  config.arena.clear();
  std::string_view rest = text;
  while (!rest.empty()) {
    const std::string_view corner = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(corner.size() + 1, rest.size()));
    const std::size_t comma = corner.find(',');
    PlanePoint p;
    if (comma == std::string_view::npos || !parse_number(trimmed(corner.substr(0, comma)), p.x_m) ||
        !parse_number(trimmed(corner.substr(comma + 1)), p.y_m))
      refuse("`" + std::string(corner) + "` is no corner");
    if (!config.arena.push_back(p)) refuse("too many corners");
  }
  if (config.arena.size() < 3) refuse("that is no area");
}

}  // namespace

void add_session_options(CLI::App& command, SessionOptions& options) {
  command.add_option("--path", options.path_file, "the preset path: TOML program or CSV way points")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--mode",
          [&options](const std::string& name) {
            options.loop.mode = name == "scan" ? Mode::kScan : Mode::kObject;
          },
          "object: the camera stands, what moves is tracked; scan: the camera moves through a still scene")
      ->check(CLI::IsMember({"object", "scan"}))
      ->type_name("MODE");
  command
      .add_option_function<std::string>(
          "--tracker",
          [&options](const std::string& name) {
            if (name == "star") {
              options.loop.tracker = TrackerKind::kStar;
            } else if (name == "frame-to-frame") {
              options.loop.tracker = TrackerKind::kFrameToFrame;
            } else if (name == "listing1") {
              options.loop.tracker = TrackerKind::kListing1;
            } else if (name == "recognition") {
              options.loop.tracker = TrackerKind::kRecognition;
            } else if (name == "sift") {
              options.loop.tracker = TrackerKind::kSiftMotion;
            } else {
              throw Failure(ExitCode::kBadInput,
                            "--tracker " + name +
                                ": no such tracker; there are star, listing1, frame-to-frame, "
                                "recognition, sift");
            }
            options.tracker_name = name;
          },
          "star (frame to updated model, all terms), listing1 (the paper as printed: closest-point ICP "
          "against the "
          "updated model, no other term), frame-to-frame (its first approach), recognition (each frame alone "
          "against --models, pose from 3-D "
          "SIFT matches) or sift (matches with the frame before)")
      ->type_name("NAME");
  command
      .add_option(
          "--keyframes", options.loop.keyframe_every,
          "frame-to-frame: keep a frame as the reference for so many frames (0: each frame follows the last)")
      ->check(CLI::Range(0, 1000));
  command
      .add_option_function<std::vector<std::string>>(
          "--without",
          [&options](const std::vector<std::string>& names) {
            for (const std::string& name : names) leave_out(options.loop, name);
          },
          "leave pose terms out: edges (outline and free space), colour (the model's print), floor (height "
          "and "
          "upright of what rests on it), motion (the predicted pose as a prior), odometry (the turn that the "
          "wheels tell); these five leave projective ICP alone; cleaning: pixels at "
          "steps in depth count, too")
      ->delimiter(',')
      ->type_name("TERM[,TERM]");
  command
      .add_option("--camera", options.source.camera_file,
                  "calibration instead of the recording's camera.toml")
      ->type_name("FILE");
  command
      .add_option("--models", options.known.file,
                  "model database: what is in it is recognised, what is new is stored at the end")
      ->type_name("DB");
  command
      .add_option_function<std::string>(
          "--recognise",
          [&options](const std::string& way) {
            options.loop.recognition =
                way == "sift" ? RecognitionWay::kMatchesAlone : RecognitionWay::kMatchesAndHeadings;
          },
          "where the pose of a known object may come from: sift (3-D SIFT matches alone, as in the paper) or "
          "both (every heading is tried as well)")
      ->check(CLI::IsMember({"sift", "both"}))
      ->default_str("both");
  command
      .add_option("--volume", options.loop.volume_side,
                  "voxels a side of each volume (default: 128; scan: 256)")
      ->check(CLI::IsMember({128, 192, 256, 384, 512}));
  command
      .add_option("--extent", options.loop.place.extent_m,
                  "scan: side of the volume in metres (default: from what the first frame shows)")
      ->check(CLI::Range(0.3, 20.0))
      ->type_name("METRES");
  command
      .add_option_function<std::vector<double>>(
          "--centre",
          [&options](const std::vector<double>& at) {
            options.loop.place.has_centre = true;
            for (std::size_t i = 0; i < 3; ++i) options.loop.place.centre_m[i] = at[i];
          },
          "scan: middle of the volume, metres from the first camera: right, down, ahead")
      ->delimiter(',')
      ->expected(3)
      ->type_name("X,Y,Z");
  command.add_option("--simd", options.simd, "instruction set: SSSE3, SSE4, AVX2 or AVX3")->type_name("NAME");
  command
      .add_option_function<std::string>(
          "--arena", [&options](const std::string& text) { read_arena(options.loop, text); },
          "corners of the floor area outside of which no track starts, in metres from below the camera: x "
          "ahead, y to the left")
      ->type_name("X,Y;X,Y;...");
  command.add_option("--seconds", options.loop.seconds, "stop after so long")->check(CLI::NonNegativeNumber);
  command.add_option("--out", options.out, "run folder (default: runs/DATE-TIME-SOURCE)")->type_name("RUN");
  command.add_flag("--force", options.force, "replace the result files of an earlier run in --out");
}

int run_and_report(const SessionOptions& options) {
  SessionOptions with_picture = options;
  with_picture.known.picture = model_thumbnail;
  const SessionResult result = run_session(with_picture);
  if (!result.trouble.empty()) std::fprintf(stderr, "startrack: %s\n", result.trouble.c_str());
  if (result.folder.empty()) return static_cast<int>(result.code);
  print_run_table(result.folder, options.path_file);
  if (!options.path_file.empty()) std::printf("report: %s\n", write_report(result.folder).c_str());
  std::printf("run: %s\n", result.folder.c_str());
  return static_cast<int>(result.code);
}

}  // namespace st
