// Counts heap calls of the calling thread: malloc, calloc, realloc, free and the aligned ones, and with them
// operator new and delete, whose standard versions call these. Linked into every program of this project,
// where its definitions come before the C library's and pass every call on to the next ones in line, so that
// a counter preloaded from outside still sees them. In sanitizer builds, where the sanitizer must own these
// names, its hooks count instead.
#pragma once

#include <cstdint>

namespace st {

void arm_heap_guard();       // counts the calling thread's calls from zero
void disarm_heap_guard();    // stops counting; heap_calls() keeps its value
std::uint64_t heap_calls();  // of the calling thread, since it was armed

}  // namespace st
