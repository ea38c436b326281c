// From PORT of the command line to a robot that obeys.
#include "hal/create/create_robot.hpp"

namespace st {

std::unique_ptr<DriveBase> open_robot(const RobotOptions& options) {
  auto log = std::make_unique<RobotLogWriter>(options.log_path);
  std::unique_ptr<SimChild> sim;
  if (is_simulated(options.port))
    sim =
        std::make_unique<SimChild>(options.port, options.model.value_or(RobotModel::kCreate2), options.seed);
  auto port = std::make_unique<RobotPort>(sim ? sim->port() : options.port);
  const RobotIdentity identity = meet_robot(*port, options.model, *log);
  RobotGeometry wheels = oi::default_geometry(identity.model);
  if (options.wheels.wheel_base_m > 0) wheels.wheel_base_m = options.wheels.wheel_base_m;
  if (options.wheels.wheel_diameter_m > 0) wheels.wheel_diameter_m = options.wheels.wheel_diameter_m;
  if (options.wheels.counts_per_turn > 0) wheels.counts_per_turn = options.wheels.counts_per_turn;
  auto robot =
      std::make_unique<CreateRobot>(std::move(port), identity, wheels, std::move(log), std::move(sim));
  robot->take_control();
  return robot;
}

}  // namespace st
