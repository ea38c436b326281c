#include "hal/system/rusage.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdio>
#include <cstring>

namespace st {

ThreadUsage thread_usage() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return {usage.ru_minflt, usage.ru_majflt, usage.ru_nvcsw, usage.ru_nivcsw};
}

std::uint64_t peak_rss_bytes() {
  char text[4096];
  const int file = open("/proc/self/status", O_RDONLY | O_CLOEXEC);
  if (file < 0) return 0;
  const ssize_t got = read(file, text, sizeof text - 1);
  close(file);
  if (got <= 0) return 0;
  text[got] = '\0';
  const char* line = std::strstr(text, "VmHWM:");
  unsigned long long kib = 0;
  if (line == nullptr || std::sscanf(line, "VmHWM: %llu kB", &kib) != 1) return 0;
  return kib * 1024;
}

}  // namespace st
