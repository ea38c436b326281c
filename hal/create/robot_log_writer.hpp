// Writes robot.log as the bytes pass: whole lines, each in one write, so that a killed run leaves whole
// lines. Until the model is known, lines are kept back, since the first line of the file names it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "hal/create/drive_base.hpp"

namespace st {

double host_seconds();  // of the real-time clock: the stamps of a recording

class RobotLogWriter {
 public:
  // An empty path writes nothing. Throws Failure (kBadInput) when the file cannot be made.
  explicit RobotLogWriter(const std::string& path);
  ~RobotLogWriter();
  RobotLogWriter(const RobotLogWriter&) = delete;
  RobotLogWriter& operator=(const RobotLogWriter&) = delete;

  void set_robot(RobotModel model, const RobotGeometry& wheels);
  std::uint64_t bytes() const { return bytes_; }  // written until now
  void add(double t_s, bool from_robot, std::span<const std::uint8_t> bytes);

 private:
  void write_line(const std::string& line);

  int fd_ = -1;
  std::uint64_t bytes_ = 0;
  bool model_known_ = false;
  std::string kept_back_;
};

}  // namespace st
