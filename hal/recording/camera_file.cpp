#include "hal/recording/camera_file.hpp"

#include <toml++/toml.h>

#include <cmath>
#include <initializer_list>

#include "hal/error.hpp"
#include "hal/recording/line_reader.hpp"
#include "hal/recording/text.hpp"

namespace st {
namespace {

constexpr std::size_t kMaxFileBytes = 1 << 16;

// One table of the file, with the words for what is wrong in it.
class Table {
 public:
  Table(const toml::table& table, std::string file, std::string prefix)
      : table_(table), file_(std::move(file)), prefix_(std::move(prefix)) {}

  [[noreturn]] void fail(const toml::node& at, const std::string& what) const {
    throw Failure(ExitCode::kBadInput, file_ + ":" + std::to_string(at.source().begin.line) + ": " + what);
  }

  [[noreturn]] void fail_whole(const std::string& what) const {
    throw Failure(ExitCode::kBadInput,
                  file_ + ":" + std::to_string(table_.source().begin.line) + ": " + what);
  }

  void allow_only(std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, node] : table_) {
      bool known = false;
      for (const std::string_view k : keys) known = known || k == key.str();
      if (known) continue;
      std::string list;
      for (const std::string_view k : keys) list += (list.empty() ? "" : ", ") + std::string(k);
      throw Failure(ExitCode::kBadInput, file_ + ":" + std::to_string(key.source().begin.line) +
                                             ": unknown key '" + prefix_ + std::string(key.str()) +
                                             "'; known here: " + list);
    }
  }

  const toml::node* get(std::string_view key) const { return table_.get(key); }

  double number(const toml::node& node, const std::string& key) const {
    const std::optional<double> value = node.value<double>();
    const bool numeric = node.is_integer() || node.is_floating_point();
    if (!numeric || !value || !std::isfinite(*value))
      fail(node, "'" + prefix_ + key + "' must be a finite number");
    return *value;
  }
  void read(const std::string& key, double& value) const {
    if (const toml::node* node = get(key)) value = number(*node, key);
  }
  void read_positive(const std::string& key, double& value) const {
    read(key, value);
    if (!(value > 0)) fail(*get(key), "'" + prefix_ + key + "' must be above 0");
  }
  void read_size(const std::string& key, int limit, int& value) const {
    const toml::node* node = get(key);
    if (node == nullptr) return;
    const std::optional<std::int64_t> whole = node->value<std::int64_t>();
    if (!node->is_integer() || !whole || *whole < 1 || *whole > limit)
      fail(*node, "'" + prefix_ + key + "' must be a whole number from 1 to " + std::to_string(limit));
    value = static_cast<int>(*whole);
  }
  void read_bool(const std::string& key, bool& value) const {
    const toml::node* node = get(key);
    if (node == nullptr) return;
    if (!node->is_boolean()) fail(*node, "'" + prefix_ + key + "' must be true or false");
    value = *node->value<bool>();
  }
  void read_array(const std::string& key, std::size_t count, double* values) const {
    const toml::node* node = get(key);
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr || array->size() != count)
      fail(*node, "'" + prefix_ + key + "' must be a list of " + std::to_string(count) + " numbers");
    for (std::size_t i = 0; i < count; ++i) values[i] = number((*array)[i], key);
  }

  void read_intrinsics(Intrinsics& camera) const {
    read_size("width", kMaxWidth, camera.width);
    read_size("height", kMaxHeight, camera.height);
    read_positive("fx", camera.fx);
    read_positive("fy", camera.fy);
    read("cx", camera.cx);
    read("cy", camera.cy);
    read_array("k", 5, camera.k);
  }

 private:
  const toml::table& table_;
  std::string file_, prefix_;
};

bool is_rotation(const Mat3& R) {
  const Mat3 I = R * R.transposed();
  for (int i = 0; i < 9; ++i)
    if (!(std::fabs(I.m[i] - (i % 4 == 0 ? 1.0 : 0.0)) < 1e-3)) return false;
  return dot(cross(R.row(0), R.row(1)), R.row(2)) > 0;
}

void read_color(const Table& table, Calibration& calibration) {
  table.allow_only({"width", "height", "fx", "fy", "cx", "cy", "k", "registered", "R", "t"});
  table.read_bool("registered", calibration.color_registered);
  if (calibration.color_registered) {
    // Colour in the depth camera's pixels: what is not said is the depth camera's.
    calibration.color = calibration.depth;
    calibration.T_color_depth = Pose{};
  }
  table.read_intrinsics(calibration.color);
  if (calibration.color_registered && (calibration.color.width != calibration.depth.width ||
                                       calibration.color.height != calibration.depth.height))
    table.fail(*table.get("registered"), "registered colour must have the depth camera's width and height");
  Mat3 R = calibration.T_color_depth.R;
  table.read_array("R", 9, R.m);
  if (!is_rotation(R))
    table.fail(*table.get("R"),
               "'color.R' must be a rotation (rows of length 1, at right angles, determinant 1)");
  calibration.T_color_depth.R = orthonormalized(R);
  double t[3] = {calibration.T_color_depth.t.x, calibration.T_color_depth.t.y, calibration.T_color_depth.t.z};
  table.read_array("t", 3, t);
  calibration.T_color_depth.t = {t[0], t[1], t[2]};
}

void read_correction(const Table& table, DisparityCorrection& correction) {
  table.allow_only({"columns", "rows", "steps"});
  for (const char* key : {"columns", "rows", "steps"})
    if (table.get(key) == nullptr) table.fail_whole(std::string("'") + key + "' is missing");
  table.read_size("columns", DisparityCorrection::kMostColumns, correction.columns);
  table.read_size("rows", DisparityCorrection::kMostRows, correction.rows);
  if (correction.columns < 2) table.fail(*table.get("columns"), "at least 2 columns make a grid");
  if (correction.rows < 2) table.fail(*table.get("rows"), "at least 2 rows make a grid");
  constexpr double kMost_steps = 64;  // eight pixels of disparity: no sensor is so far off
  double steps[DisparityCorrection::kMostColumns * DisparityCorrection::kMostRows];
  const int nodes = correction.columns * correction.rows;
  table.read_array("steps", static_cast<std::size_t>(nodes), steps);
  for (int i = 0; i < nodes; ++i) {
    if (std::fabs(steps[i]) > kMost_steps) table.fail(*table.get("steps"), "a correction is beyond 64 steps");
    correction.steps[i] = static_cast<float>(steps[i]);
  }
}

template <typename Number>
std::string shortest(Number value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value).ptr;
  return {text, end};
}

std::string list_of(const double* values, std::size_t count) {
  std::string text = "[";
  for (std::size_t i = 0; i < count; ++i) text += (i > 0 ? ", " : "") + shortest(values[i]);
  return text + "]";
}

std::string format_correction(const DisparityCorrection& correction) {
  if (correction.empty()) return {};
  std::string text = "\n[correction]\ncolumns = " + std::to_string(correction.columns) +
                     "\nrows = " + std::to_string(correction.rows) + "\nsteps = [";
  for (int i = 0; i < correction.columns * correction.rows; ++i) {
    text += i == 0 ? "\n  " : i % correction.columns == 0 ? ",\n  " : ", ";
    text += shortest(correction.steps[i]);
  }
  return text + "\n]\n";
}

std::string format_intrinsics(const Intrinsics& camera) {
  return "width = " + std::to_string(camera.width) + "\nheight = " + std::to_string(camera.height) +
         "\nfx = " + shortest(camera.fx) + "\nfy = " + shortest(camera.fy) + "\ncx = " + shortest(camera.cx) +
         "\ncy = " + shortest(camera.cy) + "\nk = " + list_of(camera.k, 5) + "\n";
}

}  // namespace

Calibration default_calibration(CameraKind kind) {
  Calibration c;
  c.has_color = true;
  c.color.fx = c.color.fy = 525.0;
  c.color.cx = 319.5;
  c.color.cy = 239.5;
  if (kind == CameraKind::kTum) {
    c.encoding = DepthEncoding::kScaled16;
    c.depth = c.color;
    c.depth_scale = 5000.0;
    c.color_registered = true;
  } else {
    c.T_color_depth.t = {-0.025, 0.0, 0.0};
  }
  return c;
}

Calibration parse_camera_toml(std::string_view text, const std::string& name, CameraKind kind) {
  toml::table root;
  try {
    root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw Failure(ExitCode::kBadInput, name + ":" + std::to_string(error.source().begin.line) + ": " +
                                           std::string(error.description()));
  }
  const Table table(root, name, "");
  table.allow_only({"width", "height", "fx", "fy", "cx", "cy", "k", "depth_scale", "raw_a", "raw_b", "color",
                    "correction"});
  // The keys' defaults are the contract's example: a Kinect. Only a missing file makes a TUM folder 525 and
  // 5000.
  Calibration calibration = default_calibration(CameraKind::kKinect);
  calibration.encoding = kind == CameraKind::kTum ? DepthEncoding::kScaled16 : DepthEncoding::kRaw11;
  table.read_intrinsics(calibration.depth);
  table.read_positive("depth_scale", calibration.depth_scale);
  table.read_positive("raw_a", calibration.raw_a);
  table.read_positive("raw_b", calibration.raw_b);
  if (const toml::node* correction = table.get("correction")) {
    if (!correction->is_table()) table.fail(*correction, "'correction' must be a table: [correction]");
    read_correction(Table(*correction->as_table(), name, "correction."), calibration.correction);
  }
  const toml::node* color = table.get("color");
  calibration.has_color = color != nullptr;
  if (color == nullptr) return calibration;
  if (!color->is_table()) table.fail(*color, "'color' must be a table: [color]");
  read_color(Table(*color->as_table(), name, "color."), calibration);
  return calibration;
}

Calibration read_camera_file(const std::string& path, CameraKind kind) {
  std::vector<std::uint8_t> bytes(kMaxFileBytes);
  const std::int64_t size = read_whole_file(path, bytes);
  if (size == -2) throw Failure(ExitCode::kBadInput, path + ": too large for a camera file");
  if (size < 0) throw Failure(ExitCode::kBadInput, path + ": cannot be read; give a camera.toml by --camera");
  return parse_camera_toml({reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(size)},
                           path, kind);
}

std::string format_camera_toml(const Calibration& calibration) {
  std::string text = format_intrinsics(calibration.depth);
  text += "depth_scale = " + shortest(calibration.depth_scale) + "\nraw_a = " + shortest(calibration.raw_a) +
          "\nraw_b = " + shortest(calibration.raw_b) + "\n";
  text += format_correction(calibration.correction);
  if (!calibration.has_color) return text;
  const Vec3& t = calibration.T_color_depth.t;
  const double translation[3] = {t.x, t.y, t.z};
  return text + "\n[color]\n" + format_intrinsics(calibration.color) +
         "registered = " + (calibration.color_registered ? "true" : "false") +
         "\nR = " + list_of(calibration.T_color_depth.R.m, 9) + "\nt = " + list_of(translation, 3) + "\n";
}

}  // namespace st
