// Which of the tracked objects is the robot: the one that does what the robot is told. The robot makes a
// short start motion, and every object's motion is held against that of the wheels over the same time. A
// person, a second robot or a door moves at other times and in other ways; only one object may obey.
#pragma once

#include <array>
#include <span>

#include "algo/control/path.hpp"
#include "algo/control/wheel_motion.hpp"
#include "algo/core/records.hpp"
#include "algo/core/scalar_math.hpp"

namespace st {

inline constexpr double kStartWay_m = 0.045, kStartTurn_rad = 0.16;
// Never further than that from its start, whatever the frames and the wheels do.
inline constexpr double kStartAllowance_m = 0.05, kStartAllowance_rad = 10 * kPi / 180;

// Forward and back, left, right and back: it ends where it began. Planned. Turned twice as far to one side, a
// pose that is a millimetre wrong puts the turning centre half as far away.
Path start_motion();

// The speeds, slowed down so that the robot, which by its wheels has gone so far from where the start motion
// began, stays within the allowance for as long as a command may act.
WheelSpeeds within_start_allowance(const WheelSpeeds& speeds, double forward_m, double turn_rad,
                                   double wheel_base_m);

// What the tracker makes of one object in one frame.
struct SeenObject {
  int id = 0;                // 0: not confirmed
  bool good = false;         // the pose is
  bool has_heading = false;  // the heading as well
  Pose2 pose;                // floor frame
  BaseGuess guess;           // from its shape
};
using SeenObjects = FixedVector<SeenObject, kMaxObjects>;

struct Obedience {
  int id = 0;           // of the object; 0: none obeyed, or more than one
  double lag_s = 0;     // the frames are older than their stamps say, beside the wheels' reports
  double misfit_m = 0;  // RMS of its poses from where the wheels would have them, headings counted as ways
  BaseFit base;
  WheelRegression motion;  // what the fit came from
};

// Remembers what everything did while the robot moved. Fixed memory.
class StartWitness {
 public:
  static constexpr std::size_t kFrames = 480;  // 16 s

  void clear() { count_ = 0; }
  // A frame: the wheels since the one before, and all objects.
  void add(const WheelOdometry& wheels, const SeenObjects& objects);
  Obedience judge() const;

 private:
  struct Frame {
    double t_s = 0, forward_m = 0, turn_rad = 0;  // summed up since clear()
    SeenObjects objects;
  };
  struct Sample {  // of one object
    double t_s = 0;
    BodyMotion motion;
  };
  // An object's longest stretch without a gap.
  std::size_t stretch_of(int id, std::span<Sample> samples, BaseGuess& guess) const;
  Obedience fit(int id, std::span<const Sample> samples, const BaseGuess& guess, double lag_s) const;
  Obedience judge_one(int id) const;
  void wheels_at(double t_s, double& forward_m, double& turn_rad) const;

  std::array<Frame, kFrames> frames_{};
  std::size_t count_ = 0;
};

}  // namespace st
