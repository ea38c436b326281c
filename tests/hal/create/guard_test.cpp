#include "hal/create/guard.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>

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
  int master = -1, port = -1;
  Guard guard;

  void setup() override {
    CHECK_EQUAL(0, openpty(&master, &port, nullptr, nullptr, nullptr));
    termios mode{};
    tcgetattr(port, &mode);
    cfmakeraw(&mode);
    tcsetattr(port, TCSANOW, &mode);
    fcntl(port, F_SETFL, O_NONBLOCK);
    GuardOrders orders;
    orders.stop = oi::halt();
    for (const std::uint8_t byte : kFarewell) orders.farewell.add(byte);
    guard = start_guard(port, orders);
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

TEST(Guard, TellsWhenThePortIsGone) {
  close(master);
  master = open("/dev/null", O_RDWR);
  Bytes heard;
  std::uint8_t bytes[512];
  for (ssize_t n = 1; n > 0; n = recv(guard.link, bytes, sizeof bytes, 0)) heard.assign(bytes, bytes + n);
  CHECK(heard[0] == kGuardPortGone);
  check_ended();
}

TEST(Guard, IsOutOfReachOfTheTerminal) {
  CHECK(getsid(guard.pid) == guard.pid);
  CHECK(getpgid(guard.pid) == guard.pid);
}
