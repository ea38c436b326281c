// A second opinion on the heap guard, from outside: preloaded into any program, it counts the heap calls of
// every thread while that thread is named `st-loop`. At exit it appends a line to the file named by
// HEAP_COUNTER_OUT: `sealed N calls M`, N: how often a thread took that name.
#include <fcntl.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace st {
namespace {

constexpr const char* kLoop = "st-loop";
std::atomic<std::uint64_t> g_calls{0};
std::atomic<std::uint64_t> g_sealed{0};

// Asks the kernel each time: slow for everybody else, but it knows nothing of how the program is built.
void count_heap_call() {
  char name[16] = "";
  if (prctl(PR_GET_NAME, name) == 0 && std::strcmp(name, kLoop) == 0) g_calls.fetch_add(1);
}

}  // namespace
}  // namespace st

#include "hal/system/heap_interposer.inc"

// Without this a program whose loop never ran would look like one whose loop made no call.
extern "C" int pthread_setname_np(pthread_t thread, const char* name) noexcept {
  if (std::strcmp(name, st::kLoop) == 0) st::g_sealed.fetch_add(1);
  const auto real = reinterpret_cast<int (*)(pthread_t, const char*)>(dlsym(RTLD_NEXT, "pthread_setname_np"));
  return real(thread, name);
}

[[gnu::destructor]] static void write_counts() {
  const char* path = std::getenv("HEAP_COUNTER_OUT");
  const int file = path == nullptr ? -1 : open(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file < 0) return;
  dprintf(file, "sealed %llu calls %llu\n", static_cast<unsigned long long>(st::g_sealed.load()),
          static_cast<unsigned long long>(st::g_calls.load()));
  close(file);
}
