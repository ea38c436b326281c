// object-N.tum, object-N.csv and object-N-covariance.csv: what is known of one object, frame by frame.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "algo/core/records.hpp"
#include "hal/results/line_file.hpp"

namespace st {

inline constexpr const char* kObjectColumns =
    "t,state,x,y,z,roll,pitch,yaw,yaw_unwrapped,vx,vy,vz,wx,wy,wz,ax,ay,az,v,w,alpha,sx,sy,sz,sroll,spitch,"
    "syaw,"
    "yaw_source,inliers,residual";
inline constexpr const char* kCovarianceColumns =
    "t,x_x,x_y,x_z,x_rx,x_ry,x_rz,y_y,y_z,y_rx,y_ry,y_rz,z_z,z_rx,z_ry,z_rz,rx_rx,rx_ry,rx_rz,ry_ry,ry_rz,rz_"
    "rz";

// A TUM row: `timestamp tx ty tz qx qy qz qw` with '\n', no trailing space, qw >= 0.
void append_tum_row(std::string& out, double t_s, const Pose& T);
// A row of object-N.csv. Fields that the state leaves without meaning are empty: everything that rests on a
// pose when it is poor or lost, and also inliers and residual when lost.
void append_object_row(std::string& out, double t_s, const ObjectSample& sample);
void append_covariance_row(std::string& out, double t_s, const double (&upper)[21]);

// The three files of one object, made at its confirmation.
class ObjectFiles {
 public:
  // kContinue: goes on with files that were closed earlier in the run.
  ObjectFiles(const std::string& folder, int id, LineFile::Open how);
  // A row in object-N.csv; and where the pose is published, one in each of the others. TUM stamps stay sorted
  // and unique: a row that would break that is left out of .tum and covariance.
  void take(double t_s, const ObjectSample& sample);
  bool flush();
  const std::string& error() const;
  int id() const { return id_; }

 private:
  int id_;
  LineFile tum_, csv_, covariance_;
  std::string last_stamp_;
  double last_tum_t_s_ = 0;
};

// A row of object-N.csv read back.
struct ObjectRow {
  double t_s = 0;
  TrackState state = TrackState::kLost;
  bool has_pose = false;
  bool has_yaw = false;  // yaw_source is not none
  double x_m = 0, y_m = 0, z_m = 0, roll_rad = 0, pitch_rad = 0, yaw_rad = 0, yaw_unwrapped_rad = 0;
  double v_mps = 0, w_rps = 0;
  double sigma_x_m = 0, sigma_y_m = 0, sigma_yaw_rad = 0;
};

// `name` stands in the messages. A last line without its end (a killed run) is left out. Throws Failure
// (kBadInput).
std::vector<ObjectRow> parse_object_csv(std::string_view text, const std::string& name);

}  // namespace st
