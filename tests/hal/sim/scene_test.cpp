#include "hal/sim/scene.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "algo/core/scalar_math.hpp"
#include "hal/error.hpp"
#include "hal/sim/camera_rig.hpp"
#include "hal/sim/sim_recording.hpp"

using namespace st;
using namespace st::sim;

namespace {

struct Frame {
  std::vector<std::uint16_t> raw = std::vector<std::uint16_t>(640 * 480);
  std::vector<std::uint8_t> rgb = std::vector<std::uint8_t>(640 * 480 * 3);
  ImageView<std::uint16_t> depth() { return {raw.data(), 640, 480}; }
};

Scene scene_named(const char* name, std::uint64_t seed = 1, RobotModel robot = RobotModel::kCreate2) {
  SceneOptions o;
  o.name = name;
  o.seed = seed;
  o.robot = robot;
  return make_scene(o);
}

// Mean pixel of what shows object `id`.
struct Centre {
  double u = 0, v = 0;
  int n = 0;
};
Centre centre_of(const DepthSensor& sensor, int id) {
  Centre c;
  const ImageView<const std::uint8_t> ids = sensor.ids();
  for (int v = 0; v < ids.height; ++v)
    for (int u = 0; u < ids.width; ++u)
      if (ids(u, v) == id) {
        c.u += u;
        c.v += v;
        ++c.n;
      }
  if (c.n > 0) {
    c.u /= c.n;
    c.v /= c.n;
  }
  return c;
}

}  // namespace

TEST_GROUP(Scene){};

TEST(Scene, EveryOneRendersAndShowsItsRobotWhereTheTruthSays) {
  for (const char* name : scene_names()) {
    CameraRig rig(scene_named(name));
    const Scene& s = rig.scene();
    Frame f;
    int shown = 0;
    for (double t = 0.5; t < s.duration_s; t += s.duration_s / 6) {
      rig.depth_frame(t, 1, f.depth());
      rig.color_frame(t, 1, f.rgb.data());
      int valid = 0;
      for (const std::uint16_t r : f.raw) valid += r != DepthSensor::kNoReading ? 1 : 0;
      // A camera in a hand may look away for a while, after its first seconds.
      if (!s.camera_motion || t < 3) CHECK_TEXT(valid > 0.4 * 640 * 480, name);
      for (std::size_t i = 0; i < s.objects.size(); ++i) {
        Pose T_room_object;
        const Visibility seen = rig.visibility(f.depth())[i];
        if (!s.objects[i].motion(t, T_room_object)) {
          LONGS_EQUAL_TEXT(0, seen.pixels, name);
          continue;
        }
        CHECK_TEXT(seen.pixels <= seen.whole_pixels && seen.valid <= seen.pixels, name);
        if (seen.pixels < 0.95 * seen.whole_pixels || seen.pixels < 2000) continue;
        ++shown;
        const Vec3 p = s.T_camera_room * (T_room_object * Vec3{0, 0, 0.05});
        const Intrinsics& k = s.calibration.depth;
        const double u = k.fx * p.x / p.z + k.cx, v = k.fy * p.y / p.z + k.cy;
        const Centre c = centre_of(rig.depth(), static_cast<int>(i) + 1);
        if (u < 60 || u > 580 || v < 60 || v > 420) continue;  // cut by the border
        DOUBLES_EQUAL_TEXT(u, c.u, 14, name);
        DOUBLES_EQUAL_TEXT(v, c.v, 14, name);
      }
    }
    if (!s.objects.empty()) CHECK_TEXT(shown > 0, name);
  }
}

TEST(Scene, DepthOfTheRobotAgreesWithItsTruePose) {
  CameraRig rig(scene_named("circle", 4, RobotModel::kCreate1));
  const Scene& s = rig.scene();
  Frame f;
  rig.depth_frame(5.0, 7, f.depth());
  Pose T_room_robot;
  CHECK(s.objects[0].motion(5.0, T_room_robot));
  const Pose T_robot_camera = (s.T_camera_room * T_room_robot).inverse();
  const Intrinsics& k = s.calibration.depth;
  double worst_mean = 0;
  int top = 0, all = 0;
  for (int v = 0; v < 480; ++v)
    for (int u = 0; u < 640; ++u) {
      if (rig.depth().ids()(u, v) != 1 || f.depth()(u, v) == 2047) continue;
      const double z = s.calibration.raw_a / (s.calibration.raw_b - f.depth()(u, v));
      const Vec3 p = T_robot_camera * Vec3{(u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z};
      ++all;
      if (std::sqrt(p.x * p.x + p.y * p.y) > 0.14 || p.x < 0.09)
        continue;  // the lid before the panel, 76 mm high
      worst_mean += p.z - 0.076;
      ++top;
    }
  CHECK(all > 3000);
  CHECK(top > 200);
  DOUBLES_EQUAL(0, worst_mean / top, 0.006);
}

TEST(Scene, ColourShowsTheRobotAtItsOwnPlaceAndTime) {
  // The difference between a colour frame with the robot and one without must lie where the colour camera
  // sees it.
  Scene with = scene_named("circle", 2), without = scene_named("circle", 2);
  without.parts.clear();
  const double t = 6.0;
  Pose T_room_robot;
  CHECK(with.objects[0].motion(t, T_room_robot));
  const Pose T_color_robot = with.calibration.T_color_depth * with.T_camera_room * T_room_robot;
  const Intrinsics k = with.calibration.color;
  CameraRig a(std::move(with)), b(std::move(without));
  Frame fa, fb;
  a.color_frame(t, 1, fa.rgb.data());
  b.color_frame(t, 1, fb.rgb.data());
  double u = 0, v = 0, n = 0;
  for (int y = 0; y < 480; ++y)
    for (int x = 0; x < 640; ++x) {
      int difference = 0;
      for (int c = 0; c < 3; ++c) {
        const auto at = static_cast<std::size_t>(3 * (y * 640 + x) + c);
        difference += std::abs(int{fa.rgb[at]} - int{fb.rgb[at]});
      }
      if (difference < 60) continue;
      u += x;
      v += y;
      ++n;
    }
  CHECK(n > 1000);
  const Vec3 p = T_color_robot * Vec3{0, 0, 0.05};
  DOUBLES_EQUAL(k.fx * p.x / p.z + k.cx, u / n, 14);
  DOUBLES_EQUAL(k.fy * p.y / p.z + k.cy, v / n, 14);
}

TEST(Scene, TheSameSeedGivesTheSameFramesAndAnotherSeedAnotherRoom) {
  CameraRig a(scene_named("walking-legs", 3)), b(scene_named("walking-legs", 3)),
      c(scene_named("walking-legs", 4));
  Frame fa, fb, fc;
  // Drawn in another order before: what was in the picture must not matter.
  b.depth_frame(11.5, 1, fb.depth());
  b.color_frame(11.5, 1, fb.rgb.data());
  for (auto [rig, f] : {std::pair{&a, &fa}, std::pair{&b, &fb}, std::pair{&c, &fc}}) {
    rig->depth_frame(5.2, 9, f->depth());
    rig->color_frame(5.2, 9, f->rgb.data());
  }
  CHECK(fa.raw == fb.raw);
  CHECK(fa.rgb == fb.rgb);
  CHECK(fa.raw != fc.raw);
  CHECK(std::fabs(a.scene().calibration.depth.fx - c.scene().calibration.depth.fx) > 0.05);
  CHECK(std::fabs(a.scene().T_camera_room.t.z - c.scene().T_camera_room.t.z) > 0.005);
}

TEST(Scene, ARobotHiddenByABoxIsCountedAsHidden) {
  CameraRig rig(scene_named("occluded", 2));
  Frame f;
  double least = 1;
  for (double t = 1; t < 11; t += 0.4) {
    rig.depth_frame(t, 1, f.depth());
    const Visibility seen = rig.visibility(f.depth())[0];
    least = std::fmin(least, static_cast<double>(seen.pixels) / std::fmax(1, seen.whole_pixels));
  }
  CHECK(least < 0.3);
}

TEST(Scene, TheLabKeepsACircleInViewAtTheRightDistance) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Scene s = scene_named("lab", seed);
    const Intrinsics& k = s.calibration.depth;
    for (int i = 0; i < 24; ++i) {
      const SinCos sc = sin_cos(i * kPi / 12);
      const Vec3 p = s.T_camera_room * Vec3{0.5 * sc.sin, 0.5 - 0.5 * sc.cos, 0.04};
      const double u = k.fx * p.x / p.z + k.cx, v = k.fy * p.y / p.z + k.cy;
      CHECK(u > 60 && u < 580 && v > 30 && v < 450);
      CHECK(norm(p) > 1.2);
      CHECK(norm(p) < 2.65);
    }
  }
}

TEST(Scene, GravityPointsUp) {
  const Scene s = scene_named("lab", 5);
  const Vec3 up = s.T_camera_room.R.col(2), g = gravity_reading(s, 0);
  DOUBLES_EQUAL(9.80665, norm(g), 0.3);
  CHECK(dot(up, g) / norm(g) > 0.9995);
  CHECK(g.y < -6);  // the camera's y points down
}

TEST(Scene, AnUnknownNameIsRefusedWithTheList) {
  try {
    scene_named("livingroom");
    FAIL("accepted");
  } catch (const Failure& failure) {
    LONGS_EQUAL(2, static_cast<int>(failure.code()));
    CHECK(std::strstr(failure.what(), "walking-legs") != nullptr);
  }
}
