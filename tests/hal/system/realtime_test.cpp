#include "hal/system/realtime.hpp"

#include <CppUTest/TestHarness.h>
#include <pthread.h>
#include <sched.h>

#include <thread>

using namespace st;

namespace {

// On a thread of its own: what it changes must not outlive the test.
template <typename Body>
void on_a_thread(Body body) {
  std::thread thread(body);
  thread.join();
}

}  // namespace

TEST_GROUP(Realtime){};

TEST(Realtime, PriorityIsTakenOrRefusedWithARemedy) {
  SetupStep step;
  int policy = -1;
  on_a_thread([&] {
    step = use_realtime_priority(kLoopPriority);
    policy = sched_getscheduler(0) & ~SCHED_RESET_ON_FORK;
  });
  LONGS_EQUAL(step.ok ? SCHED_FIFO : SCHED_OTHER, policy);
  if (!step.ok) CHECK(step.remedy.find("startrack-limits.conf") != std::string::npos);
}

TEST(Realtime, AnImpossiblePriorityIsRefused) {
  SetupStep step;
  on_a_thread([&] { step = use_realtime_priority(1000); });
  CHECK(!step.ok);
}

TEST(Realtime, PinsToOneCpuAndRefusesOneThatIsNotThere) {
  SetupStep good, missing, nonsense;
  int count = 0;
  on_a_thread([&] {
    cpu_set_t allowed;
    sched_getaffinity(0, sizeof allowed, &allowed);
    int first = 0;
    while (!CPU_ISSET(static_cast<std::size_t>(first), &allowed)) ++first;
    good = pin_to_cpu(first);
    sched_getaffinity(0, sizeof allowed, &allowed);
    count = CPU_COUNT(&allowed);
    missing = pin_to_cpu(1023);
    nonsense = pin_to_cpu(-1);
  });
  CHECK(good.ok);
  LONGS_EQUAL(1, count);
  CHECK(!missing.ok);
  CHECK(!nonsense.ok);
}

TEST(Realtime, DenormalsAreZeroAfterwards) {
  volatile float result = 1;
  on_a_thread([&] {
    flush_denormals();
    volatile float tiny = 1e-38f;
    result = tiny * 0.01f;
  });
  CHECK(result == 0.0f);
}

TEST(Realtime, TheThreadShowsItsName) {
  char name[16] = "";
  on_a_thread([&] {
    name_this_thread(kLoopThreadName);
    pthread_getname_np(pthread_self(), name, sizeof name);
  });
  STRCMP_EQUAL("st-loop", name);
}
