// Scan mode: everything between a depth frame and the pose of the hand-held camera, and the scene that it has
// seen. Each public function is one stage of the loop; they run in the order in which they stand here. All
// memory is bound once.
#pragma once

#include "algo/core/records.hpp"
#include "algo/depth/pyramid.hpp"
#include "algo/tracking/camera_align.hpp"
#include "algo/tracking/camera_judge.hpp"
#include "algo/tracking/camera_motion.hpp"
#include "algo/tracking/frame_colors.hpp"
#include "algo/tracking/places.hpp"
#include "algo/volume/integrate.hpp"
#include "algo/volume/raycast.hpp"
#include "firmware_like/config.hpp"
#include "firmware_like/degradation.hpp"
#include "firmware_like/memory_plan.hpp"
#include "hal/results/run_end.hpp"

namespace st {

class ScanTracker {
 public:
  ScanTracker(const Calibration& calibration, const LoopConfig& config);
  ScanTracker(const ScanTracker&) = delete;  // the memory plan holds its address
  ScanTracker& operator=(const ScanTracker&) = delete;

  // Enters everything that needs memory into the plan; once the plan is sealed, start() makes it ready for
  // frames.
  void plan_memory(MemoryPlan& plan);
  void start();

  void preprocess(const FrameInput& input, FrameReport& report);
  void predict();
  void render(const LadderStep& step);
  void align(const LadderStep& step);
  void judge();
  void integrate(const LadderStep& step);
  void decide();  // lost, recovered, out of the volume
  void publish(FrameReport& report);

  // For the end of a run.
  const Volume& scene() const { return volume_; }
  const CameraEnd& count() const { return count_; }

 private:
  void bind_images(Bump& memory);
  void bind_volume(Bump& memory);
  void bind_view(Bump& memory);
  void bind_integration(Bump& memory);

  void place_volume();
  Pose place_to_try() const;
  CameraPrior prior() const;
  void try_from(const CameraAlignInput& in);
  bool take_color();
  bool found() const;
  void follow_lead();
  bool upright(const Pose& T_world_camera) const;
  void learn_up();
  void follow();
  void lose();
  void search();
  void prove();
  void watch_border();
  void log(EventKind kind, double a = 0, double b = 0);

  MemberPart<ScanTracker> parts_[4];
  Calibration calibration_;
  LoopConfig config_;
  Pinhole camera_;
  DepthTables tables_;
  DepthPyramid depth_;
  ImageView<std::uint32_t> color_;  // of the frame that is fused, in the depth camera's pixels
  const FrameInput* input_ = nullptr;

  Volume volume_;
  ModelMaps view_;  // the scene at T_world_view_
  Pose T_world_view_;
  RaycastScratch raycast_scratch_;
  IntegrateScratch integrate_scratch_;

  CameraMotion motion_;
  CameraAlignResult aligned_;
  CameraVerdict verdict_;
  CameraHabit habit_;
  CameraSample camera_now_;
  IntegrateStats fused_;
  Places places_;
  Vec3 up_world_{};  // by the accelerometer, over the good frames so far; zero: it never said

  // Waiting: for the first frame with depth enough to place the volume. Following: each good frame is fused.
  // Searching: lost, a kept place is tried each frame. Proving: found again, and followed for some frames
  // before the scene may change.
  enum class Course { kWaiting, kFollowing, kSearching, kProving };
  Course course_ = Course::kWaiting;
  int poor_run_ = 0, proven_ = 0;
  std::size_t tries_ = 0;  // places tried since the camera was lost
  bool has_lead_ = false;  // the last try came nearer
  Pose T_world_lead_;      // where it led
  float lead_explained_ = 0;
  double last_good_t_s_ = 0;
  bool outside_ = false;  // most of what the camera sees lies outside of the volume
  FixedVector<Event, 8> events_;
  CameraEnd count_;
};

}  // namespace st
