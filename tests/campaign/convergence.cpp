// Who finds the robot after a jump, and who notices when he does not: the start of the alignment is where the
// robot stood, and now it stands 1 to 20 cm beside it, or turned by 1 to 30 degrees.
#include <cstdio>
#include <iterator>
#include <optional>

#include "algo/core/scalar_math.hpp"
#include "algo/tracking/align_beside.hpp"
#include "algo/tracking/closest_point.hpp"
#include "algo/tracking/frame_view.hpp"
#include "algo/tracking/judge.hpp"
#include "tests/campaign/campaign.hpp"
#include "tests/campaign/robot_views.hpp"
#include "tests/support/bound.hpp"

namespace st::campaign {
namespace {

constexpr double kDegree = kPi / 180;

struct Aligner {
  const char* name;
  enum Kind { kModelView, kFrameBefore, kCloud } kind;
  bool color, beside;  // takes part; headings beside the predicted one are looked at
  AlignTerms terms;
};
constexpr Aligner kAligners[] = {
    {"frame to frame", Aligner::kFrameBefore, true, false, {}},
    {"closest point (Listing 1)", Aligner::kCloud, false, false, {}},
    {"projective ICP alone", Aligner::kModelView, false, false, {false, false, false}},
    {"full, no motion prior", Aligner::kModelView, true, true, {true, true, false}},
    {"full estimator", Aligner::kModelView, true, true, {}},
};
constexpr std::size_t kKinds = std::size(kAligners);

struct Score {
  int tries = 0, found = 0, silent = 0;

  void count(const AlignResult& result, Verdict verdict, YawSource yaw, const Pose& truth) {
    constexpr double kFound_m = 0.010, kFound_rad = 2 * kDegree, kWrong_m = 0.030, kWrong_rad = 10 * kDegree;
    const double off_m = norm(result.T_camera_object.t - truth.t);
    const double off_rad = rotation_angle(result.T_camera_object.R.transposed() * truth.R);
    const bool good = verdict == Verdict::kGood;
    ++tries;
    found += good && off_m < kFound_m && off_rad < kFound_rad ? 1 : 0;
    silent += good && (off_m > kWrong_m || (off_rad > kWrong_rad && yaw != YawSource::kNone)) ? 1 : 0;
  }
};

class Jumps {
 public:
  Jumps(std::uint64_t seed, bool laptop) : views_("circle", seed, laptop) { learn(); }

  // One row: every place, every direction.
  void row(double jump_m, double jump_rad, Score (&scores)[kKinds]) {
    constexpr double kPlaces_s[] = {2.0, 6.5, 11.0, 15.5};
    constexpr int kDirections = 8;
    for (const double t_s : kPlaces_s) {
      const Pose before = views_.T_room_robot(t_s);
      stand(before);
      for (int k = 0; k < kDirections; ++k) {
        const SinCos to = sin_cos(2 * kPi * (k + 0.3) / kDirections);
        Pose after = before;
        after.t += Vec3{to.cos, to.sin, 0} * jump_m;
        after.R = before.R * rotation_z(k % 2 == 0 ? jump_rad : -jump_rad);
        const RobotFrame frame = views_.look(after);
        for (std::size_t i = 0; i < kKinds; ++i) try_one(kAligners[i], frame, habits_[i], &scores[i]);
      }
    }
  }

 private:
  // The model, as good as the scene's whole drive at its true poses makes it.
  void learn() {
    constexpr float kVoxel_m = 0.48f / 128, kTruncation_m = 4 * kVoxel_m;
    volume_.reset(kVoxel_m, kTruncation_m, {0, 0, 0.1f});
    for (double t_s = 1; t_s < 19; t_s += 0.15) {
      const RobotFrame frame = views_.look(views_.T_room_robot(t_s));
      integrate(volume_, frame.evidence(views_.camera()), frame.T_camera_robot, {}, integrating_);
    }
    cloud_.take(volume_);
  }

  // The robot has stood there for a while, and was tracked well.
  void stand(const Pose& T_room_robot) {
    const RobotFrame frame = views_.look(T_room_robot);
    start_ = frame.T_camera_robot;
    const Rect whole{0, 0, views_.camera().width, views_.camera().height};
    raycast(volume_, views_.camera(), whole, start_, raycasting_, rendered_.maps);
    rendered_.maps.roi = visible_rect(volume_, views_.camera(), start_);
    raycast(volume_, views_.camera(), rendered_.maps.roi, start_, raycasting_, rendered_.maps);
    rendered_.T_camera_object = start_;
    remember_frame(frame_before_, frame.depth_z, frame.owners, RobotViews::kRobot, frame.box, views_.camera(),
                   frame.color, start_);
    constexpr double kPeriod_s = 1.0 / 30, kSigma_m = 0.001, kSigma_rad = 0.005;
    double covariance[36]{};
    for (int i = 0; i < 6; ++i) covariance[7 * i] = i < 3 ? kSigma_m * kSigma_m : kSigma_rad * kSigma_rad;
    motion_.start(start_, views_.support().R_camera_floor.transposed(), 0);
    for (int i = 1; i <= 30; ++i) {
      motion_.predict(i * kPeriod_s, MotionNoise{});
      if (i < 30) motion_.correct(start_, covariance);
    }
    for (int i = 0; i < 16; ++i) {
      const RobotFrame again = views_.look(T_room_robot);
      for (std::size_t k = 0; k < kKinds; ++k) {
        if (i == 0) habits_[k] = Habit{};
        try_one(kAligners[k], again, habits_[k], nullptr);
      }
    }
  }

  // Without a score: a frame of the time in which it stood, from which the habit of its track comes.
  void try_one(const Aligner& aligner, const RobotFrame& frame, Habit& habit, Score* score) {
    constexpr double kSettledTrack_m = 0.02;  // what the loop allows a track whose motion is known
    AlignInput in;
    in.points = frame.points;
    in.view = aligner.kind == Aligner::kFrameBefore ? frame_before_.view : rendered_;
    in.depth_z = frame.depth_z;
    in.camera = views_.camera();
    in.prior = motion_.prior();
    in.start = in.prior.mean;
    in.pivot = in.prior.mean.t;
    in.floor.on = true;
    in.floor.up_camera = views_.support().up;
    in.floor.d = views_.support().d;
    in.terms = aligner.terms;
    if (aligner.color) in.color = &frame.colors;
    in.color_time.tie.R_frame_camera = views_.support().R_camera_floor.transposed();
    in.largest_start_error_m = kSettledTrack_m;
    AlignResult result =
        aligner.kind == Aligner::kCloud ? align_closest_point(in, cloud_, aligning_) : align(in, aligning_);
    Mat3 turn;
    if (aligner.beside) align_beside(in, habit, views_.support().up, aligning_, result, turn);
    const Pose D = result.T_camera_object * in.view.T_camera_object.inverse();
    const Agreement agreement = compare(in.view, in.camera, in.depth_z, D, result.depth);
    if (score == nullptr) {
      habit.learn(result, agreement);
      return;
    }
    score->count(result, judge(result, agreement, habit), yaw_source_of(result, views_.support().up),
                 frame.T_camera_robot);
  }

  RobotViews views_;
  Volume volume_;
  IntegrateScratch integrating_;
  RaycastScratch raycasting_;
  AlignScratch aligning_;
  ModelCloud cloud_;
  ModelView rendered_;
  FrameViewMemory frame_before_;
  test::BoundMemory memory_{[this](Bump& bump) {
    volume_.bind(bump, 128);
    integrating_.bind(bump, 640, 480, 128);
    raycasting_.bind(bump, 640, 480);
    aligning_.bind(bump, 640, 480);
    cloud_.bind(bump);
    rendered_.maps.bind(bump, 640, 480);
    frame_before_.bind(bump, 640, 480);
  }};
  MotionFilter motion_;
  Pose start_;
  Habit habits_[kKinds];
};

void print_header(const char* what) {
  std::printf("\n| %s", what);
  for (const Aligner& aligner : kAligners) std::printf(" | %s", aligner.name);
  std::printf(" |\n|--:");
  for (std::size_t i = 0; i < kKinds; ++i) std::printf("|--:");
  std::printf("|\n");
}

void print_row(double jump, const Score (&scores)[kKinds]) {
  std::printf("| %g", jump);
  for (const Score& s : scores) std::printf(" | %d / %d", 100 * s.found / s.tries, 100 * s.silent / s.tries);
  std::printf(" |\n");
  std::fflush(stdout);
}

void print_tables(const char* robot, std::optional<Jumps> (&jumps)[kSeeds]) {
  std::printf(
      "\n%s: %% found (good, within 10 mm and 2 deg) / %% silently wrong (good, but 30 mm off, or 10 deg "
      "with a heading claimed)\n",
      robot);
  print_header("jump, cm");
  for (const double cm : {1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0}) {
    Score scores[kKinds];
    for (auto& j : jumps) j->row(cm * 0.01, 0, scores);
    print_row(cm, scores);
  }
  print_header("turn, deg");
  for (const double deg : {1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 15.0, 20.0, 30.0}) {
    Score scores[kKinds];
    for (auto& j : jumps) j->row(0, deg * kDegree, scores);
    print_row(deg, scores);
  }
}

}  // namespace

void print_convergence() {
  for (const bool laptop : {false, true}) {
    std::optional<Jumps> jumps[kSeeds];
    for (std::uint64_t i = 0; i < kSeeds; ++i) jumps[i].emplace(i + 1, laptop);
    print_tables(laptop ? "Robot with a laptop on top" : "Round robot", jumps);
  }
}

}  // namespace st::campaign
