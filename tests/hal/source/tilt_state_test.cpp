#include "hal/source/tilt_state.hpp"

#include <CppUTest/TestHarness.h>

#include <cstdio>
#include <filesystem>
#include <vector>

#include "algo/core/pose.hpp"
#include "tests/support/fake_recording.hpp"
#include "tests/support/recorded_data.hpp"

using namespace st;
using namespace st::test;

namespace {

void check_direction(const Vec3& expected, const std::optional<Vec3>& up) {
  CHECK(up.has_value());
  if (!up) return;
  const Vec3 unit = normalized(*up);
  for (int i = 0; i < 3; ++i) DOUBLES_EQUAL(expected[i], unit[i], 0.02);
}

// Every accelerometer file of a folder, in any order.
std::vector<TiltState> tilts_of(const std::string& folder) {
  std::vector<TiltState> tilts;
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".dump") continue;
    const std::string bytes = read_file(file.path().string());
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    if (const auto tilt = parse_tilt_state({data, bytes.size()})) tilts.push_back(*tilt);
  }
  return tilts;
}

}  // namespace

TEST_GROUP(TiltState){};

TEST(TiltState, LevelCameraHasUpAgainstItsDownAxis) {
  check_direction({0, -1, 0}, up_from_tilt({0, 819, 0, 0, 0}));
}

TEST(TiltState, AKinectThatLooksDownHasItsForwardAxisDown) {
  // 20 degrees down, as the chip (x left, y up, z forward) and the firmware say.
  check_direction({0, -0.940, -0.342}, up_from_tilt({0, 770, -280, -40, 0}));
}

TEST(TiltState, AKinectThatLooksUpIsBelievedWhenItsFirmwareSaysSo) {
  check_direction({-0.1, -0.93, 0.342}, up_from_tilt({82, 762, 280, 40, 0}));
}

TEST(TiltState, AccelerationWithoutPitchThatWouldLookUpLooksDown) {
  check_direction({0.1, -0.85, -0.52}, up_from_tilt({82, 696, 426, 0, 0}));
}

TEST(TiltState, NothingWhileTheMotorTurnsOrWithoutGravity) {
  CHECK(!up_from_tilt({0, 819, 0, 0, 4}));
  CHECK(!up_from_tilt({0, 0, 0, 0, 0}));
  CHECK(!up_from_tilt({0, 1300, 0, 0, 0}));
}

TEST(TiltState, BytesAndVectorsRoundTrip) {
  const Vec3 up{0.4, -9.1, -3.6};
  std::uint8_t bytes[kTiltStateBytes];
  format_tilt_state(tilt_from_up(up), bytes);
  const auto tilt = parse_tilt_state(bytes);
  CHECK(tilt.has_value());
  const auto back = up_from_tilt(*tilt);
  CHECK(back.has_value());
  for (int i = 0; i < 3; ++i) DOUBLES_EQUAL(up[i], (*back)[i], 9.80665 / 819);
  CHECK(!parse_tilt_state({bytes, 11}));
}

// Why z is taken for forward: the firmware's pitch, positive upwards, has the sign and the size of z over y.
TEST(TiltState, FirmwarePitchOfARealKinectAgreesWithForwardZ) {
  const std::string wave = recording("hand-wave");
  if (wave.empty()) return;
  double z = 0, y = 0, pitch_deg = 0;
  const std::vector<TiltState> tilts = tilts_of(wave);
  for (const TiltState& tilt : tilts) {
    z += tilt.z;
    y += tilt.y;
    pitch_deg += 0.5 * tilt.angle_half_deg;
  }
  UNSIGNED_LONGS_EQUAL(861, tilts.size());
  DOUBLES_EQUAL(z / y * 57.2958, pitch_deg / 861, 0.2);
}

TEST(TiltState, UpIsTheFloorsNormalOfTheSimulatedLab) {
  const std::string lab =
      recording("lab-square", {"lab-square/rec/a-140010100[01].*.dump", "lab-square/truth.tum"});
  if (lab.empty()) return;
  double t, x, y, z, qx, qy, qz, qw;
  const std::string truth = read_file(lab + "/truth.tum");
  LONGS_EQUAL(
      8, std::sscanf(truth.c_str(), "%lf %lf %lf %lf %lf %lf %lf %lf", &t, &x, &y, &z, &qx, &qy, &qz, &qw));
  const std::vector<TiltState> tilts = tilts_of(lab + "/rec");
  CHECK(!tilts.empty());
  Vec3 sum{};
  for (const TiltState& tilt : tilts) {
    const auto up = up_from_tilt(tilt);
    CHECK(up.has_value());
    if (up) sum += *up;
  }
  check_direction(from_quaternion({qx, qy, qz, qw}).col(2), sum * (1.0 / static_cast<double>(tilts.size())));
}
