#include "firmware_like/sealed_section.hpp"

#include <pthread.h>

#include "hal/system/heap_guard.hpp"
#include "hal/system/prefault.hpp"
#include "hal/system/realtime.hpp"

namespace st {

SealedSection::SealedSection() {
  prefault_image();
  prefault_stack();
  pthread_getname_np(pthread_self(), name_before_, sizeof name_before_);
  name_this_thread(kLoopThreadName);
  begin_ = thread_usage();
  arm_heap_guard();
}

SealedSection::~SealedSection() { end(); }

void SealedSection::end() {
  if (!open_) return;
  heap_calls_ = st::heap_calls();
  disarm_heap_guard();
  total_ = thread_usage() - begin_;
  name_this_thread(name_before_);
  open_ = false;
}

std::uint64_t SealedSection::heap_calls() const { return open_ ? st::heap_calls() : heap_calls_; }
ThreadUsage SealedSection::usage() const { return open_ ? thread_usage() - begin_ : total_; }

}  // namespace st
