#include "hal/results/object_files.hpp"

#include <cmath>
#include <iterator>

#include "hal/error.hpp"
#include "hal/results/csv_table.hpp"
#include "hal/results/text_format.hpp"

namespace st {
namespace {

std::string object_path(const std::string& folder, int id, const char* suffix) {
  return folder + "/object-" + std::to_string(id) + suffix;
}

bool finite(const Pose& T) {
  double sum = 0;
  for (const double value : T.R.m) sum += value;
  return std::isfinite(sum + T.t.x + T.t.y + T.t.z);
}

void append_fields(std::string& out, std::initializer_list<double> values, int decimals) {
  for (const double value : values) {
    out += ',';
    append_fixed(out, value, decimals);
  }
}

void append_vector(std::string& out, const Vec3& v, int decimals) {
  append_fields(out, {v.x, v.y, v.z}, decimals);
}

bool pose_published(TrackState state) {
  return state == TrackState::kGood || state == TrackState::kPredicted;
}

// Everything from x to syaw.
void append_motion(std::string& out, const ObjectSample& s) {
  const Vec3 rpy = to_roll_pitch_yaw(s.T_floor_object.R);
  append_vector(out, s.T_floor_object.t, kMetreDecimals);
  append_fields(out, {rpy.x, rpy.y}, kRadianDecimals);
  out += ',';
  append_yaw(out, rpy.z);
  append_fields(out, {s.yaw_unwrapped}, kRadianDecimals);
  append_vector(out, s.velocity_mps, kMetreDecimals);
  append_vector(out, s.angular_velocity_rps, kRadianDecimals);
  append_vector(out, s.acceleration_mps2, kMetreDecimals);
  append_fields(out, {s.v_mps, s.w_rps, s.alpha_rps2}, kMetreDecimals);
  append_vector(out, s.sigma_position_m, kMetreDecimals);
  append_vector(out, s.sigma_rpy_rad, kRadianDecimals);
}

constexpr int kMotionFields = 25;

TrackState parse_state(std::string_view word, const std::string& name) {
  for (const TrackState state :
       {TrackState::kGood, TrackState::kPoor, TrackState::kPredicted, TrackState::kLost})
    if (word == name_of(state)) return state;
  throw Failure(ExitCode::kBadInput, name + ": '" + std::string(word.substr(0, 20)) + "' is not a state");
}

}  // namespace

void append_tum_row(std::string& out, double t_s, const Pose& T) {
  const Quaternion q = to_quaternion(T.R);
  append_fixed(out, t_s, kStampDecimals);
  for (const double metres : {T.t.x, T.t.y, T.t.z}) {
    out += ' ';
    append_fixed(out, metres, kMetreDecimals);
  }
  for (const double part : {q.x, q.y, q.z, q.w}) {
    out += ' ';
    append_fixed(out, part, kQuaternionDecimals);
  }
  out += '\n';
}

void append_object_row(std::string& out, double t_s, const ObjectSample& sample) {
  append_fixed(out, t_s, kStampDecimals);
  out += ',';
  out += name_of(sample.state);
  if (pose_published(sample.state) && finite(sample.T_floor_object))
    append_motion(out, sample);
  else
    out.append(kMotionFields, ',');
  out += ',';
  out += name_of(sample.yaw_source);
  if (sample.state == TrackState::kLost) {
    out += ",,";
  } else {
    append_fields(out, {static_cast<double>(sample.inliers)}, kRatioDecimals);
    append_fields(out, {static_cast<double>(sample.residual_m)}, kMetreDecimals);
  }
  out += '\n';
}

void append_covariance_row(std::string& out, double t_s, const double (&upper)[21]) {
  constexpr int kDigits = 6;
  append_fixed(out, t_s, kStampDecimals);
  for (const double value : upper) {
    out += ',';
    append_scientific(out, value, kDigits);
  }
  out += '\n';
}

ObjectFiles::ObjectFiles(const std::string& folder, int id, LineFile::Open how)
    : id_(id),
      tum_(object_path(folder, id, ".tum"), how),
      csv_(object_path(folder, id, ".csv"), how),
      covariance_(object_path(folder, id, "-covariance.csv"), how) {
  if (how == LineFile::Open::kContinue) return;
  csv_.line() += std::string(kObjectColumns) + '\n';
  covariance_.line() += std::string(kCovarianceColumns) + '\n';
}

void ObjectFiles::take(double t_s, const ObjectSample& sample) {
  append_object_row(csv_.line(), t_s, sample);
  if (!sample.in_tum || !finite(sample.T_camera_object)) return;
  std::string stamp;
  append_fixed(stamp, t_s, kStampDecimals);
  // Compared as printed: two stamps that differ by less than a printed digit would otherwise repeat in the
  // file.
  if (!last_stamp_.empty() && (stamp == last_stamp_ || t_s < last_tum_t_s_)) return;
  last_stamp_ = stamp;
  last_tum_t_s_ = t_s;
  append_tum_row(tum_.line(), t_s, sample.T_camera_object);
  append_covariance_row(covariance_.line(), t_s, sample.covariance);
}

bool ObjectFiles::flush() {
  const bool tum = tum_.flush(), csv = csv_.flush(), covariance = covariance_.flush();
  return tum && csv && covariance;
}

const std::string& ObjectFiles::error() const {
  if (!tum_.error().empty()) return tum_.error();
  return csv_.error().empty() ? covariance_.error() : csv_.error();
}

std::vector<ObjectRow> parse_object_csv(std::string_view text, const std::string& name) {
  const CsvTable table = parse_csv(text, name);
  const std::size_t t = table.column("t"), state = table.column("state"), source = table.column("yaw_source");
  struct Field {
    std::size_t column;
    double ObjectRow::*into;
  };
  const Field fields[] = {{table.column("x"), &ObjectRow::x_m},
                          {table.column("y"), &ObjectRow::y_m},
                          {table.column("z"), &ObjectRow::z_m},
                          {table.column("roll"), &ObjectRow::roll_rad},
                          {table.column("pitch"), &ObjectRow::pitch_rad},
                          {table.column("yaw"), &ObjectRow::yaw_rad},
                          {table.column("yaw_unwrapped"), &ObjectRow::yaw_unwrapped_rad},
                          {table.column("v"), &ObjectRow::v_mps},
                          {table.column("w"), &ObjectRow::w_rps},
                          {table.column("sx"), &ObjectRow::sigma_x_m},
                          {table.column("sy"), &ObjectRow::sigma_y_m},
                          {table.column("syaw"), &ObjectRow::sigma_yaw_rad}};
  std::vector<ObjectRow> rows(table.rows());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].t_s = table.number(i, t);
    rows[i].state = parse_state(table.text(i, state), name);
    rows[i].has_pose = !table.text(i, fields[0].column).empty();
    rows[i].has_yaw = rows[i].has_pose && table.text(i, source) != name_of(YawSource::kNone);
    for (const Field& field : fields) rows[i].*field.into = table.number(i, field.column);
  }
  return rows;
}

}  // namespace st
