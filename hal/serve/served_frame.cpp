#include "hal/serve/served_frame.hpp"

#include <cmath>
#include <cstdio>

#include "hal/recording/text.hpp"
#include "hal/results/text_format.hpp"

namespace st {
namespace {

constexpr double kFastest_mps = 0.5, kFastest_rps = 4.3;  // of a Create: both wheels, and on the spot

void field(std::string& out, const char* name, double value, int decimals) {
  if (out.back() != '{') out += ", ";
  out += '"';
  out += name;
  out += "\": ";
  append_fixed(out, std::isfinite(value) ? value : 0.0, decimals);
}

void word(std::string& out, const char* name, const char* value) {
  if (out.back() != '{') out += ", ";
  out += std::string("\"") + name + "\": \"" + value + "\"";
}

void robot(std::string& out, const ServedRobot& robot) {
  out += ", \"robot\": {";
  word(out, "state", robot.state);
  word(out, "held_by", robot.held_by);
  field(out, "object", robot.object, 0);
  out += std::string(", \"seen\": ") + (robot.seen ? "true" : "false");
  field(out, "x", robot.base_now.x, 4);
  field(out, "y", robot.base_now.y, 4);
  field(out, "yaw", robot.base_now.yaw, 4);
  field(out, "frame_x", robot.base.x, 4);
  field(out, "frame_y", robot.base.y, 4);
  field(out, "frame_yaw", robot.base.yaw, 4);
  field(out, "told_v", robot.told_v_mps, 4);
  field(out, "told_w", robot.told_w_rps, 4);
  out += '}';
}

void object(std::string& out, const ObjectSample& sample) {
  out += '{';
  field(out, "id", sample.id, 0);
  word(out, "state", name_of(sample.state));
  if (sample.in_tum) {
    const Vec3& t = sample.T_floor_object.t;
    const Vec3 rpy = to_roll_pitch_yaw(sample.T_floor_object.R);
    field(out, "x", t.x, 4);
    field(out, "y", t.y, 4);
    field(out, "z", t.z, 4);
    field(out, "roll", rpy.x, 4);
    field(out, "pitch", rpy.y, 4);
    field(out, "yaw", rpy.z, 4);
    field(out, "vx", sample.velocity_mps.x, 4);
    field(out, "vy", sample.velocity_mps.y, 4);
    field(out, "v", sample.v_mps, 4);
    field(out, "w", sample.w_rps, 4);
    word(out, "yaw_source", name_of(sample.yaw_source));
    out += ", \"covariance\": [";
    for (int i = 0; i < 21; ++i) {
      char text[32];
      std::snprintf(text, sizeof text, "%s%.3e", i == 0 ? "" : ", ", sample.covariance[i]);
      out += text;
    }
    out += ']';
  }
  out += '}';
}

}  // namespace

std::string json_line(const ServedFrame& frame) {
  const FrameReport& report = frame.report;
  std::string out = "{";
  field(out, "t", report.t_s, 6);
  field(out, "frame", static_cast<double>(report.index), 0);
  field(out, "latency_ms", 1e-3 * static_cast<double>(report.age_us + report.frame_us), 3);
  robot(out, frame.robot);
  out += ", \"objects\": [";
  for (std::size_t i = 0; i < report.objects.size(); ++i) {
    if (i > 0) out += ", ";
    object(out, report.objects[i]);
  }
  out += "]}\n";
  return out;
}

bool parse_client_line(std::string_view line, ClientCommand& command, std::string& error) {
  line = trimmed(line);
  const std::string_view verb = take_word(line);
  command.v_mps = command.w_rps = 0;
  if (verb == "stop" && trimmed(line).empty()) return true;
  const bool numbers = verb == "drive" && parse_number(take_word(line), command.v_mps) &&
                       parse_number(take_word(line), command.w_rps) && trimmed(line).empty();
  if (!numbers)
    error = "not understood; say `drive V W` in m/s and rad/s, or `stop`";
  else if (!(std::fabs(command.v_mps) <= kFastest_mps && std::fabs(command.w_rps) <= kFastest_rps))
    error = "too fast; at most 0.5 m/s and 4.3 rad/s";
  return numbers;
}

}  // namespace st
