#include "hal/create/wheel_log.hpp"

#include <limits>

#include "hal/create/odometry_decoder.hpp"
#include "hal/error.hpp"

namespace st {

WheelLog read_wheel_log(const std::string& recording, const WheelLog* first) {
  RobotLogReader reader;
  if (!reader.open(recording + "/robot.log") || !reader.model())
    throw Failure(ExitCode::kBadInput, recording +
                                           "/robot.log: not there, or it names no model; record with "
                                           "run --robot PORT --record DIR");
  WheelLog log;
  log.model = *reader.model();
  if (first != nullptr && log.model != first->model)
    throw Failure(ExitCode::kBadInput,
                  recording + "/robot.log: a Create " + (log.model == RobotModel::kCreate1 ? "1" : "2") +
                      ", and the recordings before it are of the other model; give those of one robot");
  log.wheels = first != nullptr ? first->wheels : reader.geometry().value_or(oi::default_geometry(log.model));
  const RobotBytes decode = decode_odometry(
      log.model, log.wheels, [&](const OdometrySample& sample) { log.travel.push_back(sample); });
  reader.pump_until_time(std::numeric_limits<double>::infinity(), decode);
  return log;
}

}  // namespace st
