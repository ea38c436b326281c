#include "hal/recording/tum_reader.hpp"

#include "hal/recording/png_image.hpp"
#include "hal/recording/tum_list.hpp"

namespace st {
namespace {

// What is wrong with an image of this size, when the calibration says another; empty when nothing is.
std::string size_mismatch(const ImageVerdict& verdict, const Intrinsics& camera) {
  if (verdict.width == camera.width && verdict.height == camera.height) return {};
  return std::to_string(verdict.width) + "x" + std::to_string(verdict.height) + " pixels, calibration says " +
         std::to_string(camera.width) + "x" + std::to_string(camera.height) + "; give its camera by --camera";
}

}  // namespace

TumReader::TumReader(const std::string& folder, const Calibration& calibration, double period_s,
                     const OdometryDecoder& decoder)
    : RecordingReader(folder, calibration, period_s, decoder) {
  depth_list_.open(path_of("depth.txt"));
  if (calibration.has_color) color_list_.open(path_of("rgb.txt"));
}

bool TumReader::next_entry(LineReader& lines, Stream stream, std::optional<double>& last_t_s, Image& image) {
  const char* list = stream == Stream::kDepth ? "depth.txt" : "rgb.txt";
  std::string_view line;
  while (lines.next(line)) {
    ListEntry entry;
    const LineKind kind = parse_list_line(line, entry);
    if (kind == LineKind::kForeign)
      note_damage(last_t_s.value_or(0), DamageReason::kForeign, stream, list,
                  "a line is not `timestamp path` with a path inside the recording");
    if (kind != LineKind::kEntry) continue;
    if (last_t_s && entry.t_s <= *last_t_s) {
      note_damage(entry.t_s, DamageReason::kBackwards, stream, std::string(entry.path),
                  "its stamp is not after the one before");
      continue;
    }
    image = {entry.t_s, std::string(entry.path)};
    return true;
  }
  return false;
}

bool TumReader::read_frame(FrameSlot& slot) {
  Image image;
  while (next_entry(depth_list_, Stream::kDepth, depth_t_s_, image)) {
    std::span<const std::uint8_t> file;
    if (!load(image.t_s, Stream::kDepth, image.path, file)) continue;
    ImageVerdict verdict = decode_png_depth(file, slot.depth);
    if (verdict.ok) {
      verdict.what = size_mismatch(verdict, calibration().depth);
      verdict.reason = DamageReason::kWrongSize;
    }
    if (!verdict.what.empty()) {
      note_damage(image.t_s, verdict.reason, Stream::kDepth, image.path, verdict.what);
      continue;
    }
    depth_t_s_ = image.t_s;
    FrameInput& frame = slot.frame;
    frame.t_s = frame.device_t_s = image.t_s;
    attach_color(frame);
    if (has_robot_log()) pump_robot_until_time(frame.t_s);
    return true;
  }
  return false;
}

bool TumReader::decode_color(const Image& image) {
  std::span<const std::uint8_t> file;
  if (!load(image.t_s, Stream::kColor, image.path, file)) return false;
  ImageVerdict verdict = decode_png_color(file, next_color_buffer());
  const std::string mismatch = size_mismatch(verdict, calibration().color);
  if (verdict.width > 0 && !mismatch.empty()) {
    verdict.reason = DamageReason::kWrongSize;
    verdict.what = mismatch;
  }
  if (!verdict.what.empty()) {
    note_damage(image.t_s, verdict.reason, Stream::kColor, image.path, verdict.what);
    return false;
  }
  use_color();
  color_shown_t_s_ = image.t_s;
  has_color_ = true;
  return true;
}

// The newest image not later than the frame. An image that turns out damaged leaves the one before it shown.
void TumReader::attach_color(FrameInput& frame) {
  Image newest, before;
  bool has_newest = false, has_before = false;
  for (;;) {
    if (!has_color_ahead_) {
      if (!next_entry(color_list_, Stream::kColor, color_t_s_, color_ahead_)) break;
      color_t_s_ = color_ahead_.t_s;
      has_color_ahead_ = true;
    }
    if (color_ahead_.t_s > frame.t_s) break;
    before = newest;
    has_before = has_newest;
    newest = color_ahead_;
    has_newest = true;
    has_color_ahead_ = false;
  }
  frame.color_is_new = (has_newest && decode_color(newest)) || (has_before && decode_color(before));
  if (!has_color_) return;
  frame.color = color_view();
  frame.color_device_t_s = color_shown_t_s_;
}

}  // namespace st
