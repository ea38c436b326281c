#include "firmware_like/path_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "algo/core/pose.hpp"
#include "algo/core/scalar_math.hpp"
#include "hal/error.hpp"
#include "hal/recording/text.hpp"

namespace st {
namespace {

constexpr double kSamePoint_m = 1e-3;
constexpr double kSameHeading_rad = 1e-6;
constexpr double kFarthest_m = 100;
constexpr std::size_t kLargestFile = 1 << 20;

[[noreturn]] void refuse(const std::string& name, int line, const std::string& what) {
  throw Failure(ExitCode::kBadInput, name + ":" + std::to_string(line) + ": " + what);
}

// Turn towards the point, then drive to it.
bool add_way_point(Path& path, Pose2& at, double x, double y) {
  const double dx = x - at.x, dy = y - at.y, length = std::sqrt(dx * dx + dy * dy);
  if (length < kSamePoint_m) return true;
  const double heading = arc_tan2(dy, dx), turn = wrap_angle(heading - at.yaw);
  bool fits = std::fabs(turn) < kSameHeading_rad || path.add_turn(turn);
  fits = path.add_line(length) && fits;
  at = {x, y, heading};
  return fits;
}

}  // namespace

Path load_path(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf()))
    throw Failure(ExitCode::kBadInput, "path " + file + ": " +
                                           (in ? "it is empty or no file" : std::strerror(errno)) +
                                           "; examples are in examples/paths");
  const std::string content = text.str();
  if (content.size() > kLargestFile)
    throw Failure(ExitCode::kBadInput, "path " + file + ": larger than 1 MiB; is it a path?");
  return file.ends_with(".csv") ? parse_path_csv(content, file) : parse_path_toml(content, file);
}

Path parse_path_csv(std::string_view text, const std::string& name) {
  Path path;
  Pose2 at;
  bool header = false;
  int line_number = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    ++line_number;
    if (line.empty() || line.front() == '#') continue;
    const std::size_t comma = line.find(',');
    const std::string_view first = trimmed(line.substr(0, comma));
    const std::string_view second = comma == std::string_view::npos ? "" : trimmed(line.substr(comma + 1));
    if (!header) {
      if (first != "x" || second != "y")
        refuse(name, line_number, "the first line must be `x,y`, then one point a line in metres");
      header = true;
      continue;
    }
    double x = 0, y = 0;
    if (!parse_number(first, x) || !parse_number(second, y) || !(std::fabs(x) <= kFarthest_m) ||
        !(std::fabs(y) <= kFarthest_m))
      refuse(name, line_number,
             "`" + std::string(line.substr(0, 40)) + "` is not a point `x,y` in metres, each within 100");
    if (!add_way_point(path, at, x, y))
      refuse(name, line_number,
             std::string("too many points; ") + std::to_string(Path::kMaxSegments / 2) + " are allowed");
  }
  if (path.empty())
    refuse(name, line_number, "no way points besides the start; give at least one line `x,y`");
  path.plan();
  return path;
}

}  // namespace st
