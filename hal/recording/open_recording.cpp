#include "hal/recording/open_recording.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "hal/error.hpp"
#include "hal/recording/camera_file.hpp"
#include "hal/recording/fakenect_index.hpp"
#include "hal/recording/fakenect_reader.hpp"
#include "hal/recording/replay_source.hpp"
#include "hal/recording/tum_list.hpp"
#include "hal/recording/tum_reader.hpp"

namespace st {
namespace {

namespace fs = std::filesystem;

constexpr double kDefaultPeriod_s = 1.0 / 30.0;
constexpr std::size_t kPeriodSamples = 256;

// What the list of frames alone tells.
struct Survey {
  std::uint64_t depth_lines = 0, color_lines = 0;
  std::vector<double> steps_s;  // between the first depth stamps

  void add_step(double step_s) {
    if (steps_s.size() < kPeriodSamples && step_s > 0) steps_s.push_back(step_s);
  }
  // The step that a share of `quantile` lies below.
  double period_s(double quantile) {
    if (steps_s.size() < 3) return kDefaultPeriod_s;
    std::sort(steps_s.begin(), steps_s.end());
    return steps_s[static_cast<std::size_t>(quantile * static_cast<double>(steps_s.size() - 1))];
  }
};

Survey survey_fakenect(const std::string& folder) {
  Survey survey;
  LineReader lines;
  lines.open(folder + "/INDEX.txt");
  std::string_view line;
  std::uint32_t last_ticks = 0;
  while (lines.next(line)) {
    IndexEntry entry;
    if (parse_index_line(line, entry) != LineKind::kEntry) continue;
    if (entry.type == 'r') ++survey.color_lines;
    if (entry.type != 'd') continue;
    const auto elapsed = static_cast<std::int32_t>(entry.ticks - last_ticks);
    if (survey.depth_lines++ > 0) survey.add_step(elapsed / kKinectTicksPerSecond);
    last_ticks = entry.ticks;
  }
  return survey;
}

Survey survey_tum(const std::string& folder) {
  Survey survey;
  LineReader depth, color;
  depth.open(folder + "/depth.txt");
  color.open(folder + "/rgb.txt");
  std::string_view line;
  double last_t_s = 0;
  while (depth.next(line)) {
    ListEntry entry;
    if (parse_list_line(line, entry) != LineKind::kEntry) continue;
    if (survey.depth_lines++ > 0) survey.add_step(entry.t_s - last_t_s);
    last_t_s = entry.t_s;
  }
  while (color.next(line)) {
    ListEntry entry;
    if (parse_list_line(line, entry) == LineKind::kEntry) ++survey.color_lines;
  }
  return survey;
}

CameraKind kind_of_folder(const std::string& folder) {
  std::error_code error;
  const fs::file_status status = fs::status(folder, error);
  if (!fs::exists(status))
    throw Failure(
        ExitCode::kBadInput,
        folder + ": no such recording; SRC is kinect[:INDEX or SERIAL], sim:SCENE or a recording's folder");
  if (!fs::is_directory(status))
    throw Failure(ExitCode::kBadInput,
                  folder + ": is a file; give the folder of the recording (unpack an archive first)");
  LineReader fakenect, tum;
  if (fakenect.open(folder + "/INDEX.txt")) return CameraKind::kKinect;
  if (tum.open(folder + "/depth.txt")) return CameraKind::kTum;
  const bool is_empty = fs::is_empty(folder, error);
  throw Failure(ExitCode::kBadInput,
                folder + (is_empty && !error ? ": is empty" : ": holds no readable recording") +
                    "; expected INDEX.txt (fakenect) or depth.txt (TUM RGB-D) in it");
}

void choose_calibration(const SourceOptions& options, CameraKind kind, const Survey& survey,
                        SourceInfo& info) {
  const std::string beside = options.spec + "/camera.toml";
  const std::string file = !options.camera_file.empty() ? options.camera_file
                           : fs::exists(beside)         ? beside
                                                        : std::string();
  const Calibration preset = default_calibration(kind);
  if (file.empty()) {
    info.calibration = preset;
    info.calibration_note =
        kind == CameraKind::kTum
            ? "no camera.toml: taking 525/525/319.5/239.5, depth scale 5000, registered colour"
            : "no camera.toml: taking the default calibration of a Kinect (several pixels off)";
    return;
  }
  info.calibration = read_camera_file(file, kind);
  if (info.calibration.has_color || survey.color_lines == 0) return;
  Calibration& calibration = info.calibration;
  calibration.has_color = true;
  calibration.color_registered = preset.color_registered;
  calibration.color = preset.color_registered ? calibration.depth : preset.color;
  calibration.T_color_depth = preset.T_color_depth;
  info.calibration_note =
      file + " has no [color]: taking " +
      (preset.color_registered ? "colour as registered" : "the default colour camera of a Kinect");
}

std::unique_ptr<RecordingReader> make_reader(CameraKind kind, const SourceInfo& info,
                                             const OdometryDecoder& decoder) {
  if (kind == CameraKind::kTum)
    return std::make_unique<TumReader>(info.name, info.calibration, info.frame_period_s, decoder);
  return std::make_unique<FakenectReader>(info.name, info.calibration, info.frame_period_s, decoder);
}

// Reads on until it is sure that there are two usable frames, with colour of the right size where there is
// colour.
void require_usable(RecordingReader& reader, const SourceInfo& info, const Survey& survey) {
  if (survey.depth_lines == 0)
    throw Failure(ExitCode::kBadInput,
                  info.name + ": no depth frame is listed; record again, or check the list of frames");
  FrameSlot slot;
  while (reader.usable() < 2 && reader.read(slot)) {
  }
  if (reader.usable() < 2) {
    const std::string first = reader.first_damage().empty() ? "" : "; " + reader.first_damage();
    throw Failure(ExitCode::kBadInput, info.name + ": " + std::to_string(reader.usable()) +
                                           " usable depth frames of " + std::to_string(survey.depth_lines) +
                                           ", 2 are needed" + first);
  }
  if (!reader.color_size_damage().empty())
    throw Failure(ExitCode::kBadInput, info.name + ": " + reader.color_size_damage());
}

}  // namespace

std::string short_source_name(const std::string& name) {
  std::string text;
  for (const char c : name) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (plain) text += c;
    if (!plain && !text.empty() && text.back() != '-') text += '-';
  }
  while (!text.empty() && text.back() == '-') text.pop_back();
  return text.empty() ? "source" : text;
}

std::unique_ptr<FrameSource> open_recording(const SourceOptions& options, const OdometryDecoder& decoder) {
  SourceInfo info;
  info.name = options.spec;
  const CameraKind kind = kind_of_folder(options.spec);
  info.short_name = short_source_name(fs::weakly_canonical(options.spec).filename().string());
  Survey survey = kind == CameraKind::kTum ? survey_tum(options.spec) : survey_fakenect(options.spec);
  // Lost frames only lengthen steps, so ticks, which do not jitter, are judged low; host stamps by their
  // middle.
  info.frame_period_s = survey.period_s(kind == CameraKind::kTum ? 0.5 : 0.25);
  info.expected_frames = survey.depth_lines;
  choose_calibration(options, kind, survey, info);
  require_usable(*make_reader(kind, info, {}), info, survey);
  std::unique_ptr<RecordingReader> reader = make_reader(kind, info, decoder);
  info.wheel_base_m = reader->wheel_base_m();
  return std::make_unique<ReplaySource>(std::move(info), std::move(reader), options.real_pace);
}

}  // namespace st
