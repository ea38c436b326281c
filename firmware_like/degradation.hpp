// What a live loop leaves out when it is late: a fixed ladder, one step down for every late frame, and back
// up only after a while of frames that were well in time. A pure state machine on the times it is given. A
// replay never walks it: it takes each frame's level from the recording (FrameInput::recorded_level), so that
// it computes what the live run computed.
#pragma once

namespace st {

struct LadderStep {
  int level;
  const char* name;
  bool color_term;   // colour takes part: in an object's pose, or in what a scan fuses
  int point_stride;  // every n-th pixel of the object enters the pose; of a scan, every n-th column and row
  bool integrate;    // the frame enters the model
  int search_tries;  // poses that are tried for a lost object in a frame; a lost camera tries one
};

// 0 is full work. Colour goes first: depth, floor and odometry still hold the pose. The model comes last:
// without integration the pose is as good as before for as long as the same surface is seen.
inline constexpr LadderStep kLadder[] = {
    {0, "full work", true, 1, true, 9},
    {1, "no colour", false, 1, true, 6},
    {2, "every second point", false, 2, true, 3},
    {3, "no integration", false, 2, false, 3},
};
inline constexpr int kLevels = static_cast<int>(sizeof kLadder / sizeof kLadder[0]);

// The step for a level from a file or a frame; out of range is clamped.
const LadderStep& ladder_step(int level);

class Degradation {
 public:
  explicit Degradation(double period_s) : period_us_(period_s * 1e6) {}

  static constexpr double kLate = 0.90;        // of the period: no room for the next frame's jitter
  static constexpr double kEasy = 0.60;        // of the period: room for the work that would come back
  static constexpr int kEasyFrames = 30;       // this many in a row before one step back
  static constexpr int kMostEasyFrames = 480;  // each relapse doubles the wait, up to this

  // The frame just done cost `cpu_us`. Returns the level for the next one.
  int next(double cpu_us);
  int level() const { return level_; }

 private:
  double period_us_;
  int level_ = 0;
  int easy_ = 0;              // easy frames in a row
  int wait_ = kEasyFrames;    // easy frames that the next step back needs
  int since_step_back_ = -1;  // frames since the last step back; -1: none to judge
};

}  // namespace st
