#include "hal/kinect/kinect_session.hpp"

#include <libfreenect.h>
#include <libfreenect_registration.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <optional>

#include "hal/clock.hpp"
#include "hal/recording/text.hpp"
#include "hal/source/tilt_state.hpp"

// fakenect has the same name as the library that it stands in for, but not these; null tells that it is
// there.
#pragma weak freenect_copy_registration
#pragma weak freenect_destroy_registration

namespace st {
namespace {

constexpr int kPollMs = 50;
constexpr std::int64_t kTiltPeriod_ns = 100'000'000;
constexpr std::int64_t kSilence_ns = 3'000'000'000;       // without a depth frame: something is wrong
constexpr std::int64_t kErrorSilence_ns = 1'000'000'000;  // the same while libfreenect reports errors
constexpr int kInterrupted = -10;  // LIBUSB_ERROR_INTERRUPTED: a signal came, nothing is wrong
// libfreenect mutes its reports of lost packets for the first two frames, so those may be torn without a
// word.
constexpr int kUnjudgedFrames = 2;

// libfreenect's log callback carries no user data; it is called on the session's thread.
thread_local KinectSession* t_session = nullptr;

std::int64_t now_ns() { return system_clock().monotonic_ns(); }

}  // namespace

void KinectSession::fail(const std::string& what) {
  if (failed_.load()) return;
  fault_ = what + (last_error_.empty() ? "" : " (libfreenect: " + last_error_ + ")");
  failed_.store(true, std::memory_order_release);
}

void KinectSession::run() {
  t_session = this;
  const bool open = open_device();
  opened_.post();
  if (open) {
    go_.wait();
    if (!quit_.load() && start_streams()) stream();
    close_device();
  }
  closed_.post();
  frames.wake();
}

bool KinectSession::open_device() {
  // The motor's accelerometer is wanted, but a Kinect whose motor does not open still sees.
  if (try_open(FREENECT_DEVICE_MOTOR | FREENECT_DEVICE_CAMERA) ||
      (!failed() && try_open(FREENECT_DEVICE_CAMERA))) {
    read_depth_formula();
    return true;
  }
  fail(
      "the Kinect does not open; is another program using it, or may you not use it? `startrack doctor` "
      "tells");
  return false;
}

bool KinectSession::try_open(int subdevices) {
  if (freenect_init(&context_, nullptr) < 0) {
    fail("USB cannot be used; `startrack doctor` tells why");
    return false;
  }
  freenect_set_log_level(context_, FREENECT_LOG_INFO);
  freenect_set_log_callback(context_, [](freenect_context*, freenect_loglevel level, const char* line) {
    if (t_session != nullptr) t_session->log_line(level, line);
  });
  freenect_select_subdevices(context_, static_cast<freenect_device_flags>(subdevices));
  int index = 0;
  const bool by_index = which_.empty() || (which_.size() <= 2 && parse_number<int>(which_, index));
  const int found = freenect_num_devices(context_);
  if (found <= 0) {
    fail("no Kinect found; plug in its USB cable and its own power supply, then see `startrack doctor`");
  } else if (by_index && (index < 0 || index >= found)) {
    fail("no Kinect " + which_ + "; " + std::to_string(found) + " found, counted from 0");
  } else {
    const int result = by_index ? freenect_open_device(context_, &device_, index)
                                : freenect_open_device_by_camera_serial(context_, &device_, which_.c_str());
    if (result >= 0) return true;
  }
  device_ = nullptr;  // a device that failed half-way is freed with the context
  freenect_shutdown(context_);
  context_ = nullptr;
  return false;
}

// z_mm = 10 R E 4 / P / (4 E / P + 4 C + 1.5 - raw), as libfreenect's own table.
void KinectSession::read_depth_formula() {
  real_device_ = freenect_copy_registration != nullptr;
  if (!real_device_) return;
  frames_to_discard_ = kUnjudgedFrames;
  freenect_registration registration = freenect_copy_registration(device_);
  const double emitter = static_cast<double>(registration.zero_plane_info.dcmos_emitter_dist);
  const double reference = static_cast<double>(registration.zero_plane_info.reference_distance);
  const double pixel = static_cast<double>(registration.zero_plane_info.reference_pixel_size);
  const double a = 0.04 * reference * emitter / pixel;
  const double b = 4.0 * emitter / pixel + 4.0 * registration.const_shift + 1.5;
  freenect_destroy_registration(&registration);
  const bool plausible = a > 0.3 && a < 0.4 && b > 1050 && b < 1130;
  if (!plausible) return;
  raw_a_ = a;
  raw_b_ = b;
}

bool KinectSession::start_streams() {
  const freenect_frame_mode depth =
      freenect_find_depth_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_DEPTH_11BIT);
  const freenect_frame_mode color = freenect_find_video_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_VIDEO_RGB);
  timespec wall{};
  clock_gettime(CLOCK_REALTIME, &wall);
  last_depth_ns_ = now_ns();
  wall_minus_steady_s_ = static_cast<double>(wall.tv_sec) + static_cast<double>(wall.tv_nsec) * 1e-9 -
                         static_cast<double>(last_depth_ns_) * 1e-9;
  freenect_set_user(device_, this);
  const bool ready = depth.is_valid != 0 && color.is_valid != 0 &&
                     freenect_set_video_mode(device_, color) >= 0 &&
                     freenect_set_depth_mode(device_, depth) >= 0 &&
                     freenect_set_depth_buffer(device_, frames.depth_target()) >= 0 &&
                     freenect_set_video_buffer(device_, frames.color_target()) >= 0;
  freenect_set_depth_callback(device_, &KinectSession::on_depth);
  freenect_set_video_callback(device_, &KinectSession::on_color);
  if (ready && freenect_start_depth(device_) >= 0 && freenect_start_video(device_) >= 0) return true;
  fail("the Kinect does not start streaming; unplug it and plug it in again");
  return false;
}

void KinectSession::stream() {
  while (!quit_.load() && !failed()) {
    timeval timeout{0, kPollMs * 1000};
    const int result = freenect_process_events_timeout(context_, &timeout);
    if (!still_alive(result)) return;
    poll_accelerometer();
  }
}

// An error may be one bad transfer, or (fakenect) a blank line: what counts is whether frames go on coming.
bool KinectSession::still_alive(int result) {
  const bool error = result < 0 && result != kInterrupted;
  errors_in_a_row_ = error ? errors_in_a_row_ + 1 : 0;
  const std::int64_t silence_ns = now_ns() - last_depth_ns_;
  const bool gone = error && real_device_ && freenect_num_devices(context_) == 0;
  if (error && !real_device_ && silence_ns > kErrorSilence_ns) {
    quit_.store(true);  // fakenect reports its recording's end as an error, for ever
  } else if (gone || (error && silence_ns > kErrorSilence_ns)) {
    fail("the Kinect stopped delivering frames; was it unplugged?");
  } else if (!error && silence_ns > kSilence_ns) {
    fail("no depth frame from the Kinect for 3 s; plug it into another USB controller");
  } else if (error) {
    // Errors return at once: do not spin. One alone must not cost the 32 ms that libfreenect's transfers
    // buffer.
    const timespec pause{0, 1'000'000L << std::min(errors_in_a_row_, 7)};
    nanosleep(&pause, nullptr);
  }
  return !quit_.load() && !failed();
}

void KinectSession::poll_accelerometer() {
  const std::int64_t now = now_ns();
  if (poll_failures_ >= 3 || now - last_poll_ns_ < kTiltPeriod_ns) return;
  last_poll_ns_ = now;
  if (freenect_update_tilt_state(device_) < 0) {
    ++poll_failures_;
    return;
  }
  poll_failures_ = 0;
  const freenect_raw_tilt_state* state = freenect_get_tilt_state(device_);
  const std::optional<Vec3> up =
      up_from_tilt({state->accelerometer_x, state->accelerometer_y, state->accelerometer_z, state->tilt_angle,
                    static_cast<std::int32_t>(state->tilt_status)});
  next_.has_gravity = up.has_value();
  if (up) next_.up_mps2 = *up;
}

// Both streams first: closing the device stops only the depth stream, and the other's transfers outlive the
// handle.
void KinectSession::close_device() {
  freenect_stop_depth(device_);
  freenect_stop_video(device_);
  freenect_close_device(device_);
  freenect_shutdown(context_);
}

void KinectSession::on_depth(freenect_device* device, void*, std::uint32_t ticks) {
  static_cast<KinectSession*>(freenect_get_user(device))->depth_arrived(ticks);
}

void KinectSession::on_color(freenect_device* device, void*, std::uint32_t ticks) {
  static_cast<KinectSession*>(freenect_get_user(device))->color_arrived(ticks);
}

double KinectSession::host_s(std::int64_t at_ns) const {
  // Whole microseconds, so that a recording's file names carry the same number.
  return std::nearbyint((static_cast<double>(at_ns) * 1e-9 + wall_minus_steady_s_) * 1e6) / 1e6;
}

void KinectSession::depth_arrived(std::uint32_t ticks) {
  next_.complete_ns = now_ns();
  last_depth_ns_ = next_.complete_ns;
  if (frames_to_discard_ > 0) {
    --frames_to_discard_;
    return;
  }
  next_.t_s = host_s(next_.complete_ns);
  if (!depth_clock_.accept(next_.t_s, ticks)) return;
  next_.device_t_s = depth_clock_.device_t_s();
  frames.depth_done(next_);
  freenect_set_depth_buffer(device_, frames.depth_target());
}

void KinectSession::color_arrived(std::uint32_t ticks) {
  frames.color_done(depth_clock_.device_time_of(host_s(now_ns()), ticks));
  freenect_set_video_buffer(device_, frames.color_target());
}

// The only way to learn that a frame has holes: "[Stream 70] Lost 3 packets" (70: depth, 80: video).
void KinectSession::log_line(int level, const char* line) {
  unsigned stream = 0, packets = 0;
  if (std::sscanf(line, "[Stream %x] Lost %u", &stream, &packets) == 2 && stream == 0x70)
    next_.lost_packets += packets;
  if (level > FREENECT_LOG_ERROR || !last_error_.empty()) return;
  last_error_ = line;
  while (!last_error_.empty() && last_error_.back() == '\n') last_error_.pop_back();
}

}  // namespace st
