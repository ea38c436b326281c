#include "hal/create/guard.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>

#include <filesystem>
#include <vector>

#include "tests/hal/create/processes.hpp"

// Last: it redefines new.
#include <CppUTest/TestHarness.h>

using namespace st;
using namespace st::test;

namespace {

using Bytes = std::vector<std::uint8_t>;
const Bytes kStop = {145, 0, 0, 0, 0};
const Bytes kFarewell = {150, 0, 128};
constexpr std::size_t kMost = 25;

// What has come out of `fd`, until nothing more comes for that long.
Bytes drain(int fd, int quiet_ms) {
  Bytes all;
  std::uint8_t bytes[512];
  pollfd ready{fd, POLLIN, 0};
  while (all.size() < kMost && poll(&ready, 1, quiet_ms) > 0) {
    const ssize_t n = read(fd, bytes, sizeof bytes);
    if (n <= 0) break;
    all.insert(all.end(), bytes, bytes + n);
  }
  return all;
}

Bytes joined(const Bytes& a, const Bytes& b) {
  Bytes all = a;
  for (const std::uint8_t byte : b) all.push_back(byte);
  return all;
}

}  // namespace

TEST_GROUP(Guard) {
  TempFolder folder;
  std::string name = folder.file("robot");
  int master = -1, port = -1;
  Guard guard;

  // A port under the same name as the one before, as a USB adapter has it through udev.
  void plug_in() {
    char device[64];
    CHECK_EQUAL(0, openpty(&master, &port, device, nullptr, nullptr));
    std::filesystem::remove(name);
    std::filesystem::create_symlink(device, name);
  }
  void pull() {
    close(port);
    close(master);
    master = port = -1;
  }
  void setup() override {
    plug_in();
    set_line(port, 115200);
    fcntl(port, F_SETFL, O_NONBLOCK);
    GuardOrders orders;
    orders.linger_ms = 1500;
    orders.stop = oi::halt();
    for (const std::uint8_t byte : kFarewell) orders.farewell.add(byte);
    guard = start_guard(port, port_address(name, 115200), orders);
  }
  void teardown() override {
    if (guard.link >= 0) close(guard.link);
    if (guard.pid > 0) wait_for_exit(guard.pid, 2000);
    close(port);
    close(master);
  }
  void check_ended() {
    LONGS_EQUAL(0, wait_for_exit(guard.pid, 2000));
    guard.pid = -1;
  }
  // The next message that carries no bytes.
  int next_message() {
    Bytes heard(kGuardMessageBytes);
    for (ssize_t n = 2; n > 1;) {
      n = recv(guard.link, heard.data(), heard.size(), 0);
      if (n == 1) return heard[0];
    }
    return -1;
  }
  void say(const oi::Command& command) {
    send(guard.link, command.bytes, command.size, MSG_DONTWAIT | MSG_NOSIGNAL);
  }
};

TEST(Guard, PassesBytesBothWaysAndTellsWhatItSent) {
  say(oi::drive_direct(100, 100));
  const Bytes expected = {145, 0, 100, 0, 100};
  CHECK(drain(master, 100) == expected);
  CHECK(drain(guard.link, 20) == joined({kGuardSent}, expected));
  const Bytes answer = {19, 0, 255, 17, 3};  // not one of them means anything to a guard
  CHECK_EQUAL(5, write(master, answer.data(), answer.size()));
  Bytes heard(64);
  heard.resize(static_cast<std::size_t>(recv(guard.link, heard.data(), heard.size(), 0)));
  CHECK(heard == joined({kGuardReceived}, answer));
}

TEST(Guard, StopsWhenDriveCommandsCease) {
  say(oi::drive_direct(100, 100));
  CHECK(drain(master, 100).size() == 5);
  // Once every 250 ms from then on, should one get lost.
  const Bytes stops = drain(master, 2000);
  UNSIGNED_LONGS_EQUAL(kMost, stops.size());
  for (std::size_t i = 0; i < stops.size(); ++i) LONGS_EQUAL(kStop[i % 5], stops[i]);
}

TEST(Guard, OnlyDriveCommandsAreHeartbeats) {
  bool stopped = false;
  for (int i = 0; i < 30 && !stopped; ++i) {
    say(oi::sensors(35));
    for (const std::uint8_t byte : drain(master, 20)) stopped = stopped || byte == 145;
  }
  CHECK(stopped);
}

TEST(Guard, LetsALivingProgramDrive) {
  Bytes all;
  for (int i = 0; i < 40; ++i) {
    say(oi::drive_direct(100, 100));
    all = joined(all, drain(master, 15));
  }
  int stops = 0;
  for (std::size_t i = 0; i + 5 <= all.size(); i += 5)
    stops += Bytes(all.begin() + static_cast<std::ptrdiff_t>(i),
                   all.begin() + static_cast<std::ptrdiff_t>(i) + 5) == kStop;
  CHECK(stops <= 2);  // none, but for a machine that lets this test wait for a quarter of a second
  UNSIGNED_LONGS_EQUAL(0, all.size() % 5);
}

// Drive, drive direct and drive PWM, each alone.
TEST(Guard, EveryCommandThatDrivesIsAHeartbeat) {
  oi::Command pwm;
  for (const int byte : {146, 0, 50, 0, 50}) pwm.add(byte);
  for (const oi::Command& command : {oi::drive(100, oi::kStraight, 0.235), oi::drive_direct(90, 90), pwm}) {
    drain(master, 20);
    int stops = 0;
    for (int i = 0; i < 30; ++i) {
      say(command);
      const Bytes passed = drain(master, 15);
      stops += passed.size() >= 5 && Bytes(passed.begin(), passed.begin() + 5) == kStop;
    }
    CHECK(stops <= 2);  // as above
  }
}

TEST(Guard, LetsNothingPassByWhichTheRobotWouldEscapeIt) {
  drain(master, 20);
  for (const int opcode : {129, 132, 134, 135, 136, 143, 152, 153, 155, 156, 157, 158, 165, 167}) {
    oi::Command command;
    command.add(opcode);
    say(command);
  }
  say(oi::sensors(35));
  CHECK(drain(master, 50) == (Bytes{142, 35}));
}

TEST(Guard, StopsAndSaysFarewellWhenTheProgramGoes) {
  close(guard.link);
  guard.link = -1;
  CHECK(drain(master, 200) == joined(kStop, kFarewell));
  check_ended();
}

TEST(Guard, StopsWhenToldToEnd) {
  kill(guard.pid, SIGTERM);
  const Bytes last = drain(master, 200);
  CHECK(last.size() >= 8);
  CHECK(Bytes(last.end() - 8, last.end()) == joined(kStop, kFarewell));
  check_ended();
}

TEST(Guard, TellsWhenThePortIsGoneAndStopsTheRobotFirstOfAllWhenItIsBack) {
  pull();
  LONGS_EQUAL(kGuardPortGone, next_message());
  for (int i = 0; i < 10; ++i, sleep_ms(20)) say(oi::drive_direct(100, 100));  // too late for these
  plug_in();
  const Bytes first = drain(master, 200);
  CHECK(first.size() >= 5);
  CHECK(Bytes(first.begin(), first.begin() + 5) == kStop);
  LONGS_EQUAL(kGuardPortBack, next_message());
  say(oi::drive_direct(100, 100));
  CHECK(drain(master, 100)[0] == oi::kDriveDirect);
}

TEST(Guard, WaitsForThePortLongerThanItsProgramLives) {
  pull();
  LONGS_EQUAL(kGuardPortGone, next_message());
  close(guard.link);
  guard.link = -1;
  sleep_ms(200);
  plug_in();
  CHECK(drain(master, 300) == joined(kStop, kFarewell));
  check_ended();
}

TEST(Guard, DoesNotWaitForEver) {
  pull();
  LONGS_EQUAL(kGuardPortGone, next_message());
  close(guard.link);
  guard.link = -1;
  LONGS_EQUAL(0, wait_for_exit(guard.pid, 5000));
  guard.pid = -1;
}

TEST(Guard, LeavesThePortToTheNextProgram) {
  pull();
  LONGS_EQUAL(kGuardPortGone, next_message());
  plug_in();
  LONGS_EQUAL(kGuardPortBack, next_message());
  close(guard.link);
  guard.link = -1;
  check_ended();
  const int next = open_port(port_address(name, 115200), 0);
  CHECK(next >= 0);
  close(next);
}

TEST(Guard, IsOutOfReachOfTheTerminal) {
  CHECK(getsid(guard.pid) == guard.pid);
  CHECK(getpgid(guard.pid) == guard.pid);
}
