#include "hal/results/telemetry.hpp"

#include <pthread.h>

#include <chrono>
#include <new>
#include <type_traits>
#include <utility>

namespace st {

static_assert(std::is_trivially_copyable_v<FrameReport>,
              "reports are copied into slots on the compute thread");

void ReportRing::bind(Bump& bump, std::size_t slots) {
  slots_ = bump.take<FrameReport>(slots);
  for (FrameReport& slot : slots_) new (&slot) FrameReport{};
}

bool ReportRing::has_room() const {
  return pushed_.load(std::memory_order_relaxed) - popped_.load(std::memory_order_acquire) < slots_.size();
}

bool ReportRing::push(const FrameReport& report) {
  if (!has_room()) return false;
  const std::uint64_t at = pushed_.load(std::memory_order_relaxed);
  slots_[at % slots_.size()] = report;
  const std::size_t waiting = static_cast<std::size_t>(at + 1 - popped_.load(std::memory_order_relaxed));
  if (waiting > high_water_.load(std::memory_order_relaxed))
    high_water_.store(waiting, std::memory_order_relaxed);
  pushed_.store(at + 1, std::memory_order_release);
  return true;
}

const FrameReport* ReportRing::front() const {
  const std::uint64_t at = popped_.load(std::memory_order_relaxed);
  if (at == pushed_.load(std::memory_order_acquire)) return nullptr;
  return &slots_[at % slots_.size()];
}

void ReportRing::pop() {
  popped_.store(popped_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
}

Telemetry::Telemetry(ReportRing& ring, std::vector<TelemetrySink*> sinks)
    : ring_(ring), sinks_(std::move(sinks)) {}

Telemetry::~Telemetry() { stop(); }

void Telemetry::start() {
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "st-telemetry");
}

void Telemetry::stop() {
  stopping_.store(true, std::memory_order_release);
  if (thread_.joinable()) thread_.join();
}

bool Telemetry::offer(const FrameReport& report) {
  if (ring_.push(report)) return true;
  dropped_.fetch_add(1, std::memory_order_relaxed);
  return false;
}

void Telemetry::wait_for_room() const {
  while (!ring_.has_room()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void Telemetry::drain() {
  bool any = false;
  while (const FrameReport* report = ring_.front()) {
    for (TelemetrySink* sink : sinks_) sink->take(*report);
    ring_.pop();
    any = true;
  }
  if (any)
    for (TelemetrySink* sink : sinks_) sink->flush();
}

void Telemetry::run() {
  for (;;) {
    // Read before the drain: what was pushed before stop() is then seen by this drain or an earlier one.
    const bool last = stopping_.load(std::memory_order_acquire);
    drain();
    if (last) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(kPollMs));
  }
}

}  // namespace st
