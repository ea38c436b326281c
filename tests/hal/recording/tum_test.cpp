#include <CppUTest/TestHarness.h>

#include <cstdio>

#include "tests/support/fake_recording.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/temp_folder.hpp"

using namespace st;
using namespace st::test;

TEST_GROUP(Tum) {
  TempFolder folder;

  void setup() override {
    write_camera_toml(folder.path(), true);
    write_file(folder / "depth.txt", "# timestamp filename\r\n\n");
  }
  void add(const char* list, double t_s, const std::string& name, const std::string& content) {
    write_file(folder / name, content);
    char stamp[32];
    std::snprintf(stamp, sizeof stamp, "%.6f ", t_s);
    append_file(folder / list, stamp + name + "\n");
  }
};

TEST(Tum, DeliversPixelsAndStampsInOrder) {
  for (int k = 0; k < 12; ++k)
    add("depth.txt", 5 + k / 30.0, "depth/" + std::to_string(k), png_gray16(1000 * k));
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(12, seen.frames.size());
  CHECK(seen.info.calibration.encoding == DepthEncoding::kScaled16);
  for (int k = 0; k < 12; ++k) {
    const SeenFrame& frame = seen.frames[static_cast<std::size_t>(k)];
    for (const std::uint16_t value : frame.depth) LONGS_EQUAL(1000 * k, value);
    DOUBLES_EQUAL(5 + k / 30.0, frame.input.t_s, 1e-6);
    DOUBLES_EQUAL(frame.input.t_s, frame.input.device_t_s, 0);
    CHECK(frame.color.empty());
  }
}

TEST(Tum, ColourIsTheNewestThatIsNotLater) {
  add("rgb.txt", 5.00, "rgb/0.png", png_rgb8(10));
  add("rgb.txt", 5.05, "rgb/1.png", png_rgb8(11));
  add("rgb.txt", 5.06, "rgb/2.png", png_gray8(12));
  for (const double t_s : {4.9, 5.0, 5.04, 5.07}) add("depth.txt", t_s, std::to_string(t_s), png_gray16(1));
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(4, seen.frames.size());
  CHECK(seen.frames[0].color.empty());
  LONGS_EQUAL(10, seen.frames[1].color[0]);
  LONGS_EQUAL(10, seen.frames[2].color[0]);
  CHECK(!seen.frames[2].input.color_is_new);
  LONGS_EQUAL(12, seen.frames[3].color[5]);
  DOUBLES_EQUAL(5.06, seen.frames[3].input.color_device_t_s, 1e-9);
}

TEST(Tum, DamageIsSkippedAndTold) {
  add("depth.txt", 1.0, "0.png", png_gray16(1));
  add("depth.txt", 1.1, "1.png", png_gray16(1).substr(0, 60));
  add("depth.txt", 1.2, "2.png", png_gray16(1, 16, 8));
  add("depth.txt", 1.3, "3.png", png_gray8(1));
  append_file(folder / "depth.txt",
              "1.4 missing.png\n1.5 ../0.png\n1.6 /etc/passwd\nrubbish\n0.9 0.png\n1.0 0.png\n");
  add("depth.txt", 1.7, "4.png", png_gray16(4));
  const Seen seen = read_all(folder.path());
  UNSIGNED_LONGS_EQUAL(2, seen.frames.size());
  const std::vector<Event> events = seen.events(EventKind::kDamaged);
  const DamageReason expected[] = {
      DamageReason::kShort,   DamageReason::kWrongSize, DamageReason::kForeign,
      DamageReason::kMissing, DamageReason::kForeign,   DamageReason::kForeign,
      DamageReason::kForeign, DamageReason::kBackwards, DamageReason::kBackwards};
  UNSIGNED_LONGS_EQUAL(9, events.size());
  for (std::size_t i = 0; i < 9; ++i) {
    DOUBLES_EQUAL(static_cast<double>(expected[i]), events[i].b, 0);
    DOUBLES_EQUAL(static_cast<double>(i + 1), events[i].a, 0);
  }
}

TEST(Tum, EightBitDepthIsRefusedWithWhatIsExpected) {
  for (int k = 0; k < 3; ++k) add("depth.txt", k, std::to_string(k), png_gray8(1));
  STRCMP_CONTAINS("8-bit grey PNG; depth is expected as 16-bit grey PNG", why_not(folder.path()).c_str());
}

TEST(Tum, WithoutCameraTomlTheDefaultIsSaid) {
  TempFolder other;
  for (const char* name : {"0.png", "1.png"}) {
    write_file(other / name, png_gray16(5000, 640, 480));
    append_file(other / "depth.txt", std::string(name, 1) + " " + name + "\n");
  }
  const Seen seen = read_all(other.path());
  DOUBLES_EQUAL(525.0, seen.info.calibration.depth.fx, 0);
  DOUBLES_EQUAL(5000.0, seen.info.calibration.depth_scale, 0);
  CHECK(seen.info.calibration.color_registered);
  STRCMP_CONTAINS("scale 5000", seen.info.calibration_note.c_str());
  CHECK(seen.info.calibration_note.find('\n') == std::string::npos);
}

TEST(Tum, RealScansAreReadWhole) {
  const std::string kitchen = recording("kitchen-scan"), table = recording("toy-table");
  if (!kitchen.empty()) {
    const Seen seen = read_all(kitchen);
    UNSIGNED_LONGS_EQUAL(400, seen.frames.size());
    UNSIGNED_LONGS_EQUAL(0, seen.events(EventKind::kDamaged).size() + seen.events(EventKind::kGap).size());
    DOUBLES_EQUAL(585.0, seen.info.calibration.depth.fx, 0);
  }
  if (!table.empty()) {
    const Seen seen = read_all(table);
    UNSIGNED_LONGS_EQUAL(500, seen.frames.size());
    UNSIGNED_LONGS_EQUAL(320 * 240, seen.frames[0].depth.size());
    UNSIGNED_LONGS_EQUAL(0, seen.events(EventKind::kDamaged).size() + seen.events(EventKind::kGap).size());
  }
}
