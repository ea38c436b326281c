#include "hal/error.hpp"
#include "hal/recording/camera_file.hpp"
#include "tests/support/fake_recording.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temp_folder.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;

TEST_GROUP(CalibrateDepth) {
  TempFolder folder;
  std::string floor(const std::string& name, const std::string& bow) const {
    const std::string recording = folder / name;
    LONGS_EQUAL(0, startrack({"simulate", "empty", "--seed", "2", "--seconds", "0.5", "--bow", bow, "--out",
                              recording})
                       .code);
    return recording;
  }
};

TEST(CalibrateDepth, ABowedSensorGetsACameraFileThatTakesTheBowOff) {
  const std::string recording = floor("bowed", "6"), file = folder / "camera.toml";
  const Said said = startrack({"calibrate", "depth", recording, "--out", file});
  LONGS_EQUAL(0, said.code);
  STRCMP_CONTAINS("below the camera", said.out.c_str());
  STRCMP_CONTAINS("known in", said.out.c_str());
  const Calibration camera = read_camera_file(file, CameraKind::kKinect);
  CHECK(!camera.correction.empty());
  CHECK(camera.has_color);
  // The loop takes it.
  LONGS_EQUAL(0, startrack({"replay", recording, "--camera", file, "--out", folder / "run"}).code);
}

TEST(CalibrateDepth, ASensorWithoutBowAndAWrongCommandLineAreSaid) {
  const std::string recording = floor("plain", "0.2");
  const Said uneven = startrack({"calibrate", "depth", recording, "--height-m", "1.2", "1.3"});
  LONGS_EQUAL(2, uneven.code);
  STRCMP_CONTAINS("none: what is left is the noise",
                  startrack({"calibrate", "depth", recording, "--out", folder / "none.toml"}).out.c_str());
  STRCMP_CONTAINS("for every recording", uneven.err.c_str());
  const Said nothing = startrack({"calibrate", "depth", folder / "missing"});
  LONGS_EQUAL(2, nothing.code);
  const Said nowhere = startrack({"calibrate", "depth", recording, "--out", "/nowhere/camera.toml"});
  LONGS_EQUAL(2, nowhere.code);
  STRCMP_CONTAINS("/nowhere/camera.toml: cannot write", nowhere.err.c_str());
}

TEST(CalibrateDepth, WhatStandsThereIsNotOverwritten) {
  const std::string file = folder.file("mine.db", "precious");
  const Said said = startrack({"calibrate", "depth", folder / "any", "--out", file});
  LONGS_EQUAL(2, said.code);
  STRCMP_CONTAINS("--force", said.err.c_str());
  STRCMP_EQUAL("precious", content(file).c_str());
}

TEST(CalibrateDepth, MetresInsteadOfRawReadingsAreRefused) {
  TempFolder tum;
  tum.file("camera.toml", "width = 8\nheight = 4\nfx = 6\nfy = 6\ncx = 4\ncy = 2\n");
  tum.file("1.png", png_gray16(1500));
  tum.file("2.png", png_gray16(1500));
  tum.file("depth.txt", "1.0 1.png\n1.1 2.png\n");
  const Said metres = startrack({"calibrate", "depth", tum.path(), "--out", folder / "camera.toml"});
  LONGS_EQUAL(2, metres.code);
  STRCMP_CONTAINS("holds metres", metres.err.c_str());
}

// A camera that looks at a wall, and nothing but it.
TEST(CalibrateDepth, ARecordingWithoutFloorIsRefused) {
  TempFolder wall;
  wall.file("camera.toml", "width = 8\nheight = 4\nfx = 6\nfy = 6\ncx = 4\ncy = 2\n");
  for (int k = 0; k < 4; ++k) add_depth(wall.path(), k, 800);
  const Said said = startrack({"calibrate", "depth", wall.path(), "--out", folder / "camera.toml"});
  LONGS_EQUAL(2, said.code);
  STRCMP_CONTAINS("no floor in it", said.err.c_str());
}
