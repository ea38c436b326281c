// What the robot itself knows of its wheels: single-channel encoders, whose direction is taken from the
// command, and the distance and angle that are summed up from them and cleared on reading.
#pragma once

#include <cstdint>

#include "hal/create/drive_base.hpp"

namespace st::sim {

class Odometer {
 public:
  // `keeps_fraction`: reading distance or angle leaves the part below 1 mm or 1 degree for the next reading.
  // The specification does not say; both kinds of firmware are reported.
  Odometer(const RobotGeometry& geometry, std::uint64_t seed, bool keeps_fraction);

  // Wheel rim speeds (left, right) over dt_s while these speeds are commanded.
  void advance(const double wheel_mps[2], const double commanded_mps[2], double dt_s);

  std::uint16_t count(int wheel) const { return counts_[wheel]; }
  int read_distance_mm() { return read(distance_mm_); }
  int read_angle_deg() { return read(angle_deg_); }
  double distance_mm() const { return distance_mm_; }
  double angle_deg() const { return angle_deg_; }
  void clear_distance() { distance_mm_ = 0; }
  void clear_angle() { angle_deg_ = 0; }

 private:
  int read(double& sum) const;

  RobotGeometry geometry_;
  bool keeps_fraction_;
  std::uint16_t counts_[2];
  int direction_[2] = {1, 1};
  double fraction_[2] = {0, 0};    // of the next count
  double turned_mps_[2] = {0, 0};  // how each wheel turned last
  double distance_mm_ = 0, angle_deg_ = 0;
};

}  // namespace st::sim
