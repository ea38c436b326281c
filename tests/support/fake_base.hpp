// A robot of which a test says how it is, and which remembers what it was told.
#pragma once

#include "hal/create/drive_base.hpp"

namespace st {

class FakeBase final : public DriveBase {
 public:
  bool drive(double left_mps, double right_mps) override {
    left = left_mps, right = right_mps;
    return true;
  }
  bool stop() override { return drive(0, 0); }
  void poll(FixedVector<OdometrySample, 64>& odometry, RobotStatus& status) override {
    status.fault = fault;
    for (const OdometrySample& sample : reports) odometry.push_back(sample);
    reports.clear();
  }
  RobotGeometry geometry() const override { return {}; }
  RobotModel model() const override { return RobotModel::kCreate2; }
  void close() override {}

  RobotFault fault = RobotFault::kNone;
  double left = 0, right = 0;               // m/s
  FixedVector<OdometrySample, 64> reports;  // for the next poll()
};

}  // namespace st
