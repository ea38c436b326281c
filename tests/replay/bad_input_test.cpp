// Bad input ends with code 2 and one line that says what, where, and what to do.
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "tests/replay/driven_circle.hpp"
#include "tests/support/fake_recording.hpp"
#include "tests/support/program.hpp"
#include "tests/support/recorded_data.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;
namespace fs = std::filesystem;

TEST_GROUP(BadInput) {
  TempFolder folder;

  void setup() override {
    const std::string recording = folder / "good";
    fs::create_directory(recording);
    write_camera_toml(recording, false);
    for (int k = 0; k < 4; ++k) add_depth(recording, k, 700);
  }

  // `what` stands in the one line.
  static void check_refused(const std::vector<std::string>& arguments, const char* what) {
    const Said said = startrack(arguments);
    LONGS_EQUAL_TEXT(2, said.code, said.err.c_str());
    STRCMP_CONTAINS(what, said.err.c_str());
    LONGS_EQUAL_TEXT(1, lines_of(said.err), said.err.c_str());
    STRCMP_EQUAL("", said.out.c_str());
  }

  std::vector<std::string> replay(const std::string& recording, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"replay", recording, "--out", folder / "run"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  std::string file(const std::string& name, const std::string& text) const {
    write_file(folder / name, text);
    return folder / name;
  }
};

TEST(BadInput, TheGoodRecordingIsGood) { LONGS_EQUAL(0, startrack(replay(folder / "good")).code); }

TEST(BadInput, Recordings) {
  check_refused(replay(folder / "nowhere"), "nowhere");
  fs::create_directory(folder / "empty");
  check_refused(replay(folder / "empty"), "INDEX.txt");
  fs::create_directory(folder / "foreign");
  file("foreign/photo.jpg", "\xff\xd8\xff");
  check_refused(replay(folder / "foreign"), "INDEX.txt");
  file("foreign/INDEX.txt", "photo.jpg\n");
  check_refused(replay(folder / "foreign"), "no depth frame is listed");
  fs::create_directory(folder / "gone");
  file("gone/INDEX.txt", "d-1.0-1.pgm\nd-2.0-2.pgm\n");
  check_refused(replay(folder / "gone"), "0 usable depth frames of 2");
  check_refused(replay(file("a-file", "x")), "a-file");
  CHECK(!fs::exists(folder / "run"));  // nothing was begun
}

TEST(BadInput, Calibration) {
  check_refused(replay(folder / "good", {"--camera", file("c.toml", "width = 8\nheight = 4\nfocal = 3\n")}),
                "c.toml:3: ");
  check_refused(replay(folder / "good", {"--camera", folder / "no.toml"}), "no.toml");
  file("good/camera.toml", "width = 8\n\nheigth = 4\n");
  check_refused(replay(folder / "good"), "camera.toml:3: ");
}

TEST(BadInput, Paths) {
  check_refused(
      replay(folder / "good", {"--path", file("p.toml", "speed_mps = 0.2\n[[step]]\nline = \"far\"\n")}),
      "p.toml:3: ");
  check_refused(replay(folder / "good", {"--path", file("n.toml", "nonsense\n")}), "n.toml:1: ");
  check_refused(replay(folder / "good", {"--path", file("p.csv", "x,y\n1,0\nleft\n")}), "p.csv:3: ");
  check_refused(replay(folder / "good", {"--path", folder / "no.toml"}), "no.toml");
}

TEST(BadInput, WordsOfTheCommandLine) {
  check_refused({}, "subcommand");
  check_refused({"replai"}, "replai");
  check_refused({"replay"}, "REC");
  check_refused(replay(folder / "good", {"--pace", "slow"}), "slow");
  check_refused(replay(folder / "good", {"--simd", "MMX"}), "MMX");
  check_refused(replay(folder / "good", {"--without", "smell"}), "smell");
  check_refused(replay(folder / "good", {"--tracker", "magic"}), "magic");
  check_refused(replay(folder / "good", {"--volume", "100"}), "volume");
  check_refused({"run", "--source", "sim:moon", "--out", folder / "run"}, "moon");
  check_refused({"run", "--source", folder / "good", "--robot", "sim", "--path",
                 STARTRACK_SOURCE_DIR "/examples/paths/circle-0.5.toml", "--out", folder / "run"},
                "needs a camera that sees it now");
  check_refused({"run", "--source", "sim:lab", "--loop", "closed", "--out", folder / "run"},
                "--loop closed needs --robot PORT and --path FILE");
  check_refused({"run", "--source", "sim:lab", "--robot", "sim", "--out", folder / "run"},
                "what shall it do?");
  check_refused({"run", "--source", "sim:lab", "--mode", "scan", "--robot", "sim", "--path",
                 STARTRACK_SOURCE_DIR "/examples/paths/circle-0.5.toml", "--out", folder / "run"},
                "--mode scan");
  for (const char* address : {"no-port", ":7171", "host.invalid:7171"})
    check_refused({"run", "--source", "sim:lab", "--serve", address, "--out", folder / "run"},
                  (std::string("--serve ") + address + ": ").c_str());
  check_refused({"run", "--source", "sim:lab", "--record", folder / "good", "--out", folder / "run"},
                "good: is not empty");
  for (const char* arena : {"1,2", "1,2;3,4", "1,2;3,4;x,6", "1;2;3"})
    check_refused(replay(folder / "good", {"--arena", arena}), "three to sixteen corners");
  check_refused({"drive", "--robot", "sim", "--wheels", file("w.toml", "wheelbase = 1\n"), "--path", "p"},
                "w.toml:1: unknown key");
  check_refused({"calibrate", "robot", "--run", folder / "good", "--recording", folder / "good"},
                "good/robot.log: not there");
  file("good/robot.log", "# model create2\n");
  check_refused({"calibrate", "robot", "--run", folder / "good", "--recording", folder / "good"},
                "is not a run");
  const std::string truth = file("truth.tum", "1 0 0 0 0 0 0 1\n");
  check_refused({"evaluate", folder / "good", "--truth", truth}, "good: is no run");
  check_refused({"evaluate", file("notes.txt", "mine\n"), "--truth", truth},
                "notes.txt: is no TUM trajectory");
}

TEST(BadInput, ARobotThatIsNotThereIsADevicesFault) {
  const Said said =
      startrack({"run", "--source", "sim:lab", "--robot", "/dev/nowhere", "--path",
                 STARTRACK_SOURCE_DIR "/examples/paths/circle-0.5.toml", "--out", folder / "run"});
  LONGS_EQUAL_TEXT(3, said.code, said.err.c_str());
  STRCMP_CONTAINS("/dev/nowhere", said.err.c_str());
  LONGS_EQUAL_TEXT(1, lines_of(said.err), said.err.c_str());
}

TEST(BadInput, PlacesWhereNothingCanBeWritten) {
  file("a-file", "x");
  check_refused({"replay", folder / "good", "--out", folder / "a-file"}, "a-file: is not a folder");
  check_refused({"replay", folder / "good", "--out", folder / "a-file/run"}, "a-file/run");
  check_refused({"replay", folder / "good", "--out", folder / "good"}, "holds a recording");
  if (geteuid() == 0) return;  // root may write everywhere
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  check_refused({"replay", folder / "good", "--out", folder / "locked"}, "locked: cannot write here");
  check_refused({"replay", folder / "good", "--out", folder / "locked/run"}, "locked/run");
}

TEST(BadInput, AFullDiskIsSaidAndTheRowsAreWhole) {
  const std::string disk = folder / "disk", said = folder / "said";
  fs::create_directory(disk);
  // A mount of its own, which this command alone sees. The smaller one is full after some rows, the larger
  // one holds the rows, but not the mesh.
  for (const char* size : {"12k", "48k"}) {
    const std::string mount =
        std::string("unshare -rm sh -c 'mount -t tmpfs -o size=") + size + " none " + disk + " && ";
    if (std::system((mount + "true' 2>/dev/null").c_str()) != 0) {
      std::printf("skipped: no small file system can be mounted here\n");
      return;
    }
    const std::string command = mount + STARTRACK_BINARY + " replay " + driven_circle() + " --out " + disk +
                                "/run >/dev/null 2>" + said + "; code=$?; cp -r " + disk + "/run " +
                                folder.path() + "; exit $code'";
    LONGS_EQUAL(2, WEXITSTATUS(std::system(command.c_str())));
    const std::string text = content(said);
    STRCMP_CONTAINS("the disk is full", text.substr(text.rfind('\n', text.size() - 2) + 1).c_str());
    CHECK(!fs::exists(folder / "run/summary.json"));
    for (const fs::directory_entry& entry : fs::directory_iterator(folder / "run")) {
      const std::string rows = content(entry.path().string());
      CHECK_TEXT(rows.empty() || rows.ends_with('\n'), entry.path().c_str());
    }
    fs::remove_all(folder / "run");
  }
}
