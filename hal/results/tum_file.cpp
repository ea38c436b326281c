#include "hal/results/tum_file.hpp"

#include <algorithm>

#include "hal/results/csv_table.hpp"

namespace st {
namespace {

std::string_view next_field(std::string_view& line) {
  constexpr std::string_view kBetween = " \t\r,";
  const std::size_t begin = line.find_first_not_of(kBetween);
  if (begin == std::string_view::npos) {
    line = {};
    return {};
  }
  line.remove_prefix(begin);
  const std::string_view field = line.substr(0, line.find_first_of(kBetween));
  line.remove_prefix(field.size());
  return field;
}

bool parse_pose(std::string_view line, TumPose& pose) {
  double value[8];
  for (double& v : value)
    if (!parse_number(next_field(line), v)) return false;
  const Quaternion q{value[4], value[5], value[6], value[7]};
  constexpr double kLeast = 1e-12, kMost = 1e12;  // of the squared length: beyond them it is no rotation
  const double length2 = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!(length2 >= kLeast && length2 <= kMost)) return false;
  pose.t_s = value[0];
  pose.T = {from_quaternion(q), {value[1], value[2], value[3]}};
  const std::string_view track = next_field(line);
  if (!track.empty()) pose.track = track;
  return true;
}

}  // namespace

TumTrajectory parse_tum(std::string_view text) {
  TumTrajectory trajectory;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    std::string_view rest = line;
    const std::string_view first = next_field(rest);
    if (first.empty() || first.front() == '#') continue;
    TumPose pose;
    if (parse_pose(line, pose))
      trajectory.poses.push_back(std::move(pose));
    else
      ++trajectory.dropped_lines;
  }
  std::ranges::stable_sort(trajectory.poses, {}, &TumPose::t_s);
  return trajectory;
}

}  // namespace st
