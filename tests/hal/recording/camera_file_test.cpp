#include "hal/recording/camera_file.hpp"

#include <CppUTest/TestHarness.h>

#include "hal/error.hpp"

using namespace st;

TEST_GROUP(CameraFile){
    std::string error_of(const char* text){try {parse_camera_toml(text, "camera.toml", CameraKind::kKinect);
}
catch (const Failure& failure) {
  LONGS_EQUAL(static_cast<int>(ExitCode::kBadInput), static_cast<int>(failure.code()));
  CHECK(std::string(failure.what()).find('\n') == std::string::npos);
  return failure.what();
}
return {};
}
}
;

TEST(CameraFile, EveryKeyIsTaken) {
  const Calibration c = parse_camera_toml(
      "width = 320\nheight = 240\nfx = 275.5\nfy = 276\ncx = 160.5\ncy = 120.25\nk = [0.1, -0.2, 0.001, "
      "0.002, 0.3]\n"
      "depth_scale = 5000\nraw_a = 0.35\nraw_b = 1090.0\n[color]\nwidth = 640\nheight = 480\nfx = 525.0\nfy "
      "= 526.0\n"
      "cx = 319.0\ncy = 239.0\nk = [1, 2, 3, 4, 5]\nregistered = false\nR = [0, -1, 0, 1, 0, 0, 0, 0, 1]\n"
      "t = [0.1, 0.2, 0.3]\n",
      "camera.toml", CameraKind::kTum);
  LONGS_EQUAL(320, c.depth.width);
  LONGS_EQUAL(240, c.depth.height);
  DOUBLES_EQUAL(275.5, c.depth.fx, 0);
  DOUBLES_EQUAL(120.25, c.depth.cy, 0);
  DOUBLES_EQUAL(0.3, c.depth.k[4], 0);
  DOUBLES_EQUAL(5000.0, c.depth_scale, 0);
  DOUBLES_EQUAL(0.35, c.raw_a, 0);
  DOUBLES_EQUAL(1090.0, c.raw_b, 0);
  CHECK(c.encoding == DepthEncoding::kScaled16);
  CHECK(c.has_color && !c.color_registered);
  DOUBLES_EQUAL(526.0, c.color.fy, 0);
  DOUBLES_EQUAL(-1.0, c.T_color_depth.R(0, 1), 0);
  DOUBLES_EQUAL(0.3, c.T_color_depth.t.z, 0);
}

TEST(CameraFile, KeysThatAreLeftOutTakeTheDefaults) {
  const Calibration c = parse_camera_toml("fx = 580\n[color]\n", "camera.toml", CameraKind::kKinect);
  DOUBLES_EQUAL(580.0, c.depth.fx, 0);
  DOUBLES_EQUAL(575.8, c.depth.fy, 0);
  DOUBLES_EQUAL(345.4894, c.raw_a, 0);
  DOUBLES_EQUAL(525.0, c.color.fx, 0);
  DOUBLES_EQUAL(-0.025, c.T_color_depth.t.x, 0);
  CHECK(!parse_camera_toml("", "camera.toml", CameraKind::kKinect).has_color);
}

TEST(CameraFile, RegisteredColourHasTheDepthCamerasPixels) {
  const Calibration c = parse_camera_toml("width = 320\nheight = 240\nfx = 275\n[color]\nregistered = true\n",
                                          "camera.toml", CameraKind::kTum);
  LONGS_EQUAL(320, c.color.width);
  DOUBLES_EQUAL(275.0, c.color.fx, 0);
  DOUBLES_EQUAL(0.0, c.T_color_depth.t.x, 0);
  STRCMP_CONTAINS("camera.toml:2:",
                  error_of("[color]\nregistered = true\nwidth = 320\nheight = 240\n").c_str());
}

TEST(CameraFile, UnknownKeysAreRefusedWithTheirLine) {
  STRCMP_CONTAINS("camera.toml:2: unknown key 'fz'", error_of("fx = 500\nfz = 500\n").c_str());
  STRCMP_CONTAINS("camera.toml:3: unknown key 'color.scale'",
                  error_of("fx = 500\n[color]\nscale = 2\n").c_str());
  STRCMP_CONTAINS("camera.toml:1: unknown key 'colour'", error_of("[colour]\nfx = 500\n").c_str());
}

TEST(CameraFile, ValuesThatCannotBeAreRefusedWithTheirLine) {
  for (const char* text :
       {"\nwidth = 641", "\nwidth = 0", "\nheight = 481", "\nheight = 4.5", "\nfx = 0", "\nfy = -1.0",
        "\nfx = nan", "\ncx = inf", "\nfx = \"a\"", "\nk = [1, 2]", "\nk = 3", "\nraw_a = 0",
        "\ndepth_scale = -1", "\nfx = true", "\ncolor = 3", "\nfx = "})
    STRCMP_CONTAINS("camera.toml:2: ", error_of(text).c_str());
  for (const char* text :
       {"[color]\nR = [1, 0, 0, 0, 1, 0, 0, 0, 2]", "[color]\nR = [1, 0, 0, 0, 1, 0, 0, 0, -1]",
        "[color]\nt = [0, 0]", "[color]\nregistered = 1"})
    STRCMP_CONTAINS("camera.toml:2: ", error_of(text).c_str());
}

TEST(CameraFile, WhatIsWrittenReadsBackTheSame) {
  Calibration c = default_calibration(CameraKind::kKinect);
  c.depth.fx = 578.1234567890123;
  c.depth.k[2] = -1e-5;
  c.raw_b = 1090.1;
  c.T_color_depth.R = rotation_from_vector({0.01, -0.02, 0.003});
  c.T_color_depth.t = {-0.0248, 0.0001, -3e-4};
  const std::string text = format_camera_toml(c);
  const Calibration back = parse_camera_toml(text, "camera.toml", CameraKind::kKinect);
  DOUBLES_EQUAL(c.depth.fx, back.depth.fx, 0);
  DOUBLES_EQUAL(c.depth.k[2], back.depth.k[2], 0);
  DOUBLES_EQUAL(c.raw_b, back.raw_b, 0);
  for (int i = 0; i < 9; ++i) DOUBLES_EQUAL(c.T_color_depth.R.m[i], back.T_color_depth.R.m[i], 1e-15);
  DOUBLES_EQUAL(c.T_color_depth.t.z, back.T_color_depth.t.z, 0);
  c.has_color = false;
  CHECK(!parse_camera_toml(format_camera_toml(c), "camera.toml", CameraKind::kKinect).has_color);
}

TEST(CameraFile, ACorrectionReadsBackTheSame) {
  Calibration c = default_calibration(CameraKind::kKinect);
  c.correction.columns = 3;
  c.correction.rows = 2;
  for (int i = 0; i < 6; ++i) c.correction.steps[i] = 0.1f * static_cast<float>(i) - 0.2f;
  const Calibration back = parse_camera_toml(format_camera_toml(c), "camera.toml", CameraKind::kKinect);
  LONGS_EQUAL(3, back.correction.columns);
  LONGS_EQUAL(2, back.correction.rows);
  for (int i = 0; i < 6; ++i) DOUBLES_EQUAL(c.correction.steps[i], back.correction.steps[i], 0);
  CHECK(back.has_color);
}

TEST(CameraFile, ACorrectionThatIsNoGridIsRefusedWithItsLine) {
  STRCMP_CONTAINS("camera.toml:1: 'steps' is missing",
                  error_of("[correction]\ncolumns = 2\nrows = 2\n").c_str());
  STRCMP_CONTAINS(":4: 'correction.steps' must be a list of 4 numbers",
                  error_of("[correction]\ncolumns = 2\nrows = 2\nsteps = [1, 2, 3]\n").c_str());
  STRCMP_CONTAINS(":2: ", error_of("[correction]\ncolumns = 1\nrows = 2\nsteps = [1, 2]\n").c_str());
  STRCMP_CONTAINS(":3: ", error_of("[correction]\ncolumns = 2\nrows = 99\nsteps = [1, 2]\n").c_str());
  STRCMP_CONTAINS("64 steps",
                  error_of("[correction]\ncolumns = 2\nrows = 2\nsteps = [1, 2, 3, -65]\n").c_str());
  STRCMP_CONTAINS("unknown key", error_of("[correction]\ncolumn = 2\n").c_str());
  STRCMP_CONTAINS("must be a table", error_of("correction = 3\n").c_str());
}
