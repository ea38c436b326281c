#include "hal/sim/depth_sensor.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <vector>

#include "hal/sim/mesh_builder.hpp"

using namespace st;
using namespace st::sim;

namespace {

constexpr int kWidth = 640, kHeight = 480;

// A bright rectangle that faces the camera at depth z, in camera coordinates.
Mesh plate(float x0, float x1, float y0, float y1, float z, float ir = 0.6f) {
  MeshBuilder m;
  const std::uint32_t paint = m.material(Paint{0.6f, 0.6f, 0.6f, ir});
  m.quad({x0, y1, z}, {x1, y1, z}, {x1, y0, z}, {x0, y0, z}, paint);
  return m.take();
}

DepthSensorOptions quiet() {
  DepthSensorOptions o;
  o.frozen_noise = o.flicker_noise = o.bias = 0;
  return o;
}

struct Picture {
  std::vector<std::uint16_t> raw = std::vector<std::uint16_t>(kWidth * kHeight);
  ImageView<std::uint16_t> view() { return {raw.data(), kWidth, kHeight}; }
  int at(int u, int v) const { return raw[static_cast<std::size_t>(v * kWidth + u)]; }
};

Picture one_frame(DepthSensor& sensor, std::uint64_t seed = 1) {
  Picture p;
  sensor.begin_frame();
  sensor.match();
  sensor.sample(seed, p.view());
  return p;
}

int readings(const Picture& p, int u0, int u1, int v0, int v1) {
  int n = 0;
  for (int v = v0; v < v1; ++v)
    for (int u = u0; u < u1; ++u) n += p.at(u, v) != DepthSensor::kNoReading ? 1 : 0;
  return n;
}

}  // namespace

TEST_GROUP(DepthSensor) {
  DepthSensorOptions options = quiet();
  double raw_of(double z_m) const { return options.raw_b - options.raw_a / z_m; }
};

TEST(DepthSensor, AWallReadsItsDisparityToTheStep) {
  for (const float z : {0.8f, 1.5f, 2.3f, 4.0f}) {
    DepthSensor sensor(options);
    sensor.draw_still(plate(-9, 9, -9, 9, z), Pose{});
    sensor.seal_still();
    const Picture p = one_frame(sensor);
    const int wanted = static_cast<int>(std::lround(raw_of(z)));
    int right = 0, seen = 0;
    for (int v = 10; v < kHeight - 10; ++v)
      for (int u = 10; u < kWidth - 20; ++u)
        if (p.at(u, v) != DepthSensor::kNoReading) {
          ++seen;
          right += p.at(u, v) == wanted ? 1 : 0;
        }
    CHECK(seen > 0.98 * (kHeight - 20) * (kWidth - 30));
    CHECK(right > 0.98 * seen);
  }
}

TEST(DepthSensor, ASlopingFloorReadsItsDisparityInEveryRow) {
  // Camera 1.2 m above the floor, looking 35 degrees down: inverse depth is linear in the row.
  const double pitch = 0.61, height = 1.2;
  const Vec3 up{0, -std::cos(pitch), -std::sin(pitch)};
  MeshBuilder m;
  const std::uint32_t paint = m.material(Paint{0.6f, 0.6f, 0.6f, 0.6f});
  m.grid({-4, -1, 0}, {8, 0, 0}, {0, 7, 0}, 0.5f, paint);
  const Pose T_camera_room{Mat3::from_columns({1, 0, 0}, cross(up, {1, 0, 0}), up), up * -height};
  DepthSensor sensor(options);
  sensor.draw_still(m.take(), T_camera_room);
  sensor.seal_still();
  const Picture p = one_frame(sensor);
  for (int v = 100; v < 470; v += 7) {
    const Vec3 ray{0, (v - 240.0) / options.camera.fy, 1};
    const double z = -height / dot(up, ray);
    int n = 0;
    double sum = 0;
    for (int u = 100; u < 500; ++u)
      if (p.at(u, v) != DepthSensor::kNoReading) {
        sum += p.at(u, v);
        ++n;
      }
    CHECK(n > 380);
    DOUBLES_EQUAL(raw_of(z), sum / n, 0.55);
  }
}

TEST(DepthSensor, TheShadowLiesToTheLeftAndIsAsWideAsTheDisparityBetween) {
  const float near = 1.0f, far = 2.0f;
  DepthSensor sensor(options);
  sensor.draw_still(plate(-9, 9, -9, 9, far), Pose{});
  sensor.draw_still(plate(-0.2f, 0.2f, -9, 9, near), Pose{});
  sensor.seal_still();
  const Picture p = one_frame(sensor);
  const int left_edge = static_cast<int>(320 - 575.8 * 0.2), right_edge = static_cast<int>(320 + 575.8 * 0.2);
  const double expected = options.camera.fx * options.baseline_m * (1 / near - 1 / far);  // 21.6 px
  const int rows = 400;
  const double dark_left = rows * 60.0 - readings(p, left_edge - 50, left_edge + 10, 40, 40 + rows);
  const double dark_right = rows * 60.0 - readings(p, right_edge - 10, right_edge + 50, 40, 40 + rows);
  DOUBLES_EQUAL(expected, dark_left / rows, 2.0);
  CHECK(dark_right / rows < 1.5);
}

TEST(DepthSensor, EdgesAreRaggedOverTheMatchingWindow) {
  DepthSensor sensor(options);
  sensor.draw_still(plate(-9, 9, -9, 9, 2.0f), Pose{});
  sensor.draw_still(plate(-0.2f, 0.2f, -9, 9, 1.0f), Pose{});
  sensor.seal_still();
  const Picture p = one_frame(sensor);
  const int near_raw = static_cast<int>(raw_of(1.0)), right_edge = static_cast<int>(320 + 575.8 * 0.2);
  double sum = 0, sum2 = 0;
  const int rows = 440;
  for (int v = 20; v < 20 + rows; ++v) {
    int edge = right_edge - 12;  // holes farther inside are none of the edge
    while (std::abs(p.at(edge, v) - near_raw) < 20 && edge < 500) ++edge;
    sum += edge;
    sum2 += edge * edge;
  }
  const double mean = sum / rows, spread = std::sqrt(sum2 / rows - mean * mean);
  DOUBLES_EQUAL(320 + 575.8 * 0.2, mean, 2.0);
  CHECK(spread > 0.5);
  CHECK(spread < 3.0);
}

TEST(DepthSensor, NoiseHasTheStatedSpreadAndIsAlikeWithinAWindow) {
  options.frozen_noise = 0.45;
  options.flicker_noise = 0.15;
  DepthSensor sensor(options);
  sensor.draw_still(plate(-9, 9, -9, 9, 1.5f), Pose{});
  sensor.seal_still();
  const Picture p = one_frame(sensor), q = one_frame(sensor, 2);
  const double middle = raw_of(1.5);
  double square = 0, near = 0, far = 0, changed = 0;
  int n = 0;
  for (int v = 20; v < 440; ++v)
    for (int u = 20; u < 600; ++u) {
      if (p.at(u, v) == 2047 || q.at(u, v) == 2047 || p.at(u + 2, v) == 2047 || p.at(u + 14, v) == 2047)
        continue;
      const double a = p.at(u, v) - middle, b = p.at(u + 2, v) - middle, c = p.at(u + 14, v) - middle;
      square += a * a;
      near += a * b;
      far += a * c;
      changed += (p.at(u, v) - q.at(u, v)) * (p.at(u, v) - q.at(u, v));
      ++n;
    }
  const double variance = square / n;
  // Frozen 0.45 (a little more on dimmer surfaces), flicker 0.15-0.25, rounding to steps 0.29.
  CHECK(std::sqrt(variance) > 0.45);
  CHECK(std::sqrt(variance) < 0.75);
  CHECK(near / square > 0.35);
  CHECK(std::fabs(far / square) < 0.12);
  CHECK(changed / n / 2 > 0.02);
  CHECK(changed / n / 2 < 0.25);
}

TEST(DepthSensor, NearestFarthestDarkAndGrazingSurfacesAreLost) {
  const auto share = [&](float z, float ir) {
    DepthSensor sensor(options);
    sensor.draw_still(plate(-20, 20, -20, 20, z, ir), Pose{});
    sensor.seal_still();
    return readings(one_frame(sensor), 0, kWidth - DepthSensor::kDeadColumns, 0, kHeight) / (632.0 * 480.0);
  };
  CHECK(share(0.40f, 0.6f) < 0.01);
  CHECK(share(0.50f, 0.6f) > 0.95);
  CHECK(share(6.0f, 0.6f) > 0.95);
  CHECK(share(12.0f, 0.6f) < 0.05);
  CHECK(share(2.5f, 0.011f) < 0.05);  // a glossy dark bumper
  // A wall seen at three degrees.
  MeshBuilder m;
  const std::uint32_t paint = m.material(Paint{0.6f, 0.6f, 0.6f, 0.6f});
  m.quad({0.05f, -1, 8}, {0.05f, -1, 0.6f}, {0.05f, 1, 0.6f}, {0.05f, 1, 8}, paint);
  DepthSensor sensor(options);
  sensor.draw_still(m.take(), Pose{});
  sensor.seal_still();
  CHECK(readings(one_frame(sensor), 0, kWidth, 0, kHeight) < 2000);
}

TEST(DepthSensor, TheRightBorderIsDead) {
  DepthSensor sensor(options);
  sensor.draw_still(plate(-9, 9, -9, 9, 1.5f), Pose{});
  sensor.seal_still();
  const Picture p = one_frame(sensor);
  LONGS_EQUAL(0, readings(p, kWidth - DepthSensor::kDeadColumns, kWidth, 0, kHeight));
  CHECK(readings(p, 0, 8, 0, kHeight) > 0.95 * 8 * kHeight);
}

TEST(DepthSensor, WhatMovesGivesTheSameFrameAsIfItHadAlwaysStoodThere) {
  options.frozen_noise = 0.45;
  const Mesh wall = plate(-9, 9, -9, 9, 2.0f), thing = plate(-0.15f, 0.15f, -0.1f, 0.1f, 0.0f);
  const Pose there{Mat3{}, {0.2, 0.1, 1.2}};
  DepthSensor moving(options), still(options);
  moving.draw_still(wall, Pose{});
  moving.seal_still();
  still.draw_still(wall, Pose{});
  still.draw_still(thing, there);
  still.seal_still();
  // It was elsewhere the frame before.
  moving.begin_frame();
  moving.draw_moving(thing, {Mat3{}, {-0.3, 0, 0.9}}, 1);
  moving.match();
  moving.begin_frame();
  moving.draw_moving(thing, there, 1);
  moving.match();
  Picture a;
  moving.sample(5, a.view());
  const Picture b = one_frame(still, 5);
  CHECK(a.raw == b.raw);
  CHECK(moving.unoccluded_pixels(1) > 10000);
}

TEST(DepthSensor, TheSameSeedGivesTheSameBytesAndAnotherDoesNot) {
  options.frozen_noise = 0.45;
  options.flicker_noise = 0.15;
  const auto frame = [&](std::uint64_t seed) {
    options.seed = seed;
    DepthSensor sensor(options);
    sensor.draw_still(plate(-9, 9, -9, 9, 2.0f), Pose{});
    sensor.seal_still();
    return one_frame(sensor, 3).raw;
  };
  CHECK(frame(1) == frame(1));
  CHECK(frame(1) != frame(2));
}
