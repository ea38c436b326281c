#include "algo/segmentation/floor.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <vector>

#include "tests/support/bound.hpp"
#include "tests/support/test_scene.hpp"

using namespace st;

namespace {

// One rendered frame as a background: eighths of a code.
struct Fixture {
  Calibration camera;
  DepthTables tables;
  FloorFinder finder;
  test::BoundMemory memory;
  std::vector<std::uint16_t> code8;

  Fixture(const test::TestScene& scene, int width, int height)
      : camera(test::kinect_calibration(width, height)), memory([&](Bump& b) {
          tables.bind(b, camera);
          finder.bind(b);
        }) {
    tables.configure(camera);
    test::SceneCamera renderer(camera);
    const auto& frame = renderer.render(scene);
    for (std::uint16_t raw : frame.raw)
      code8.push_back(static_cast<std::uint16_t>(tables.code_of_stored()[raw] * 8));
  }
  Floor find(bool has_up = false, const Vec3& up = {}) {
    return finder.find(tables, {code8.data(), camera.depth.width, camera.depth.height}, has_up, up);
  }
};

}  // namespace

TEST_GROUP(Floor){};

TEST(Floor, IsExactDespiteTheSensorsSteps) {
  for (int width : {640, 160}) {
    Fixture f({.boxes = {{.y = 2.2, .width = 0.5, .height = 0.4}, {.x = 0.5, .y = 1.7}}}, width,
              width * 3 / 4);
    const Floor floor = f.find();
    CHECK(floor.found);
    const Vec3 up{0, -std::cos(0.55), -std::sin(0.55)};
    CHECK(dot(floor.n, up) > std::cos(0.1 * 3.14159265 / 180));
    DOUBLES_EQUAL(1.2, floor.d, 0.002);
    DOUBLES_EQUAL(8 * std::sqrt(0.25 + 1.0 / 12), floor.sigma_code,
                  1.0);  // noise of half a step, and the step
  }
}

TEST(Floor, HeightsAreMetres) {
  Fixture f({.boxes = {{.y = 2.0, .height = 0.3}}}, 320, 240);
  const Floor floor = f.find();
  CHECK(floor.found);
  const double q = 8 * 345.4894 / 2.0, ray_down = (200 - 120.0) / (575.8 / 2);
  const double height = dot(floor.n, Vec3{0, ray_down, 1} * 2.0) + floor.d;
  DOUBLES_EQUAL(height, static_cast<double>(floor.height_m(static_cast<float>(q), floor.codes.at(160, 200))),
                0.002);
}

TEST(Floor, AWallIsNone) {
  Fixture f({.pitch_rad = 0.05, .floor = false, .wall_y = 1.1}, 640, 480);
  CHECK_FALSE(f.find().found);
  CHECK_FALSE(f.find(true, {0, -9.81, 0.3}).found);
}

TEST(Floor, AWallThatFillsMostOfTheViewDoesNotHideIt) {
  Fixture f({.camera_height = 0.5, .pitch_rad = 0.2, .wall_y = 2.0}, 640, 480);
  const Floor floor = f.find();
  CHECK(floor.found);
  DOUBLES_EQUAL(0.5, floor.d, 0.005);
}

TEST(Floor, GravityDecides) {
  Fixture f({.pitch_rad = 1.45}, 320,
            240);  // looking almost straight down: without gravity this could be a wall
  CHECK_FALSE(f.find().found);
  CHECK(f.find(true, {0, -9.81 * std::cos(1.45), -9.81 * std::sin(1.45)}).found);
  CHECK_FALSE(f.find(true, {0, -9.81, 0}).found);
}

TEST(Floor, NothingKnownIsNone) {
  Fixture f({}, 160, 120);
  for (auto& q : f.code8) q = 0;
  CHECK_FALSE(f.find().found);
}
