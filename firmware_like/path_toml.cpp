// The TOML grammar of path programs; see path_file.hpp.
#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <utility>
#include <vector>

#include "algo/core/scalar_math.hpp"
#include "firmware_like/path_file.hpp"
#include "hal/error.hpp"

namespace st {
namespace {

constexpr double kWidestBase_m = 0.26;  // of a Create 1; the Create 2 is narrower
constexpr double kFastestWheel_mps = 0.5;
constexpr int kDeepestRepeat = 4;
constexpr double kDegree = kPi / 180;
constexpr double kBody_m = 0.17;
constexpr double kAreaStep_s = 0.05;  // at 0.5 m/s, 25 mm
constexpr int kMostPlaces = 20000;    // of one arc
constexpr std::string_view kSteps = "line, turn, wait, arc, circle, square, polygon, figure_eight, repeat";

struct Range {
  double low, high;
};

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string quoted(std::string_view word) {
  std::string text = "`";
  text += word;
  return text += '`';
}

class Reader {
 public:
  Reader(Path& path, const std::string& name) : path_(path), name_(name) {}

  void read(const toml::table& root) {
    const toml::array* steps = nullptr;
    for (const auto& [key, node] : root) {
      const std::string_view k = key.str();
      if (k == "speed_mps")
        path_.limits.speed_mps = number(node, k, {0.01, 0.5});
      else if (k == "accel_mps2")
        path_.limits.accel_mps2 = number(node, k, {0.05, 2.0});
      else if (k == "turn_deg_per_s")
        path_.limits.turn_rps = kDegree * number(node, k, {1, 240});
      else if (k == "area")
        read_area(table_of(node, k, {"x_m", "y_m"}));
      else if (k == "step" && node.is_array())
        steps = node.as_array();
      else
        refuse(node, quoted(k) +
                         " is not known here; allowed: speed_mps, accel_mps2, turn_deg_per_s, area and "
                         "[[step]] tables");
    }
    if (steps == nullptr || steps->empty())
      throw Failure(ExitCode::kBadInput,
                    name_ + ":1: no steps; add `[[step]]` and a line such as `line = 1.0`");
    read_steps(*steps, 0);
    path_.plan();
    check_area();
  }

 private:
  [[noreturn]] void refuse(const toml::node& node, const std::string& what) const {
    throw Failure(ExitCode::kBadInput, name_ + ":" + std::to_string(node.source().begin.line) + ": " + what);
  }

  void read_steps(const toml::array& steps, int depth) {
    for (const toml::node& step : steps) {
      const toml::table* table = step.as_table();
      if (table == nullptr || table->size() != 1)
        refuse(step, std::string("a step holds exactly one of ") + std::string(kSteps));
      for (const auto& [key, node] : *table) read_step(key.str(), node, depth);
    }
  }

  void read_step(std::string_view kind, const toml::node& node, int depth) {
    bool fits = true;
    if (kind == "line")
      fits = path_.add_line(nonzero(node, kind, 100));
    else if (kind == "turn")
      fits = path_.add_turn(kDegree * nonzero(node, kind, 3600));
    else if (kind == "wait")
      fits = path_.add_wait(number(node, kind, {0, 3600}));
    else if (kind == "arc")
      fits = read_arc(table_of(node, kind, {"radius_m", "angle_deg"}));
    else if (kind == "circle")
      fits = read_circle(table_of(node, kind, {"radius_m", "turns", "direction"}));
    else if (kind == "square")
      fits = read_square(table_of(node, kind, {"side_m", "direction"}));
    else if (kind == "polygon")
      fits = read_polygon(table_of(node, kind, {"sides", "side_m", "direction"}));
    else if (kind == "figure_eight")
      fits = read_figure_eight(table_of(node, kind, {"radius_m", "turns", "direction"}));
    else if (kind == "repeat")
      read_repeat(table_of(node, kind, {"times", "steps"}), depth);
    else
      refuse(node, quoted(kind) + " is no step; allowed: " + std::string(kSteps));
    if (!fits)
      refuse(node, std::string("the path has too many steps; ") + std::to_string(Path::kMaxSegments) +
                       " are allowed, repeats counted out");
    check_wheels(node);
    lines_.resize(path_.size(), line_of(node));
  }

  bool read_arc(const toml::table& t) {
    const double radius = number(need(t, "radius_m"), "radius_m", kRadius);
    return path_.add_arc(radius, kDegree * nonzero(need(t, "angle_deg"), "angle_deg", 36000));
  }

  bool read_circle(const toml::table& t) {
    const double radius = number(need(t, "radius_m"), "radius_m", kRadius);
    const toml::node* turns = t.get("turns");
    return path_.add_arc(
        radius, direction(t) * 2 * kPi * (turns != nullptr ? number(*turns, "turns", {0.01, 100}) : 1.0));
  }

  bool read_square(const toml::table& t) {
    return path_.add_square(number(need(t, "side_m"), "side_m", {0.05, 100}), direction(t));
  }

  bool read_polygon(const toml::table& t) {
    const double sides = whole(need(t, "sides"), "sides", {3, 36});
    const double side = number(need(t, "side_m"), "side_m", {0.05, 100});
    bool fits = true;
    for (int i = 0; i < static_cast<int>(sides); ++i)
      fits = path_.add_line(side) && path_.add_turn(direction(t) * 2 * kPi / sides) && fits;
    return fits;
  }

  // Two circles that touch where it starts.
  bool read_figure_eight(const toml::table& t) {
    const double radius = number(need(t, "radius_m"), "radius_m", kRadius);
    const toml::node* turns = t.get("turns");
    const double count = turns != nullptr ? whole(*turns, "turns", {1, 100}) : 1.0;
    bool fits = true;
    for (int i = 0; i < static_cast<int>(count); ++i)
      fits = path_.add_arc(radius, direction(t) * 2 * kPi) &&
             path_.add_arc(radius, -direction(t) * 2 * kPi) && fits;
    return fits;
  }

  void read_area(const toml::table& t) {
    for (const auto& [key, range] : {std::pair{"x_m", &area_x_}, std::pair{"y_m", &area_y_}}) {
      const toml::node& node = need(t, key);
      const toml::array* ends = node.as_array();
      if (ends == nullptr || ends->size() != 2)
        refuse(node, std::string(key) + " must be [least, most] in metres from where the robot starts");
      *range = {number(*ends->get(0), key, {-100, 100}), number(*ends->get(1), key, {-100, 100})};
      if (range->low >= range->high) refuse(node, std::string(key) + ": the first must be the smaller one");
    }
  }

  // Every place of the path, with the robot's body around it.
  void check_area() const {
    for (std::size_t i = 0; i < path_.size(); ++i) {
      const PathSegment& s = path_.segment(i);
      const double end_s = s.start.t_s + s.duration_s;
      // Lines have their extremes at their ends; a long arc goes round and round.
      const double step_s =
          s.kind != SegmentKind::kArc ? s.duration_s : std::max(kAreaStep_s, s.duration_s / kMostPlaces);
      for (double t_s = s.start.t_s;; t_s = std::min(t_s + step_s, end_s)) {
        const PathSample at = sample(path_, t_s);
        const auto leaves = [](double v, Range r) { return v - kBody_m < r.low || v + kBody_m > r.high; };
        if (leaves(at.x_m, area_x_) || leaves(at.y_m, area_y_))
          throw Failure(ExitCode::kBadInput,
                        name_ + ":" + std::to_string(lines_[i]) +
                            ": the robot, 0.17 m around its centre, would leave the area at x " +
                            text_of(at.x_m) + ", y " + text_of(at.y_m) + " m");
        if (t_s >= end_s) break;
      }
    }
  }

  void read_repeat(const toml::table& t, int depth) {
    const double count = whole(need(t, "times"), "times", {1, 500});
    const toml::array* steps = need(t, "steps").as_array();
    if (steps == nullptr || steps->empty())
      refuse(need(t, "steps"), "steps must be a list such as [ { line = 0.5 }, { turn = 120 } ]");
    if (depth >= kDeepestRepeat)
      refuse(t, std::string("repeat within repeat goes ") + std::to_string(kDeepestRepeat) + " deep at most");
    for (int i = 0; i < static_cast<int>(count); ++i) read_steps(*steps, depth + 1);
  }

  double number(const toml::node& node, std::string_view key, Range range) const {
    const std::optional<double> value = node.value<double>();
    const std::string allowed =
        std::string("; allowed: ") + text_of(range.low) + " to " + text_of(range.high);
    if (!value || node.is_boolean()) refuse(node, std::string(key) + " must be a number" + allowed);
    if (!(*value >= range.low && *value <= range.high))
      refuse(node, std::string(key) + " = " + text_of(*value) + allowed);
    return *value;
  }

  double whole(const toml::node& node, std::string_view key, Range range) const {
    const double value = number(node, key, range);
    if (value != std::floor(value))
      refuse(node, std::string(key) + " = " + text_of(value) + "; it must be a whole number");
    return value;
  }

  double nonzero(const toml::node& node, std::string_view key, double most) const {
    const double value = number(node, key, {-most, most});
    if (std::fabs(value) < 1e-3)
      refuse(node,
             std::string(key) + " = " + text_of(value) + " moves nothing; leave the step out or use wait");
    return value;
  }

  double direction(const toml::table& t) const {
    const toml::node* node = t.get("direction");
    if (node == nullptr) return 1;
    const std::optional<std::string> word = node->value<std::string>();
    if (word == "left") return 1;
    if (word == "right") return -1;
    refuse(*node, "direction must be \"left\" or \"right\"");
  }

  const toml::node& need(const toml::table& t, std::string_view key) const {
    const toml::node* node = t.get(key);
    if (node == nullptr) refuse(t, std::string(key) + " is missing");
    return *node;
  }

  const toml::table& table_of(const toml::node& node, std::string_view kind,
                              std::initializer_list<std::string_view> keys) const {
    std::string allowed;
    for (const std::string_view key : keys)
      allowed += std::string(allowed.empty() ? "" : ", ") + std::string(key);
    const toml::table* table = node.as_table();
    if (table == nullptr) refuse(node, std::string(kind) + " must be a table { " + allowed + " }");
    for (const auto& [key, value] : *table) {
      bool known = false;
      for (const std::string_view k : keys) known = known || k == key.str();
      if (!known)
        refuse(value, std::string(kind) + ": " + quoted(key.str()) + " is not known; allowed: " + allowed);
    }
    return *table;
  }

  void check_wheels(const toml::node& node) const {
    const double fastest = path_.fastest_wheel_mps(kWidestBase_m);
    if (fastest > kFastestWheel_mps)
      refuse(node, std::string("a wheel would have to turn at ") + text_of(fastest) +
                       " m/s; 0.5 is the robot's most: lower speed_mps or "
                       "turn_deg_per_s, or widen the curve");
  }

  int line_of(const toml::node& node) const { return static_cast<int>(node.source().begin.line); }

  static constexpr Range kRadius{0.05, 50};
  Range area_x_{-1e9, 1e9}, area_y_{-1e9, 1e9};
  std::vector<int> lines_;  // of each of the path's segments
  Path& path_;
  const std::string& name_;
};

}  // namespace

Path parse_path_toml(std::string_view text, const std::string& name) {
  Path path;
  try {
    Reader(path, name).read(toml::parse(text, name));
  } catch (const toml::parse_error& error) {
    throw Failure(ExitCode::kBadInput, name + ":" + std::to_string(error.source().begin.line) + ": " +
                                           std::string(error.description()));
  }
  return path;
}

}  // namespace st
