#include "algo/core/records.hpp"

namespace st {

const char* name_of(EventKind kind) {
  switch (kind) {
    case EventKind::kDamaged:
      return "damaged";
    case EventKind::kGap:
      return "gap";
    case EventKind::kConfirmed:
      return "confirmed";
    case EventKind::kLost:
      return "lost";
    case EventKind::kRecovered:
      return "recovered";
    case EventKind::kLeft:
      return "left";
    case EventKind::kEvicted:
      return "evicted";
    case EventKind::kNoObject:
      return "no_object";
    case EventKind::kNoFloor:
      return "no_floor";
    case EventKind::kRobotFault:
      return "robot_fault";
    case EventKind::kSteeringObject:
      return "steering_object";
    case EventKind::kVolumeFull:
      return "volume_full";
    case EventKind::kInterrupted:
      return "interrupted";
    case EventKind::kVolumeLeft:
      return "volume_left";
    case EventKind::kRecognised:
      return "recognised";
    case EventKind::kUnknownObject:
      return "unknown_object";
  }
  return "unknown";
}

const char* name_of(TrackState state) {
  switch (state) {
    case TrackState::kGood:
      return "good";
    case TrackState::kPoor:
      return "poor";
    case TrackState::kPredicted:
      return "predicted";
    case TrackState::kLost:
      return "lost";
  }
  return "unknown";
}

const char* name_of(YawSource source) {
  switch (source) {
    case YawSource::kColor:
      return "colour";
    case YawSource::kDepth:
      return "depth";
    case YawSource::kOdometry:
      return "odometry";
    case YawSource::kMotion:
      return "motion";
    case YawSource::kNone:
      return "none";
  }
  return "unknown";
}

const char* name_of(Stage stage) {
  static constexpr const char* kNames[kStageCount] = {"acquire",   "preprocess", "segment", "associate",
                                                      "predict",   "render",     "align",   "judge",
                                                      "integrate", "decide",     "send",    "publish"};
  const int i = static_cast<int>(stage);
  return i >= 0 && i < kStageCount ? kNames[i] : "unknown";
}

}  // namespace st
