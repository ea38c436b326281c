// One fuzz harness a file. ST_FUZZ(name, seeds...) { body with `data` } makes it known to the driver
// (driver.cpp, built by any compiler into startrack_fuzz); compiled alone with -DSTARTRACK_LIBFUZZER and
// clang's -fsanitize=fuzzer, the same file is a libFuzzer program.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace st::fuzz {

using Data = std::span<const std::uint8_t>;

struct Harness {
  const char* name;
  void (*run)(Data data);
  std::vector<std::string> seeds;
};

inline std::vector<Harness>& harnesses() {
  static std::vector<Harness> all;
  return all;
}

struct Registration {
  Registration(const char* name, void (*run)(Data), std::initializer_list<std::string> seeds) {
    harnesses().push_back({name, run, seeds});
  }
};

inline std::string_view text_of(Data data) {
  return {reinterpret_cast<const char*>(data.data()), data.size()};
}

// What must hold for every input; ends the process as a crash does.
inline void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

}  // namespace st::fuzz

#ifdef STARTRACK_LIBFUZZER
#define ST_FUZZ_ENTRY(name)                                                            \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) { \
    st_fuzz_##name({bytes, size});                                                     \
    return 0;                                                                          \
  }
#else
#define ST_FUZZ_ENTRY(name)
#endif

#define ST_FUZZ(name, ...)                                                                               \
  static void st_fuzz_##name(st::fuzz::Data data);                                                       \
  static const st::fuzz::Registration st_fuzz_registration_##name(#name, st_fuzz_##name, {__VA_ARGS__}); \
  ST_FUZZ_ENTRY(name)                                                                                    \
  static void st_fuzz_##name(st::fuzz::Data data)
