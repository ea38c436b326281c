#include "hal/system/stop_signal.hpp"

#include <CppUTest/TestHarness.h>
#include <poll.h>
#include <signal.h>
#include <sys/types.h>

#include <cerrno>

using namespace st;

namespace {

bool readable(int fd) {
  pollfd wait{fd, POLLIN, 0};
  return poll(&wait, 1, 0) == 1;
}

}  // namespace

TEST_GROUP(StopSignal) {
  struct sigaction old_[3];
  static constexpr int kSignals[3] = {SIGINT, SIGTERM, SIGHUP};

  void setup() override {
    for (int i = 0; i < 3; ++i) sigaction(kSignals[i], nullptr, &old_[i]);
    watch_stop_signals();
    forget_stop_signals();
  }
  void teardown() override {
    forget_stop_signals();
    for (int i = 0; i < 3; ++i) sigaction(kSignals[i], &old_[i], nullptr);
    signal(SIGPIPE, SIG_DFL);
  }
};

TEST(StopSignal, NothingIsNotedBeforeASignal) {
  LONGS_EQUAL(0, stop_signal());
  CHECK(!mesh_unwanted());
  CHECK(!readable(stop_signal_fd()));
}

TEST(StopSignal, TheFirstSignalIsKeptAndWakesAPoll) {
  for (int number : kSignals) {
    forget_stop_signals();
    raise(number);
    LONGS_EQUAL(number, stop_signal());
    CHECK(readable(stop_signal_fd()));
    CHECK(!mesh_unwanted());
  }
}

TEST(StopSignal, ASecondCtrlCSkipsTheMesh) {
  raise(SIGTERM);
  raise(SIGINT);
  LONGS_EQUAL(SIGTERM, stop_signal());
  CHECK(mesh_unwanted());
}

TEST(StopSignal, AClosedTerminalThatHangsUpTwiceDoesNotSkipTheMesh) {
  raise(SIGHUP);
  raise(SIGHUP);
  CHECK(!mesh_unwanted());
}

TEST(StopSignal, TheHandlerKeepsErrno) {
  errno = 77;
  raise(SIGINT);
  LONGS_EQUAL(77, errno);
}

TEST(StopSignal, AReaderThatGoesAwayDoesNotKillTheProgram) {
  raise(SIGPIPE);
  LONGS_EQUAL(0, stop_signal());
}
