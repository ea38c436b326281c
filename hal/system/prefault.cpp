#include "hal/system/prefault.hpp"

#include <link.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <ctime>

namespace st {
namespace {

std::size_t page_bytes() { return static_cast<std::size_t>(sysconf(_SC_PAGESIZE)); }

void touch_for_reading(std::uintptr_t begin, std::uintptr_t end) {
  if (madvise(reinterpret_cast<void*>(begin), end - begin, MADV_POPULATE_READ) == 0) return;
  for (std::uintptr_t at = begin; at < end; at += page_bytes())
    static_cast<void>(*reinterpret_cast<const volatile char*>(at));
}

// A loaded segment. Its pages that the dynamic linker made read-only after relocation (RELRO) were written
// already and refuse to be written now, so a writable segment is populated page by page and falls back to
// reading.
void prefault_segment(std::uintptr_t begin, std::uintptr_t end, bool writable) {
  const std::size_t page = page_bytes();
  begin = begin / page * page;
  end = (end + page - 1) / page * page;
  if (!writable) {
    touch_for_reading(begin, end);
    return;
  }
  for (std::uintptr_t at = begin; at < end; at += page) {
    if (madvise(reinterpret_cast<void*>(at), page, MADV_POPULATE_WRITE) != 0)
      touch_for_reading(at, at + page);
  }
}

int prefault_object(dl_phdr_info* object, std::size_t, void* total) {
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const ElfW(Phdr)& segment = object->dlpi_phdr[i];
    if (segment.p_type != PT_LOAD || (segment.p_flags & PF_R) == 0) continue;
    const std::uintptr_t begin = object->dlpi_addr + segment.p_vaddr;
    prefault_segment(begin, begin + segment.p_memsz, (segment.p_flags & PF_W) != 0);
    *static_cast<std::size_t*>(total) += segment.p_memsz;
  }
  return 0;
}

// The kernel's time page, which clock_gettime() reads without a system call, belongs to no loaded object.
void read_the_time() {
  timespec now{};
  for (const clockid_t clock : {CLOCK_MONOTONIC, CLOCK_REALTIME}) clock_gettime(clock, &now);
}

}  // namespace

void populate_writable(void* data, std::size_t bytes) {
  if (madvise(data, bytes, MADV_POPULATE_WRITE) == 0) return;
  volatile char* at = static_cast<volatile char*>(data);  // kernels before 5.14
  for (std::size_t i = 0; i < bytes; i += page_bytes()) at[i] = at[i];
}

[[gnu::noinline]] void prefault_stack() {
  char pages[kStackPrefault];
  volatile char* at = pages;
  for (std::size_t i = 0; i < kStackPrefault; i += page_bytes()) at[i] = 0;
}

SetupStep prefault_image() {
  std::size_t total = 0;
  dl_iterate_phdr(prefault_object, &total);
  read_the_time();
  char line[80];
  std::snprintf(line, sizeof line, "program: %.1f MiB of code and data present",
                static_cast<double>(total) / (1 << 20));
  return {true, line};
}

}  // namespace st
