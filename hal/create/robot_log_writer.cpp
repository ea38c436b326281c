#include "hal/create/robot_log_writer.hpp"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "hal/error.hpp"
#include "hal/recording/robot_log.hpp"

namespace st {

double host_seconds() {
  timespec t{};
  clock_gettime(CLOCK_REALTIME, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

RobotLogWriter::RobotLogWriter(const std::string& path) {
  if (path.empty()) return;
  fd_ = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd_ < 0)
    throw Failure(ExitCode::kBadInput, "robot log " + path + ": " + std::strerror(errno) +
                                           "; check the folder and its free space");
}

RobotLogWriter::~RobotLogWriter() {
  if (fd_ >= 0) close(fd_);
}

void RobotLogWriter::set_robot(RobotModel model, const RobotGeometry& wheels) {
  model_known_ = true;
  write_line(robot_log_first_line(model) + robot_log_wheels_line(wheels) + kept_back_);
  kept_back_.clear();
}

void RobotLogWriter::add(double t_s, bool from_robot, std::span<const std::uint8_t> bytes) {
  if (fd_ < 0 || bytes.empty()) return;
  const std::string line = format_robot_log_line(t_s, from_robot, bytes);
  if (model_known_)
    write_line(line);
  else
    kept_back_ += line;
}

void RobotLogWriter::write_line(const std::string& line) {
  if (fd_ < 0) return;
  // A full disk must not stop the robot's reader; the recording's own writer reports it.
  const ssize_t written = write(fd_, line.data(), line.size());
  if (written > 0) bytes_ += static_cast<std::uint64_t>(written);
}

}  // namespace st
