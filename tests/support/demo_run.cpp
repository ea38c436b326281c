#include "tests/support/demo_run.hpp"

#include <algorithm>
#include <cmath>

#include "firmware_like/finish_run.hpp"

namespace st {
namespace {

constexpr double kFirstStampS = 1400101000.030870;

Pose camera_pose() {
  // 1.1 m above the floor, looking down by 25 degrees; x of the floor frame along its axis.
  const double down = 25 * kPi / 180;
  const SinCos d = sin_cos(down);
  return {Mat3::from_columns({0, -1, 0}, {-d.sin, 0, -d.cos}, {d.cos, 0, -d.sin}), {-1.8, 0.1, 1.1}};
}

Pose lifted(const Pose2& p) { return {rotation_z(p.yaw), {p.x, p.y, 0}}; }

// A script's samples with their speeds.
std::vector<PathSample> preset(const MotionScript& script) {
  std::vector<PathSample> path;
  const auto& s = script.samples();
  for (std::size_t i = 0; i < s.size(); ++i) {
    const std::size_t a = i == 0 ? 0 : i - 1, b = i == 0 ? 1 : i;
    const double dt = s[b].t_s - s[a].t_s;
    const double v = std::hypot(s[b].pose.x - s[a].pose.x, s[b].pose.y - s[a].pose.y) / dt;
    path.push_back(
        {s[i].t_s, s[i].pose.x, s[i].pose.y, s[i].pose.yaw, v, (s[b].pose.yaw - s[a].pose.yaw) / dt});
  }
  return path;
}

void fill_timing(FrameReport& report, std::mt19937& random) {
  std::lognormal_distribution<float> spread(0.0f, 0.15f);
  static constexpr float kMedianUs[kStageCount] = {20, 310, 240, 15, 8, 420, 690, 25, 380, 12, 18, 10};
  for (int i = 0; i < kStageCount; ++i) {
    report.stage_us[i] = kMedianUs[i] * spread(random);
    report.cpu_us += report.stage_us[i];
  }
  if (report.index % 211 == 100) report.cpu_us += 2500, report.stage_us[6] += 2500;
  report.frame_us = report.cpu_us * 1.05f;
  report.age_us = 900;
}

ObjectSample sample_of(const Pose& T_floor_object, const BaseSampleTruth& now,
                       const BaseSampleTruth& before) {
  ObjectSample s;
  s.id = 1;
  s.state = TrackState::kGood;
  s.in_tum = true;
  s.T_floor_object = T_floor_object;
  s.T_camera_object = camera_pose().inverse() * T_floor_object;
  for (int i = 0, k = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j, ++k) s.covariance[k] = i == j ? (i < 3 ? 4e-6 : 6e-5) : 0.0;
  s.yaw_unwrapped = now.pose.yaw;
  const double dt = now.t_s - before.t_s;
  if (dt > 0) {
    s.velocity_mps = {(now.pose.x - before.pose.x) / dt, (now.pose.y - before.pose.y) / dt, 0};
    s.w_rps = (now.pose.yaw - before.pose.yaw) / dt;
    s.v_mps = norm(s.velocity_mps);
  }
  s.angular_velocity_rps = {0, 0, s.w_rps};
  s.sigma_position_m = {0.002, 0.002, 0.001};
  s.sigma_rpy_rad = {0.002, 0.002, 0.008};
  s.yaw_source = YawSource::kColor;
  s.inliers = 0.93f;
  s.residual_m = 0.0021f;
  return s;
}

}  // namespace

DemoRun circle_run(double radius_m, double wheel_error) {
  DemoRun run;
  constexpr double kSpeed = 0.2, kWheelBase = 0.258;
  const double w = kSpeed / radius_m;
  MotionScript told, did({0.31, -0.42, 1.2});
  told.drive(kSpeed, w, 2 * kPi / w);
  const double right = (kSpeed + 0.5 * kWheelBase * w) * (1 + wheel_error),
               left = kSpeed - 0.5 * kWheelBase * w;
  did.drive(0, 0, 1.5).drive(0.5 * (left + right), (right - left) / kWheelBase, 2 * kPi / w).drive(0, 0, 1.5);
  run.path = preset(told);
  run.driven = did.samples();
  return run;
}

DemoRun square_run(double side_m, double turn_share) {
  DemoRun run;
  constexpr double kSpeed = 0.2, kTurn = 0.8;
  MotionScript told, did({-0.2, -0.5, 0.2});
  did.drive(0, 0, 1.5);
  for (int i = 0; i < 4; ++i) {
    told.drive(kSpeed, 0, side_m / kSpeed).drive(0, kTurn, 0.5 * kPi / kTurn);
    did.drive(kSpeed, 0, side_m / kSpeed).drive(0, kTurn * turn_share, 0.5 * kPi / kTurn);
  }
  did.drive(0, 0, 1.5);
  run.path = preset(told);
  run.driven = did.samples();
  return run;
}

Mesh disc_mesh(const Pose2& base) {
  constexpr int kRings = 48, kSpokes = 144;
  constexpr double kRadius = 0.165, kHeight = 0.08;
  Mesh mesh;
  const Pose T = lifted(base);
  const auto add = [&](const Vec3& p, const Vec3& n, Vec3 colour) {
    mesh.vertices.push_back({to_float(T * p), to_float(T.R * n), static_cast<std::uint8_t>(colour.x),
                             static_cast<std::uint8_t>(colour.y), static_cast<std::uint8_t>(colour.z), 40});
  };
  const auto colour_at = [&](double x, double y) -> Vec3 {
    if (x > 0.13) return {52, 56, 60};                                // bumper
    if (std::hypot(x + 0.02, y) < 0.035) return {205, 60, 45};        // a button
    if (std::fabs(y) < 0.012 && x > 0.03) return {60, 125, 190};      // an arrow's shaft
    if (x > 0.085 && std::fabs(y) < 0.13 - x) return {60, 125, 190};  // its head
    return {222, 222, 216};
  };
  for (int r = 0; r <= kRings; ++r)
    for (int s = 0; s < kSpokes; ++s) {
      const SinCos a = sin_cos(2 * kPi * s / kSpokes);
      const double radius = kRadius * (r + 0.02) / (kRings + 0.02);
      add({radius * a.cos, radius * a.sin, kHeight}, {0, 0, 1}, colour_at(radius * a.cos, radius * a.sin));
    }
  constexpr int kSide = 10;
  for (int k = 0; k <= kSide; ++k)
    for (int s = 0; s < kSpokes; ++s) {
      const SinCos a = sin_cos(2 * kPi * s / kSpokes);
      add({kRadius * a.cos, kRadius * a.sin, kHeight - 0.07 * k / kSide}, {a.cos, a.sin, 0},
          a.cos > 0.4 ? Vec3{52, 56, 60} : Vec3{200, 200, 196});
    }
  const auto quads = [&](std::uint32_t first, int rows) {
    for (int r = 0; r < rows; ++r)
      for (int s = 0; s < kSpokes; ++s) {
        const auto at = [&](int row, int spoke) {
          return first + static_cast<std::uint32_t>(row * kSpokes + spoke % kSpokes);
        };
        const std::uint32_t a = at(r, s), b = at(r + 1, s), c = at(r + 1, s + 1), d = at(r, s + 1);
        mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
      }
  };
  quads(0, kRings);
  quads((kRings + 1) * kSpokes, kSide);
  return mesh;
}

void for_each_report(const DemoRun& run, const std::function<void(const FrameReport&)>& take) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const Pose2 T_base_object = inverse(run.base);
  for (std::size_t i = 0; i < run.driven.size(); ++i) {
    FrameReport report;
    report.index = i;
    report.t_s = kFirstStampS + run.driven[i].t_s;
    report.device_t_s = run.driven[i].t_s;
    fill_timing(report, random);
    const Pose2 object = compose(run.driven[i].pose, T_base_object);
    const Pose2 noisy{object.x + run.noise_m * normal(random), object.y + run.noise_m * normal(random),
                      object.yaw + run.noise_rad * normal(random)};
    constexpr std::size_t kConfirmed = 2;
    if (run.with_object && i >= kConfirmed) {
      ObjectSample s = sample_of(lifted(noisy), run.driven[i], run.driven[i - 1]);
      if (i == kConfirmed) report.events.push_back({report.t_s, EventKind::kConfirmed, 1, 0, 0, 0});
      const bool lost = i >= run.lost_from && i < run.lost_to;
      if (lost) s.state = i < run.lost_from + 2 ? TrackState::kPredicted : TrackState::kLost;
      s.in_tum = s.state != TrackState::kLost;
      if (lost && i == run.lost_from + 2)
        report.events.push_back({report.t_s, EventKind::kLost, 1, 0.1, 0, 0});
      if (i == run.lost_to && i > 0)
        report.events.push_back({report.t_s, EventKind::kRecovered, 1, 0.4, 0, 0});
      report.objects.push_back(s);
    }
    take(report);
  }
}

RunEnd end_of(const DemoRun& run, const Mesh& mesh) {
  RunEnd end;
  end.info = {"0.1.0", "sim:lab", "object", "star", "AVX2", run.path.empty() ? "" : "circle.toml", false};
  end.frames = run.driven.size();
  end.ending = run.ending;
  end.signal = run.ending == Ending::kInterrupted ? 2 : 0;
  end.last_t_s = kFirstStampS + run.driven.back().t_s;
  end.has_floor_frame = end.floor_found = run.with_object;
  end.T_floor_camera = camera_pose();
  end.planned_bytes = 61 << 20;
  end.peak_rss_bytes = 88 << 20;
  if (!run.with_object) return end;
  ObjectEnd object;
  object.id = 1;
  object.first_t_s = kFirstStampS + run.driven[2].t_s;
  object.last_t_s = end.last_t_s;
  const std::size_t gap = run.lost_to > run.lost_from + 2 ? run.lost_to - run.lost_from - 2 : 0;
  object.tracked = run.driven.size() - 2 - gap;
  object.lost = gap;
  object.good_at_end = true;
  object.mesh = mesh.view();
  end.objects.push_back(object);
  return end;
}

void write_demo_run(const DemoRun& run, const std::string& folder) {
  const Mesh mesh = disc_mesh(run.base);
  ResultWriter writer(folder);
  for_each_report(run, [&](const FrameReport& report) { writer.take(report); });
  writer.flush();
  finish_run(writer, end_of(run, mesh), run.path);
}

}  // namespace st
