// The guard at the robot's end, as what it is: a process between a TCP connection and a simulated robot.
#include <netinet/in.h>
#include <sys/socket.h>

#include "tests/hal/create/processes.hpp"

// Last: it redefines new.
#include <CppUTest/TestHarness.h>

using namespace st;
using namespace st::test;

namespace {

// A bare connection; whoever speaks the Open Interface may use it.
int connect_to(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in there{};
  there.sin_family = AF_INET;
  there.sin_port = htons(static_cast<std::uint16_t>(port));
  there.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (int i = 0; i < 300; ++i, sleep_ms(20))
    if (connect(fd, reinterpret_cast<const sockaddr*>(&there), sizeof there) == 0) return fd;
  close(fd);
  return -1;
}

void say(int fd, std::initializer_list<int> bytes) {
  std::string text;
  for (const int byte : bytes) text += static_cast<char>(byte);
  CHECK_EQUAL(static_cast<ssize_t>(text.size()), send(fd, text.data(), text.size(), MSG_NOSIGNAL));
}

}  // namespace

TEST_GROUP(RemoteGuard) {
  SimulatedRobot robot;
  int port = 20000 + getpid() % 20000;
  pid_t guard = -1;
  int program = -1;

  void setup() override {
    CHECK(robot.up());
    guard = start_program(
        {"drive", "--guard", "--robot", robot.port(), "--listen", "127.0.0.1:" + std::to_string(port)});
    program = connect_to(port);
    CHECK(program >= 0);
  }
  void teardown() override {
    close(program);
    kill(guard, SIGTERM);
    LONGS_EQUAL(130, wait_for_exit(guard, 5000));
    sleep_ms(300);  // its brakes
    DOUBLES_EQUAL(0.0, robot.now().left_mps, 0);
  }
  // Commands that come while it still meets the robot wait in the connection.
  void drive_off() {
    say(program, {128, 131});
    for (int i = 0; i < 500 && robot.now().v_mps < 0.19; ++i, sleep_ms(10))
      say(program, {145, 0, 200, 0, 200});
    CHECK(robot.now().v_mps > 0.19);
  }
  double stands_after_ms(std::int64_t since_ns) { return StandWatch(robot.state(), since_ns).wait(3000); }
};

TEST(RemoteGuard, ACommandTornByTheEndOfTheConnectionDoesNotEatTheStop) {
  drive_off();
  const std::int64_t since_ns = monotonic_ns();
  say(program, {145, 0, 200, 0});
  close(program);
  program = -1;
  const double ms = stands_after_ms(since_ns);
  CHECK(ms >= 0 && ms < 300);
}

TEST(RemoteGuard, StopsWhenTheProgramFallsSilent) {
  drive_off();
  const double ms = stands_after_ms(monotonic_ns());
  CHECK(ms >= 0 && ms < 500);
}

TEST(RemoteGuard, ServesOneProgramAtATimeAndThenTheNext) {
  drive_off();
  const int second = connect_to(port);
  char byte;
  LONGS_EQUAL(0, recv(second, &byte, 1, 0));  // turned away
  close(second);
  close(program);
  sleep_ms(100);
  program = connect_to(port);
  drive_off();
}
