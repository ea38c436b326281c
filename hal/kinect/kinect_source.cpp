#include "hal/kinect/kinect_source.hpp"

#include <pthread.h>
#include <signal.h>

#include <cmath>
#include <thread>

#include "hal/error.hpp"
#include "hal/kinect/kinect_session.hpp"
#include "hal/recording/camera_file.hpp"
#include "hal/recording/open_recording.hpp"

namespace st {
namespace {

constexpr int kOpenTimeout_ms = 15'000;
constexpr int kCloseTimeout_ms = 3'000;

class KinectSource final : public FrameSource {
 public:
  explicit KinectSource(const SourceOptions& options);
  ~KinectSource() override { stop(); }

  const SourceInfo& info() const override { return info_; }
  void start() override { session_->go(); }
  Result next(FrameInput& out, int timeout_ms) override;
  std::string fault() const override {
    return session_->failed() ? info_.name + ": " + session_->fault() : "";
  }
  void stop() override;

 private:
  void spawn();
  void choose_calibration(const std::string& camera_file);
  void fill(const LiveFrames::Depth& frame, FrameInput& out);
  void note_losses(const LiveFrames::Depth& frame, FrameInput& out);

  SourceInfo info_;
  std::shared_ptr<KinectSession> session_;  // shared with its thread, which may hang in the device for ever
  std::thread thread_;
  std::uint64_t index_ = 0, last_sequence_ = 0, last_color_sequence_ = 0, damaged_ = 0, lost_packets_ = 0;
  double last_device_t_s_ = 0;
};

KinectSource::KinectSource(const SourceOptions& options) {
  info_.name = options.spec;
  info_.short_name = short_source_name(options.spec);
  info_.live = true;
  const std::size_t colon = options.spec.find(':');
  session_ =
      std::make_shared<KinectSession>(colon == std::string::npos ? "" : options.spec.substr(colon + 1));
  spawn();
  if (!session_->wait_opened(kOpenTimeout_ms)) {
    thread_.detach();
    throw Failure(
        ExitCode::kDeviceFault,
        info_.name + ": the Kinect does not answer; unplug its USB cable, wait 5 s, plug it in again");
  }
  if (session_->failed()) {
    thread_.join();
    throw Failure(ExitCode::kDeviceFault, fault());
  }
  try {
    choose_calibration(options.camera_file);
  } catch (...) {
    stop();
    throw;
  }
}

// Signals are the main thread's business: libusb would see them as interrupted transfers.
void KinectSource::spawn() {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([session = session_] { session->run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_setname_np(thread_.native_handle(), "st-usb");
}

void KinectSource::choose_calibration(const std::string& camera_file) {
  if (!camera_file.empty()) {
    info_.calibration = read_camera_file(camera_file, CameraKind::kKinect);
    for (const Intrinsics* camera : {&info_.calibration.depth, &info_.calibration.color})
      if (camera->width != kMaxWidth || camera->height != kMaxHeight)
        throw Failure(ExitCode::kBadInput,
                      camera_file + ": a Kinect's images are 640x480; width and height say otherwise");
    return;
  }
  info_.calibration = default_calibration(CameraKind::kKinect);
  info_.calibration_note = "no --camera: taking the default calibration of a Kinect (several pixels off)";
  if (session_->raw_a() <= 0) return;
  info_.calibration.raw_a = session_->raw_a();
  info_.calibration.raw_b = session_->raw_b();
  info_.calibration_note += ", depth formula from the device";
}

FrameSource::Result KinectSource::next(FrameInput& out, int timeout_ms) {
  if (session_->quitting()) return Result::kEnd;
  const LiveFrames::Depth* frame = session_->frames.newest(timeout_ms);
  if (frame == nullptr) {
    if (session_->quitting()) return Result::kEnd;
    return session_->failed() ? Result::kFault : Result::kTimeout;
  }
  fill(*frame, out);
  return Result::kFrame;
}

void KinectSource::fill(const LiveFrames::Depth& frame, FrameInput& out) {
  out = FrameInput{};
  out.index = index_++;
  out.t_s = frame.t_s;
  out.device_t_s = frame.device_t_s;
  out.complete_ns = frame.complete_ns;
  out.depth = {frame.pixels.data(), kMaxWidth, kMaxHeight};
  if (frame.color >= 0 && info_.calibration.has_color) {
    out.color = {session_->frames.color_pixels(frame.color), 3 * kMaxWidth, kMaxHeight};
    out.color_device_t_s = frame.color_device_t_s;
    out.color_is_new = frame.color_sequence != last_color_sequence_;
    last_color_sequence_ = frame.color_sequence;
  }
  out.has_gravity = frame.has_gravity;
  out.gravity_mps2 = frame.up_mps2;
  out.skipped = static_cast<int>(frame.sequence - last_sequence_ - 1);
  note_losses(frame, out);
  last_sequence_ = frame.sequence;
  last_device_t_s_ = frame.device_t_s;
}

void KinectSource::note_losses(const LiveFrames::Depth& frame, FrameInput& out) {
  Event event;
  event.t_s = frame.t_s;
  if (frame.lost_packets > lost_packets_) {
    // Up to five lost packets leave a hole with the frame before in it: small enough to be used, worth being
    // told.
    event.kind = EventKind::kDamaged;
    event.a = static_cast<double>(++damaged_);
    event.b = static_cast<double>(DamageReason::kShort);
    event.c = static_cast<double>(frame.lost_packets - lost_packets_);
    out.events.push_back(event);
    lost_packets_ = frame.lost_packets;
  }
  const double elapsed_s = frame.device_t_s - last_device_t_s_;
  const double missing = std::nearbyint(elapsed_s / info_.frame_period_s) - 1 - out.skipped;
  if (out.index == 0 || missing < 1) return;
  event.kind = EventKind::kGap;
  event.a = elapsed_s;
  event.b = missing;
  event.c = 0;
  out.events.push_back(event);
}

void KinectSource::stop() {
  if (!thread_.joinable()) return;
  session_->quit();
  if (session_->wait_closed(kCloseTimeout_ms))
    thread_.join();
  else
    thread_.detach();
}

}  // namespace

std::unique_ptr<FrameSource> open_kinect(const SourceOptions& options) {
  return std::make_unique<KinectSource>(options);
}

}  // namespace st
