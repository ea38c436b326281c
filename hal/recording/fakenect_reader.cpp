#include "hal/recording/fakenect_reader.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cstring>

#include "hal/recording/pnm.hpp"
#include "hal/source/tilt_state.hpp"

namespace st {
namespace {

constexpr std::size_t kColorCandidates = 8;
constexpr std::uint16_t kNoReading = 2047;

std::string size_text(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

}  // namespace

FakenectReader::FakenectReader(const std::string& folder, const Calibration& calibration, double period_s,
                               const OdometryDecoder& decoder)
    : RecordingReader(folder, calibration, period_s, decoder) {
  index_.open(path_of("INDEX.txt"));
  frames_csv_.open(path_of("frames.csv"));
}

bool FakenectReader::read_frame(FrameSlot& slot) {
  std::string_view line;
  while (index_.next(line)) {
    IndexEntry entry;
    const LineKind kind = parse_index_line(line, entry);
    if (kind == LineKind::kForeign)
      note_damage(depth_clock_.host_s(), DamageReason::kForeign, Stream::kDepth, "INDEX.txt",
                  "a line is no name of the form d-SECONDS-TICKS.pgm");
    if (kind != LineKind::kEntry) continue;
    if (entry.type == 'r') note_color(entry);
    if (entry.type == 'a') tilt_name_ = entry.name;
    if (entry.type == 'd' && read_depth(entry, slot)) return true;
  }
  return false;
}

bool FakenectReader::read_depth(const IndexEntry& entry, FrameSlot& slot) {
  const std::string name(entry.name);
  std::span<const std::uint8_t> file;
  // The file first: the stamps of one that cannot be used must not move the clock.
  if (!load(entry.host_s, Stream::kDepth, name, file) || !decode_depth(entry, file, slot.depth)) return false;
  if (!depth_clock_.accept(entry.host_s, entry.ticks)) {
    note_damage(entry.host_s, DamageReason::kBackwards, Stream::kDepth, name,
                "its stamp is not after the one before");
    return false;
  }
  FrameInput& frame = slot.frame;
  frame.t_s = entry.host_s;
  frame.device_t_s = depth_clock_.device_t_s();
  const std::optional<FramesRow> row = frames_csv_.is_open() ? frames_csv_.find(entry.ticks) : std::nullopt;
  if (row) frame.recorded_level = row->level;
  if (calibration().has_color) attach_color(row ? &*row : nullptr, frame);
  attach_gravity(frame);
  if (!has_robot_log()) return true;
  if (row)
    pump_robot_until_offset(row->robot_log_offset);
  else
    pump_robot_until_time(frame.t_s);
  return true;
}

bool FakenectReader::decode_depth(const IndexEntry& entry, std::span<const std::uint8_t> file,
                                  std::vector<std::uint16_t>& depth) {
  const std::string name(entry.name);
  const Intrinsics& camera = calibration().depth;
  const auto refuse = [&](DamageReason reason, const std::string& what) {
    note_damage(entry.host_s, reason, Stream::kDepth, name, what);
    return false;
  };
  const std::optional<PnmHeader> header = parse_pnm_header(file);
  if (!header)
    return refuse(file.size() < 16 ? DamageReason::kShort : DamageReason::kForeign, "no PGM (P5) image");
  if (header->color || header->max_value <= 255)
    return refuse(DamageReason::kForeign,
                  "not 16-bit grey; depth is expected as 16-bit P5 of 11-bit Kinect values");
  if (header->width != camera.width || header->height != camera.height)
    return refuse(DamageReason::kWrongSize,
                  size_text(header->width, header->height) + " pixels, calibration says " +
                      size_text(camera.width, camera.height) + "; give its camera by --camera");
  const std::size_t pixels = header->pixel_bytes() / 2;
  if (file.size() - header->header_bytes < 2 * pixels) return refuse(DamageReason::kShort, "ends early");
  std::memcpy(depth.data(), file.data() + header->header_bytes, 2 * pixels);
  std::size_t above = 0, above_swapped = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const std::uint16_t value = depth[i], swapped = static_cast<std::uint16_t>(value << 8 | value >> 8);
    above += value > kNoReading;
    above_swapped += swapped > kNoReading;
    depth[i] = std::min(value, kNoReading);  // so that a stray bit never leaves an 11-bit table
  }
  if (above <= pixels / 1000) return true;
  return refuse(DamageReason::kForeign,
                above_swapped == 0 ? "byte order is swapped (big-endian); fakenect's files are little-endian"
                                   : "values above 2047: not raw 11-bit Kinect depth (millimetres?)");
}

void FakenectReader::note_color(const IndexEntry& entry) {
  if (!calibration().has_color) return;
  const std::string name(entry.name);
  // Frames that no depth frame will use are judged by their size alone, beside one that was good.
  struct stat info {};
  if (stat(path_of(name).c_str(), &info) != 0) {
    note_damage(entry.host_s, DamageReason::kMissing, Stream::kColor, name, "missing");
  } else if (info.st_size < good_color_bytes_) {
    note_damage(entry.host_s, DamageReason::kShort, Stream::kColor, name, "shorter than the others");
  } else if (!color_clock_.accept(entry.host_s, entry.ticks)) {
    note_damage(entry.host_s, DamageReason::kBackwards, Stream::kColor, name,
                "its stamp is not after the one before");
  } else {
    candidates_.push_back({name, entry.host_s, entry.ticks});
    if (candidates_.size() > kColorCandidates) candidates_.pop_front();
  }
}

void FakenectReader::attach_color(const FramesRow* row, FrameInput& frame) {
  const bool none_was_used = row != nullptr && !row->color_ticks;
  if (none_was_used) return;
  if (row != nullptr) {
    for (std::size_t i = candidates_.size(); i-- > 0;)
      if (candidates_[i].ticks == *row->color_ticks) {
        const ColorCandidate named = candidates_[i];
        if (show_color(named, frame)) return;
        candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(i));
      }
  }
  for (std::size_t i = candidates_.size(); i-- > 0;) {
    const ColorCandidate candidate = candidates_[i];
    if (depth_clock_.device_time_of(candidate.host_s, candidate.ticks) > frame.device_t_s) continue;
    if (show_color(candidate, frame)) return;
    candidates_.erase(candidates_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

bool FakenectReader::show_color(const ColorCandidate& candidate, FrameInput& frame) {
  if (candidate.name != shown_color_) {
    std::span<const std::uint8_t> file;
    if (!load(candidate.host_s, Stream::kColor, candidate.name, file)) return false;
    const Intrinsics& camera = calibration().color;
    const std::optional<PnmHeader> header = parse_pnm_header(file);
    if (!header || !header->color || header->max_value > 255) {
      note_damage(candidate.host_s, DamageReason::kForeign, Stream::kColor, candidate.name,
                  "no 8-bit PPM (P6) image");
      return false;
    }
    if (header->width != camera.width || header->height != camera.height) {
      note_damage(candidate.host_s, DamageReason::kWrongSize, Stream::kColor, candidate.name,
                  size_text(header->width, header->height) + " pixels, calibration says " +
                      size_text(camera.width, camera.height));
      return false;
    }
    if (file.size() - header->header_bytes < header->pixel_bytes()) {
      note_damage(candidate.host_s, DamageReason::kShort, Stream::kColor, candidate.name, "ends early");
      return false;
    }
    std::memcpy(next_color_buffer().data(), file.data() + header->header_bytes, header->pixel_bytes());
    use_color();
    good_color_bytes_ = static_cast<std::int64_t>(header->header_bytes + header->pixel_bytes());
    shown_color_ = candidate.name;
    frame.color_is_new = true;
  }
  frame.color = color_view();
  frame.color_device_t_s = depth_clock_.device_time_of(candidate.host_s, candidate.ticks);
  return true;
}

void FakenectReader::attach_gravity(FrameInput& frame) {
  if (!tilt_name_.empty()) {
    std::vector<std::uint8_t> bytes(kTiltStateBytes);
    const std::int64_t size = read_whole_file(path_of(tilt_name_), bytes);
    const auto tilt = size == kTiltStateBytes ? parse_tilt_state(bytes) : std::nullopt;
    if (tilt) {
      up_mps2_ = up_from_tilt(*tilt);
    } else if (!tilt_refused_) {
      // Once: the older format of every file of a recording is not worth an event each.
      note_damage(frame.t_s, DamageReason::kWrongSize, Stream::kTilt, tilt_name_, "not 12 bytes");
      tilt_refused_ = true;
    }
    tilt_name_.clear();
  }
  frame.has_gravity = up_mps2_.has_value();
  if (up_mps2_) frame.gravity_mps2 = *up_mps2_;
}

}  // namespace st
