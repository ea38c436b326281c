// Makes memory present before the loop needs it, so that the compute thread takes no page fault after the
// first frame.
#pragma once

#include <cstddef>

#include "hal/system/setup_step.hpp"

namespace st {

// Every page of the writable range is present afterwards; contents are kept.
void populate_writable(void* data, std::size_t bytes);

// Touches the calling thread's stack below the caller. Call it on the thread that needs it.
inline constexpr std::size_t kStackPrefault = std::size_t{512} << 10;
void prefault_stack();

// Code and data of the program and its libraries: without this, the first run through a rarely used branch
// reads the disk in the middle of a frame. The step says how much is present.
SetupStep prefault_image();

}  // namespace st
