#include "hal/recording/recorder.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "hal/error.hpp"
#include "hal/recording/camera_file.hpp"
#include "hal/recording/fakenect_index.hpp"
#include "hal/recording/frames_csv.hpp"
#include "hal/source/stamp_clock.hpp"
#include "hal/source/tilt_state.hpp"

namespace st {
namespace {

namespace fs = std::filesystem;

constexpr int kOpenFlags = O_WRONLY | O_CREAT | O_CLOEXEC;

std::uint32_t ticks_of(double device_t_s) {
  return static_cast<std::uint32_t>(std::llround(device_t_s * kKinectTicksPerSecond));
}

bool write_bytes(int file, const void* data, std::size_t bytes) {
  const char* at = static_cast<const char*>(data);
  while (bytes > 0) {
    const ssize_t n = write(file, at, bytes);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    bytes -= static_cast<std::size_t>(n);
  }
  return true;
}

std::string pnm_header(const char* magic, const Intrinsics& camera, const char* max_value) {
  return std::string(magic) + " " + std::to_string(camera.width) + " " + std::to_string(camera.height) + " " +
         max_value + "\n";
}

void require_folder(const std::string& folder, const char* but_for) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder))
    throw Failure(ExitCode::kBadInput,
                  folder + ": cannot be made (" + error.message() + "); give another folder");
  bool empty = true;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    empty = empty && entry.path().filename() == but_for;
  if (!empty || error)
    throw Failure(ExitCode::kBadInput, folder + ": is not empty; give a new folder for the recording");
}

}  // namespace

void make_recording_folder(const std::string& folder) { require_folder(folder, ""); }

Recorder::Recorder(const RecorderOptions& options)
    : folder_(options.folder),
      calibration_(options.calibration),
      items_(options.queue_frames),
      free_(options.queue_frames) {
  if (calibration_.encoding != DepthEncoding::kRaw11)
    throw Failure(
        ExitCode::kBadInput,
        folder_ +
            ": only 11-bit Kinect depth can be recorded; SRC delivers depth in PNG units: copy its folder");
  require_folder(folder_, "robot.log");
  const auto area = [](const Intrinsics& c) {
    return static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height);
  };
  for (Item& item : items_) {
    item.depth.resize(area(calibration_.depth));
    item.color.resize(calibration_.has_color ? 3 * area(calibration_.color) : 0);
  }
  write_whole("camera.toml", format_camera_toml(calibration_), nullptr, 0);
  index_ = open((folder_ + "/INDEX.txt").c_str(), kOpenFlags | O_APPEND, 0644);
  frames_csv_ = open((folder_ + "/frames.csv").c_str(), kOpenFlags | O_APPEND, 0644);
  if (index_ < 0 || frames_csv_ < 0) fail("INDEX.txt", errno);
  append_line(frames_csv_, std::string(kFramesCsvHeader) + "\n");
  if (failed_) throw Failure(ExitCode::kBadInput, failure_);
  sigset_t all, before;
  sigfillset(&all);  // the main thread's business
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { write_all(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Recorder::~Recorder() {
  close();
  if (index_ >= 0) ::close(index_);
  if (frames_csv_ >= 0) ::close(frames_csv_);
}

void Recorder::close() {
  closing_.store(true);
  filled_.post();
  if (thread_.joinable()) thread_.join();
}

bool Recorder::add(const FrameInput& frame, int level, std::uint64_t robot_log_offset) {
  if (failed_.load() || !free_.try_wait()) {
    ++dropped_;
    return false;
  }
  Item& item = items_[added_.load() % items_.size()];
  item.t_s = frame.t_s;
  item.ticks = ticks_of(frame.device_t_s);
  item.has_gravity = frame.has_gravity;
  item.up_mps2 = frame.gravity_mps2;
  item.level = level;
  item.robot_log_offset = robot_log_offset;
  const auto pixels = static_cast<std::size_t>(frame.depth.pixels());
  std::memcpy(item.depth.data(), frame.depth.data,
              std::min(pixels, item.depth.size()) * sizeof(std::uint16_t));
  item.has_color = !frame.color.empty() && !item.color.empty();
  if (item.has_color) {
    item.color_ticks = ticks_of(frame.color_device_t_s);
    item.color_t_s = frame.t_s - (frame.device_t_s - frame.color_device_t_s);
    // By its ticks, not by color_is_new: the frame that brought it may have been dropped.
    item.color_is_new = !color_queued_ || item.color_ticks != color_ticks_queued_;
    color_queued_ = true;
    color_ticks_queued_ = item.color_ticks;
    const auto bytes = static_cast<std::size_t>(frame.color.pixels());
    if (item.color_is_new)
      std::memcpy(item.color.data(), frame.color.data, std::min(bytes, item.color.size()));
  }
  added_.fetch_add(1);
  filled_.post();
  return true;
}

bool Recorder::wait_for_room(int timeout_ms) {
  const bool room = free_.wait_for(timeout_ms);
  if (room) free_.post();
  return room;
}

void Recorder::write_all() {
  pthread_setname_np(pthread_self(), "st-record");
  for (std::uint64_t taken = 0;;) {
    filled_.wait();
    // The post without a frame is that of close(), which comes last.
    if (taken == added_.load()) return;
    if (!failed_.load()) write_item(items_[taken % items_.size()]);
    ++taken;
    free_.post();
  }
}

void Recorder::write_item(const Item& item) {
  if (item.has_color && item.color_is_new) {
    // INDEX.txt in order of time, whatever the host stamps' jitter.
    const double t_s = std::clamp(item.color_t_s, std::min(last_t_s_, item.t_s), item.t_s);
    write_frame('r', t_s, item.color_ticks, pnm_header("P6", calibration_.color, "255"), item.color.data(),
                item.color.size());
  }
  if (item.has_gravity) {
    std::uint8_t tilt[kTiltStateBytes];
    format_tilt_state(tilt_from_up(item.up_mps2), tilt);
    write_frame('a', item.t_s, item.ticks, "", tilt, sizeof tilt);
  }
  write_frame('d', item.t_s, item.ticks, pnm_header("P5", calibration_.depth, "65535"), item.depth.data(),
              2 * item.depth.size());
  FramesRow row{item.ticks, std::nullopt, item.level, item.robot_log_offset};
  if (item.has_color) row.color_ticks = item.color_ticks;
  append_line(frames_csv_, format_frames_row(row));
  if (!failed_.load()) written_.fetch_add(1);
}

void Recorder::write_frame(char type, double t_s, std::uint32_t ticks, const std::string& header,
                           const void* data, std::size_t bytes) {
  const std::string name = fakenect_name(type, t_s, ticks);
  write_whole(name, header, data, bytes);
  append_line(index_, name + "\n");
  last_t_s_ = t_s;
}

void Recorder::write_whole(const std::string& name, const std::string& header, const void* data,
                           std::size_t bytes) {
  if (failed_.load()) return;
  const std::string path = folder_ + "/" + name;
  const int file = open(path.c_str(), kOpenFlags | O_TRUNC, 0644);
  const bool whole =
      file >= 0 && write_bytes(file, header.data(), header.size()) && write_bytes(file, data, bytes);
  const int error_number = errno;
  const bool closed = file < 0 || ::close(file) == 0;
  if (whole && closed) return;
  fail(name, whole ? errno : error_number);
  unlink(path.c_str());
}

void Recorder::append_line(int file, const std::string& line) {
  if (failed_.load()) return;
  const off_t before = lseek(file, 0, SEEK_END);
  if (write_bytes(file, line.data(), line.size())) return;
  fail("INDEX.txt", errno);
  if (ftruncate(file, before) != 0) return;  // half a line stays; readers tell it as foreign
}

void Recorder::fail(const std::string& name, int error_number) {
  if (failed_.load()) return;
  failure_ = folder_ + "/" + name + ": cannot be written (" + std::strerror(error_number) +
             "); free some space, or record to another disk";
  failed_.store(true, std::memory_order_release);
}

}  // namespace st
