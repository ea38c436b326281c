#include "hal/create/sim/create_pty.hpp"

#include <filesystem>

#include "hal/create/robot_port.hpp"
#include "hal/error.hpp"
#include "tests/hal/create/processes.hpp"

// Last: it redefines new.
#include <CppUTest/TestHarness.h>

using namespace st;
using namespace st::test;

TEST_GROUP(CreatePty){};

TEST(CreatePty, MakesItsLinkAndTakesItAway) {
  TempFolder folder;
  sim::CreatePtyOptions options;
  options.link_path = folder.file("robot");
  {
    const sim::CreatePty pty(options);
    STRCMP_EQUAL(pty.path().c_str(), std::filesystem::read_symlink(options.link_path).c_str());
  }
  CHECK_FALSE(std::filesystem::is_symlink(options.link_path));
}

TEST(CreatePty, ReplacesTheLinkOfADeadSimulatorAndNothingElse) {
  TempFolder folder;
  sim::CreatePtyOptions options;
  options.link_path = folder.file("robot");
  std::filesystem::create_symlink("/dev/pts/99999", options.link_path);
  { const sim::CreatePty pty(options); }
  folder.file("robot", "somebody's notes");
  CHECK_THROWS(Failure, sim::CreatePty(options));
  CHECK(std::filesystem::is_regular_file(options.link_path));
}

TEST(CreatePty, SeesTheSpeedThatTheDriverSets) {
  sim::CreatePtyOptions options;
  options.events.push_back(sim::parse_world_event("0.05:bump"));
  sim::CreatePty pty(options);
  RobotPort port(pty.path(), 57600);
  const std::uint8_t start[] = {128};
  port.write(start);
  pty.run([](double t_s) { return t_s > 0.1; });
  LONGS_EQUAL(oi::kOff, pty.engine().mode());
  port.set_baud(115200);
  port.write(start);
  pty.run([](double t_s) { return t_s > 0.1; });
  LONGS_EQUAL(oi::kPassive, pty.engine().mode());
}

TEST(CreatePty, PublishesAThousandStatesASecond) {
  TempFolder folder;
  sim::CreatePtyOptions options;
  options.state_path = folder.file("state");
  sim::CreatePty pty(options);
  CHECK_THROWS(Failure, SimStateReader(options.state_path));
  pty.run([](double t_s) { return t_s > 0.2; });
  const SimStateReader state(options.state_path);
  CHECK(state.written() >= 200);
  SimStateEntry a, b;
  CHECK(state.entry(10, a) && state.entry(11, b));
  CHECK(b.monotonic_ns - a.monotonic_ns == 1'000'000);
  CHECK_FALSE(state.entry(state.written(), a));
}

TEST(CreatePty, RefusesEventsThatItDoesNotKnow) {
  for (const char* text : {"3", "3:flood", ":cliff", "-1:cliff", "x:cliff"})
    CHECK_THROWS(Failure, sim::parse_world_event(text));
}
