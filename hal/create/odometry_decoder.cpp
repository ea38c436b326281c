#include "hal/create/odometry_decoder.hpp"

#include <memory>

namespace st {

RobotBytes decode_odometry(RobotModel model, const std::optional<RobotGeometry>& geometry,
                           OdometrySink sink) {
  auto stream = std::make_shared<OdometryStream>(model, geometry.value_or(oi::default_geometry(model)));
  return [stream, sink = std::move(sink)](double t_s, bool from_robot, std::span<const std::uint8_t> bytes) {
    if (!from_robot)
      stream->sent(bytes);
    else
      stream->receive(
          t_s, bytes, [](const SensorState&) {}, sink);
  };
}

}  // namespace st
