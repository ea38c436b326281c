// The TOML grammar of path programs; see path_file.hpp.
#include <toml++/toml.h>
#include <cmath>
#include <cstdio>
#include <initializer_list>

#include "algo/core/scalar_math.hpp"
#include "firmware_like/path_file.hpp"
#include "hal/error.hpp"

namespace st {
namespace {

constexpr double kWidestBase_m = 0.26;  // of a Create 1; the Create 2 is narrower
constexpr double kFastestWheel_mps = 0.5;
constexpr int kDeepestRepeat = 4;
constexpr double kDegree = kPi / 180;

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
      else if (k == "step" && node.is_array())
        steps = node.as_array();
      else
        refuse(node,
               quoted(k) +
                   " is not known here; allowed: speed_mps, accel_mps2, turn_deg_per_s and [[step]] tables");
    }
    if (steps == nullptr || steps->empty())
      throw Failure(ExitCode::kBadInput,
                    name_ + ":1: no steps; add `[[step]]` and a line such as `line = 1.0`");
    read_steps(*steps, 0);
  }

 private:
  [[noreturn]] void refuse(const toml::node& node, const std::string& what) const {
    throw Failure(ExitCode::kBadInput, name_ + ":" + std::to_string(node.source().begin.line) + ": " + what);
  }

  void read_steps(const toml::array& steps, int depth) {
    for (const toml::node& step : steps) {
      const toml::table* table = step.as_table();
      if (table == nullptr || table->size() != 1)
        refuse(step, "a step holds exactly one of line, turn, wait, arc, circle, square, repeat");
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
    else if (kind == "repeat")
      read_repeat(table_of(node, kind, {"times", "steps"}), depth);
    else
      refuse(node, quoted(kind) + " is no step; allowed: line, turn, wait, arc, circle, square, repeat");
    if (!fits)
      refuse(node, std::string("the path has too many steps; ") + std::to_string(Path::kMaxSegments) +
                       " are allowed, repeats counted out");
    check_wheels(node);
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

  void read_repeat(const toml::table& t, int depth) {
    const toml::node& times = need(t, "times");
    const double count = number(times, "times", {1, 500});
    if (count != std::floor(count))
      refuse(times, std::string("times = ") + text_of(count) + "; it must be a whole number");
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

  static constexpr Range kRadius{0.05, 50};
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
  path.plan();
  return path;
}

}  // namespace st
