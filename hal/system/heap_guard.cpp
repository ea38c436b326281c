#include "hal/system/heap_guard.hpp"

#include <cstddef>

namespace st {
namespace {

// initial-exec: reached without a call into the loader, which might itself allocate.
[[gnu::tls_model("initial-exec")]] thread_local bool t_armed = false;
[[gnu::tls_model("initial-exec")]] thread_local std::uint64_t t_calls = 0;

void count_heap_call() {
  if (t_armed) ++t_calls;
}

}  // namespace

void disarm_heap_guard() { t_armed = false; }
std::uint64_t heap_calls() { return t_calls; }

}  // namespace st

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)

extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*)(const volatile void*, std::size_t),
                                                         void (*)(const volatile void*));

void st::arm_heap_guard() {
  static const int installed =
      __sanitizer_install_malloc_and_free_hooks([](const volatile void*, std::size_t) { count_heap_call(); },
                                                [](const volatile void*) { count_heap_call(); });
  t_calls = 0;
  t_armed = installed != 0;
}

#else

#include "hal/system/heap_interposer.inc"

void st::arm_heap_guard() {
  t_calls = 0;
  t_armed = true;
}

#endif
