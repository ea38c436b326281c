// What the kernel counted: faults and context switches of a thread, memory of the process. No heap; fit for
// every frame.
#pragma once

#include <cstdint>

namespace st {

struct ThreadUsage {
  std::int64_t minor_faults = 0, major_faults = 0;
  std::int64_t voluntary_switches = 0;    // waits: one a frame is meant
  std::int64_t involuntary_switches = 0;  // somebody else got the CPU

  std::int64_t faults() const { return minor_faults + major_faults; }
  ThreadUsage operator-(const ThreadUsage& earlier) const {
    return {minor_faults - earlier.minor_faults, major_faults - earlier.major_faults,
            voluntary_switches - earlier.voluntary_switches,
            involuntary_switches - earlier.involuntary_switches};
  }
};

ThreadUsage thread_usage();  // of the calling thread, since it began

// Most memory that this program ever had resident; 0 when the kernel does not say. From /proc, since
// getrusage's figure starts with that of the program that started us.
std::uint64_t peak_rss_bytes();

}  // namespace st
