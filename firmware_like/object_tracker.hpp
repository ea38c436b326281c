// Object mode: everything between a depth frame and the poses of what moves in it. Each public function is
// one stage of the loop; they run in the order in which they stand here. All memory is bound once.
#pragma once

#include "algo/control/start_motion.hpp"
#include "algo/core/bump.hpp"
#include "algo/recognition/patch_check.hpp"
#include "algo/recognition/recognition.hpp"
#include "algo/segmentation/segmenter.hpp"
#include "algo/tracking/associate.hpp"
#include "algo/tracking/closest_point.hpp"
#include "algo/tracking/frame_view.hpp"
#include "algo/tracking/make_room.hpp"
#include "algo/tracking/recover.hpp"
#include "algo/tracking/track.hpp"
#include "algo/tracking/way_match.hpp"
#include "algo/volume/integrate.hpp"
#include "firmware_like/config.hpp"
#include "firmware_like/degradation.hpp"
#include "firmware_like/frame.hpp"
#include "firmware_like/memory_plan.hpp"

namespace st {

class ModelLibrary;

// What a run's summary says of one confirmed object; outlives its track.
struct ObjectCount {
  int id = 0;
  double first_t_s = 0, last_t_s = 0;  // first and last published pose
  std::uint64_t tracked = 0, lost = 0;
  std::uint64_t aligned = 0, iterations = 0;  // frames with an alignment, and what those took together
  bool good_at_end = false, left_view = false;
  int named_model = -1;  // of the database: what it is
  int known_model = -1;  // the same, where its heading is known, too, and that model tracks it
  Pose T_model_object{};
};
// Recognition tracker: frames with a segment, and at which stage those without a pose failed.
struct MatchCounts {
  std::uint64_t frames = 0, found = 0;
  std::uint64_t no_keypoints = 0, no_matches = 0, no_agreement = 0, not_verified = 0;
};

using ObjectCounts = FixedVector<ObjectCount, 64>;

class ObjectTracker {
 public:
  static constexpr std::size_t kMaxPoints = 12288;  // observed points of one object
  static constexpr int kLeastPoints = 40;           // fewer say nothing
  static constexpr int kLeastNewcomer_px = 120;     // smaller segments begin no track and end no search

  ObjectTracker(const Calibration& calibration, const LoopConfig& config);
  ObjectTracker(const ObjectTracker&) = delete;  // the memory plan holds its address
  ObjectTracker& operator=(const ObjectTracker&) = delete;

  // The models of earlier runs, to be recognised; outlives this. Before plan_memory().
  void know(const ModelLibrary& library) { library_ = &library; }

  // Enters everything that needs memory into the plan; once the plan is sealed, start() makes it ready for
  // frames.
  void plan_memory(MemoryPlan& plan);
  void start();

  void preprocess(const FrameInput& input, FrameReport& report);
  void segment();
  void predict();
  void render();
  void associate_pixels();
  void align_all(const LadderStep& step);
  void judge_all();
  void integrate_all(const LadderStep& step);
  void decide_lives(const LadderStep& step);  // confirm, lose, find again, begin, evict
  void see(SeenObjects& objects) const;       // the confirmed ones, for whoever steers by them
  void publish(FrameReport& report);

  // For the end of a run.
  // The object that went along with the wheels up to now; 0: none, or more than one, did.
  int wheeled_id() const { return wheeled_id_; }
  std::span<const Track> tracks() const { return tracks_; }
  const ObjectCounts& counts() const { return counts_; }
  int volume_side() const { return config_.volume_side; }  // voxels
  const MatchCounts& match_counts() const { return match_counts_; }
  bool has_floor_frame() const { return has_floor_frame_; }
  const Pose& T_floor_camera() const { return T_floor_camera_; }
  bool floor_found() const { return support_.found; }

 private:
  void bind_images(Bump& memory);
  void bind_segmenter(Bump& memory);
  void bind_volumes(Bump& memory);
  void bind_views(Bump& memory);
  void bind_points(Bump& memory);
  void bind_integration(Bump& memory);
  void bind_recognition(Bump& memory);
  void bind_seen_features(Bump& memory);

  void update_support();
  bool ask_wheels(Track& track);
  bool is_alone(const Track& track) const;
  void judge_wheels(Track& track);
  void match_wheels();
  void align_one(Track& track, std::size_t k, const LadderStep& step);
  void judge_one(Track& track);
  void expect_heading(Track& track, AlignInput& in) const;
  void look_beside(Track& track, const AlignInput& in, std::size_t k);
  void defend_heading(Track& track, const AlignInput& in);
  void leave_floor(Track& track, const AlignInput& held);
  void return_to_floor(Track& track);
  AlignInput alignment_of(const Track& track, std::size_t k) const;
  std::span<ObservedPoint> points_of(std::size_t k);
  void render_one(Track& track, const Pose& T);
  void observe(Track& track, std::size_t k, const Rect& box);
  void look_at_colors(const Rect& box, const LadderStep& step);
  ImageView<std::uint32_t> register_colors(std::size_t k, const Rect& box);
  void keep_shape(const Track& track, std::size_t k);
  void fuse(Track& track, std::size_t k);
  void remember(const Track& track, std::size_t k);
  void note_integrated(Track& track, const IntegrateStats& stats);
  void fuse_at_rest(Track& track, const Rect& box);

  bool tracks_by_matches() const;
  void align_by_matches(Track& track, std::size_t k);
  bool match_database(Track& track);
  bool match_frame_before(Track& track, std::size_t k);
  void judge_matches(Track& track);
  bool knows_models() const;
  bool wants_look_up(const Track& track) const;
  void start_recognition();
  void recognition_step(const LadderStep& step);
  void prove(Track& track, const Recognised& answer);
  void settle(Track& track, const Recognised& answer, Doubt doubt);
  PatchCheck patches_at(Track& track, const Pose& T_camera_model);
  Doubt fit_to_frame(Track& track, Pose& T_camera_model);
  void adopt_model(Track& track, int known_model, const Pose& T_camera_model);

  void confirm(Track& track);
  bool is_proven(const Track& candidate) const;
  void confirm_proven();
  void lose(Track& track);
  void search_step(const LadderStep& step);
  void start_search();
  bool start_search_in(const Unexplained& what, std::size_t k);
  bool start_search_in_candidate(std::size_t j, std::size_t k);
  bool may_be_lost_one(const Track& candidate, const Track& lost) const;
  const Unexplained* searched_segment() const;
  std::size_t claim_searched();
  Pose search_anchor(const Footprint& footprint) const;
  std::uint8_t searched_owner() const;
  double try_pose(Track& track, const Pose& T_camera_object, bool turn);
  void refine(Search::Found& found, const Pose& T_camera_anchor);
  void finish_search(const Pose& T_camera_anchor);
  void refuse(const Rect& box, std::size_t k);
  void fill_rest(const Rect& box);
  void drop_fragments(const Rect& box);
  bool in_arena(const Vec3& p_camera) const;
  void begin_released();
  bool is_looked_for_in(const Unexplained& what) const;
  void begin_tracks();
  std::size_t make_room(Newness newness);
  void free_slot(Track& track);
  void evict(Track& track);
  void drop_doubles();
  bool begin_from_pixels(const Unexplained& what);
  void claim_pixels(const Unexplained& what, std::size_t k);
  void claim_near(const Unexplained& what, std::size_t k, const Vec3& centre, double radius_m);
  void log(EventKind kind, int object, double a = 0, double b = 0, double c = 0);
  ObjectSample sample_of(Track& track) const;
  ObjectCount* count_of(int id);  // null: more objects than the list holds
  void freeze_background();

  MemberPart<ObjectTracker> parts_[8];
  Calibration calibration_;
  LoopConfig config_;
  Frame frame_;
  Segmenter segmenter_;
  const Segmentation* segmentation_ = nullptr;
  WayMatch went_along_;  // with the wheels of the robot, if one is connected
  int wheeled_id_ = 0;   // the object that does; 0: none
  ColorRegistration registration_;
  Support support_;
  bool support_frozen_ = false;
  bool has_floor_frame_ = false;
  Pose T_floor_camera_;
  int next_id_ = 1;

  Track tracks_[kMaxObjects];
  Owned owned_[kMaxObjects];  // each track's pixels in this frame
  std::span<ObservedPoint> points_;
  RaycastScratch raycast_scratch_;
  AlignScratch scratch_;
  FrameViewMemory previous_[kMaxObjects];  // frame-to-frame mode: the view of the frame before
  ModelCloud clouds_[kMaxObjects];         // listing1 mode: the models as points
  ColorFrame color_frame_;                 // of where the objects are, or where one is searched
  ImageView<float> rest_z_;
  ImageView<std::uint32_t> registered_color_;  // of the objects' pixels, pack_rgb
  IntegrateScratch integrate_scratch_;
  const ModelLibrary* library_ = nullptr;
  Recognition recognition_;
  std::size_t recognised_track_ = 0;
  int recognised_id_ = 0;
  struct Proof {  // of the newest answer, against the frames at hand
    bool running = false;
    int looks = 0;
    Pose T_object_model;  // of the track that was looked up
    PatchCheck here;      // at that pose
    bool heading_open = false;
  } proof_;
  static constexpr int kLeastMatches = 3;
  struct SeenFeatures {  // of the last frame that was matched
    std::span<Feature> features;
    std::span<Descriptor> descriptors;
    std::size_t used = 0;
  } seen_features_[kMaxObjects];
  MatchCounts match_counts_;
  UnexplainedList unexplained_;
  Search search_;
  struct Newcomer {  // an unexplained segment that was there in the frame before, too
    Rect box;
    int frames = 0;
    std::uint8_t refused_by = 0;  // bit k: tracks[k] was looked for in it and is not it
    bool seen = false;
  };
  Newcomer* newcomer_at(const Rect& box);
  struct Barren {  // where a track came to nothing lately
    Rect box;
    int frames_left = 0;
  };
  void mark_barren(const Track& track);
  bool is_barren(const Unexplained& what) const;
  FixedVector<Barren, 12> barren_;
  FixedVector<Newcomer, 8> newcomers_;
  FixedVector<Event, 16> events_;
  ObjectCounts counts_;
};

}  // namespace st
