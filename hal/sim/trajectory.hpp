// What a robot of a scene does: commands, and the way it takes for them.
#pragma once

#include <vector>

#include "hal/sim/diff_drive_body.hpp"
#include "hal/sim/scene.hpp"

namespace st::sim {

// Sampled at 200 Hz, linear between; holds its ends.
class Trajectory {
 public:
  // Stands at `start` until start_s, then obeys the commands, until end_s.
  Trajectory(const Pose2& start, double start_s, double end_s, const std::vector<DriveCommand>& commands,
             double wheel_base_m, const DiffDriveErrors& errors, std::uint64_t seed);
  Pose2 at(double t_s) const;
  const std::vector<Pose2>& poses() const { return poses_; }

 private:
  std::vector<Pose2> poses_;
};

// The way of a robot without faults and with no limit to its acceleration, every 20 ms.
std::vector<PresetSample> ideal_path(const std::vector<DriveCommand>& commands);

// Builds a list of commands move by move; the last one stops.
class Moves {
 public:
  Moves& wait(double seconds) { return add(seconds, 0, 0); }
  Moves& straight(double metres, double v_mps) { return add(metres / v_mps, v_mps, 0); }
  Moves& back(double metres, double v_mps) { return add(metres / v_mps, -v_mps, 0); }
  Moves& turn(double rad, double w_rps) {
    return add((rad < 0 ? -rad : rad) / w_rps, 0, rad < 0 ? -w_rps : w_rps);
  }
  // To the left for a positive radius.
  Moves& bend(double radius_m, double rad, double v_mps) {
    const double r = radius_m < 0 ? -radius_m : radius_m;
    return add(r * rad / v_mps, v_mps, v_mps / radius_m);
  }
  std::vector<DriveCommand> done() {
    commands_.push_back({t_s_, 0, 0});
    return commands_;
  }
  double seconds() const { return t_s_; }

 private:
  Moves& add(double seconds, double v, double w) {
    commands_.push_back({t_s_, v, w});
    t_s_ += seconds;
    return *this;
  }
  std::vector<DriveCommand> commands_;
  double t_s_ = 0;
};

}  // namespace st::sim
