// The live path against Debian's fakenect, which stands in for libfreenect under its own name: it must
// deliver what the reader of recordings delivers.
#include <CppUTest/TestHarness.h>

#include <sys/wait.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "hal/recording/fakenect_index.hpp"
#include "hal/source/stamp_clock.hpp"
#include "tests/support/fake_recording.hpp"
#include "tests/support/recorded_data.hpp"
#include "tests/support/temp_folder.hpp"

using namespace st;
using namespace st::test;

namespace {

const char* const kFakenect = "/usr/lib/x86_64-linux-gnu/fakenect/libfreenect.so.0.5";

// A sanitizer's run-time library must come first, and a preloaded one would come before it.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kCanPreload = false;
#else
constexpr bool kCanPreload = true;
#endif

bool fakenect_is_here() {
  if (kCanPreload && std::filesystem::exists(kFakenect)) return true;
  std::printf("skipped: fakenect (package libfreenect0.5) cannot be preloaded\n");
  return false;
}

// Runs `startrack record OUT ARGUMENTS` on a Kinect that is fakenect playing `folder`; the exit code.
int record_through_fakenect(const std::string& folder, const std::string& out, const std::string& arguments) {
  std::string command = "FAKENECT_PATH='";
  command.append(folder).append("' LD_PRELOAD=").append(kFakenect).append(" " STARTRACK_BINARY " record '");
  command.append(out).append("' ").append(arguments).append(" >/dev/null 2>&1");
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

long long ticks_in(const SeenFrame& frame) {
  return std::llround(frame.input.device_t_s * kKinectTicksPerSecond);
}

}  // namespace

TEST_GROUP(Kinect) { TempFolder folder; };

TEST(Kinect, ThroughFakenectPixelsAndTicksAreThoseOfTheRecording) {
  if (!fakenect_is_here()) return;
  const std::string source = folder / "source";
  for (int k = 0; k < 12; ++k) {
    const auto name = [k](char type) { return fakenect_name(type, host_of(k), ticks_of(k)); };
    add_named(source, name('r'), ppm(40 + k, 640, 480));
    add_named(source, name('d'), pgm(600 + k, 640, 480));
  }
  LONGS_EQUAL(0, record_through_fakenect(source, folder / "live", ""));
  const Seen direct = read_all(source), live = read_all(folder / "live");
  UNSIGNED_LONGS_EQUAL(12, direct.frames.size());
  CHECK(live.frames.size() >= 2);  // newest wins: a busy machine may skip some
  std::size_t at = 0;
  for (const SeenFrame& frame : live.frames) {
    while (at < direct.frames.size() && ticks_in(direct.frames[at]) != ticks_in(frame)) ++at;
    CHECK(at < direct.frames.size());
    if (at == direct.frames.size()) return;
    CHECK(frame.depth == direct.frames[at].depth);
    if (at > 0) CHECK(frame.color == direct.frames[at].color);
  }
}

TEST(Kinect, FakenectWithoutARecordingEndsTheProcessAndLeavesNothingRunning) {
  if (!fakenect_is_here()) return;
  LONGS_EQUAL(1, record_through_fakenect(folder / "nowhere", folder / "live", ""));
}

TEST(Kinect, ACalibrationOfAnotherSizeIsRefused) {
  if (!fakenect_is_here()) return;
  write_camera_toml(folder.path(), false);
  std::string arguments = "--camera '";
  LONGS_EQUAL(
      2, record_through_fakenect(folder.path(), folder / "live", arguments.append(folder / "camera.toml'")));
}

TEST(Kinect, WithoutAKinectOpeningSaysWhatToDo) {
  const std::string line = why_not("kinect");
  if (line.empty()) return;  // there is one
  STRCMP_CONTAINS("kinect: ", line.c_str());
  STRCMP_CONTAINS("startrack doctor", line.c_str());
}
