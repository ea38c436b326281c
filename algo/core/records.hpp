// The plain structs that travel between the stages of the loop and out of it. Trivially copyable; no pointers
// that outlive a frame. Times are seconds: `t_s` is the output stamp (the recording's own, or host seconds),
// `device_t_s` the clock that dynamics use (the camera's 60 MHz counter, unwrapped, where there is one; else
// t_s).
#pragma once

#include <cstdint>

#include "algo/core/fixed_vector.hpp"
#include "algo/core/image.hpp"
#include "algo/core/pose.hpp"

namespace st {

inline constexpr int kMaxObjects = 4;

// Wheel travel since the previous sample, as the robot reported it.
struct OdometrySample {
  double t_s = 0;
  double left_m = 0, right_m = 0;
};

// The base's motion between the exposures of two processed frames, as its wheels tell it.
struct WheelOdometry {
  bool valid = false;    // the wheels' reports cover all of it
  double forward_m = 0;  // way of the turning centre, backwards negative
  double turn_rad = 0;   // to the left positive
  double dt_s = 0;       // between the exposures, by the camera's clock
};

// What a recording lost or damaged on the way to this frame.
enum class EventKind : std::uint8_t {
  kDamaged,         // a: frames skipped so far, b: reason (DamageReason)
  kGap,             // a: seconds since the frame before, b: depth frames missing
  kConfirmed,       // object given its number
  kLost,            // a: seconds since its last good pose
  kRecovered,       // a: seconds without a pose
  kLeft,            // left through the edge of the view
  kEvicted,         // its slot went to a newer mover
  kNoObject,        // nothing ever moved
  kNoFloor,         // floor frame taken from gravity or the camera
  kRobotFault,      // a: RobotFault code
  kSteeringObject,  // obeyed the start motion; a: misfit in metres, b: camera's lag in seconds, c: gain
  kVolumeFull,      // surface outside the object's volume was dropped
  kInterrupted,     // a: signal
  kVolumeLeft,      // scan mode, a: share of the surface in sight that lies outside of the volume
  kRecognised,  // it is a model of the database; a: how well it fits, 0-1, b: agreeing 3-D SIFT matches, c: 0
                // when the model took over, else its heading is open
  kUnknownObject,  // none of the models is it; a, b: of the best; c: why, as a Doubt
};
const char* name_of(EventKind kind);

enum class DamageReason : std::uint8_t { kMissing, kShort, kForeign, kBackwards, kWrongSize };

struct Event {
  double t_s = 0;
  EventKind kind = EventKind::kDamaged;
  int object = 0;  // 0: none
  double a = 0, b = 0, c = 0;
};

// One depth frame as a source hands it over. The views hold until the next call to the source.
struct FrameInput {
  std::uint64_t index = 0;
  double t_s = 0, device_t_s = 0;
  ImageView<const std::uint16_t> depth;  // stored values, as the calibration's encoding says
  ImageView<const std::uint8_t>
      color;  // RGB, three bytes a pixel (width is 3 * pixels); empty when there is none yet
  double color_device_t_s = 0;  // when that colour frame was taken
  bool color_is_new = false;
  bool has_gravity = false;
  Vec3 gravity_mps2{};           // what the accelerometer measured at rest: points up, camera optical frame
  std::int64_t complete_ns = 0;  // CLOCK_MONOTONIC when the frame was complete
  int skipped = 0;               // live: frames that this one replaced
  int recorded_level = 0;  // degradation level that the recording run used on this frame (frames.csv), else 0
  FixedVector<OdometrySample, 64> odometry;  // what the robot reported since the frame before
  WheelOdometry wheels;                      // from that, by the loop: since the last processed frame
  FixedVector<Event, 16> events;
};

enum class TrackState : std::uint8_t { kGood, kPoor, kPredicted, kLost };
const char* name_of(TrackState state);

enum class YawSource : std::uint8_t { kColor, kDepth, kOdometry, kMotion, kNone };
const char* name_of(YawSource source);

// A confirmed object in one frame: a row of object-N.csv.
struct ObjectSample {
  int id = 0;
  TrackState state = TrackState::kLost;
  bool in_tum = false;  // good, or predicted over a short gap: the pose below is published
  bool in_view = true;  // false once it has left through the edge
  Pose T_camera_object{};
  double covariance[21]{};  // upper triangle by rows: x y z, rotation about the fixed camera axes
  Pose T_floor_object{};
  double yaw_unwrapped = 0;
  Vec3 velocity_mps{}, angular_velocity_rps{}, acceleration_mps2{};  // floor frame
  double v_mps = 0, w_rps = 0, alpha_rps2 = 0;  // forward speed, yaw rate, yaw acceleration
  Vec3 sigma_position_m{}, sigma_rpy_rad{};     // floor frame
  YawSource yaw_source = YawSource::kNone;
  float inliers = 0;     // share of the object's pixels that the pose explains, 0-1
  float residual_m = 0;  // RMS
};

// The hand-held camera in one frame of scan mode: a row of camera.tum when its pose is good.
struct CameraSample {
  TrackState state = TrackState::kLost;
  Pose T_world_camera{};  // world: the camera's first pose
  float inliers = 0;      // of the pixels that face a known surface, the share that the pose explains, 0-1
  float residual_m = 0;   // RMS of those
};

// The loop's stages, in order. timing.csv has a column for each.
enum class Stage : std::uint8_t {
  kAcquire,
  kPreprocess,
  kSegment,
  kAssociate,
  kPredict,
  kRender,
  kAlign,
  kJudge,
  kIntegrate,
  kDecide,
  kSend,
  kPublish,
  kCount
};
const char* name_of(Stage stage);
inline constexpr int kStageCount = static_cast<int>(Stage::kCount);

// Everything one frame leaves behind, handed to the telemetry thread.
struct FrameReport {
  std::uint64_t index = 0;
  double t_s = 0, device_t_s = 0;
  FixedVector<ObjectSample, kMaxObjects> objects;
  bool has_camera = false;  // scan mode
  CameraSample camera;
  FixedVector<Event, 24> events;
  float stage_us[kStageCount]{};
  float frame_us = 0;  // frame handed over until published, wall clock
  float cpu_us = 0;    // the same, CPU time of the compute thread
  float age_us = 0;    // frame complete until handed over
  int level = 0;       // degradation level, 0 is full work
  bool deadline_missed = false;
  std::uint32_t invalid_pixels = 0;  // pixels without a reading, which never reach the alignment
};

}  // namespace st
