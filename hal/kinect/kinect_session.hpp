// One Kinect from opening to closing, on one thread: every call to libfreenect is made there, since it has no
// locks, and its control transfers have no time limit.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>

#include "hal/error.hpp"
#include "hal/kinect/live_frames.hpp"
#include "hal/source/stamp_clock.hpp"

struct _freenect_context;  // NOLINT(bugprone-reserved-identifier): libfreenect's own name
struct _freenect_device;   // NOLINT(bugprone-reserved-identifier)

namespace st {

class KinectSession {
 public:
  // `which`: empty for the first Kinect, an index, or a camera serial.
  explicit KinectSession(std::string which) : which_(std::move(which)) {}

  // The thread's body: opens, tells opened(), waits for go or quit, streams, closes, tells closed().
  void run();

  // What the other side may do while run() runs.
  bool wait_opened(int timeout_ms) { return opened_.wait_for(timeout_ms); }
  bool wait_closed(int timeout_ms) { return closed_.wait_for(timeout_ms); }
  void go() { go_.post(); }
  void quit() {
    quit_.store(true);
    go_.post();
    frames.wake();
  }
  bool quitting() const { return quit_.load(); }
  // True once something went wrong; then fault() is a line for people, and stays.
  bool failed() const { return failed_.load(std::memory_order_acquire); }
  const std::string& fault() const { return fault_; }

  LiveFrames frames;
  // The device's own depth formula, once opened; zeros when it does not tell.
  double raw_a() const { return raw_a_; }
  double raw_b() const { return raw_b_; }

 private:
  bool open_device();
  bool try_open(int subdevices);
  void read_depth_formula();
  bool start_streams();
  void stream();
  bool still_alive(int result);
  void poll_accelerometer();
  void close_device();
  void fail(const std::string& what);

  static void on_depth(_freenect_device* device, void* pixels, std::uint32_t ticks);
  static void on_color(_freenect_device* device, void* pixels, std::uint32_t ticks);
  void depth_arrived(std::uint32_t ticks);
  void color_arrived(std::uint32_t ticks);
  void log_line(int level, const char* line);
  // Host seconds that never step back: the wall clock at the start, and the steady clock since.
  double host_s(std::int64_t now_ns) const;

  std::string which_;
  _freenect_context* context_ = nullptr;
  _freenect_device* device_ = nullptr;
  Semaphore opened_{0}, closed_{0}, go_{0};
  std::atomic<bool> quit_{false}, failed_{false};
  std::string fault_, last_error_;
  double raw_a_ = 0, raw_b_ = 0;

  StampClock depth_clock_;
  bool real_device_ = false;  // false: fakenect
  int frames_to_discard_ = 0;
  double wall_minus_steady_s_ = 0;
  std::int64_t last_depth_ns_ = 0, last_poll_ns_ = 0;
  int poll_failures_ = 0, errors_in_a_row_ = 0;
  LiveFrames::Depth next_;  // gravity and lost packets for the frame to come; its pixels stay empty
};

}  // namespace st
