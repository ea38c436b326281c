// Takes frame reports off the compute thread: a bounded single-producer single-consumer ring, and the thread
// that empties it into sinks (result files, viewer).
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <thread>
#include <vector>

#include "algo/core/bump.hpp"
#include "algo/core/records.hpp"

namespace st {

// One thread pushes, one pops. No heap, no lock, no wait on either side. The memory is the caller's.
class ReportRing {
 public:
  // 17 s at 30 Hz: longer than any stall of a disk that still works.
  static constexpr std::size_t kSlots = 512;

  // Takes its memory and touches all of it, so that the compute thread finds it populated. Also with a
  // measuring Bump.
  void bind(Bump& bump, std::size_t slots = kSlots);

  bool has_room() const;                 // producer
  bool push(const FrameReport& report);  // producer; false when full
  const FrameReport* front() const;      // consumer; null when empty
  void pop();                            // consumer, after front()
  std::size_t high_water() const { return high_water_.load(std::memory_order_relaxed); }
  std::size_t slots() const { return slots_.size(); }

 private:
  std::span<FrameReport> slots_;
  alignas(64) std::atomic<std::uint64_t> pushed_{0};
  std::atomic<std::size_t> high_water_{0};
  alignas(64) std::atomic<std::uint64_t> popped_{0};
};

// Where reports go. Called on the telemetry thread only; may use the heap and block, must not throw.
class TelemetrySink {
 public:
  virtual ~TelemetrySink() = default;
  virtual void take(const FrameReport& report) = 0;
  virtual void flush() = 0;  // after a batch: what was taken becomes visible to other processes
};

class Telemetry {
 public:
  // The longest that a report waits in the ring before it is on its way to the sinks.
  static constexpr int kPollMs = 20;

  Telemetry(ReportRing& ring, std::vector<TelemetrySink*> sinks);
  ~Telemetry();
  Telemetry(const Telemetry&) = delete;
  Telemetry& operator=(const Telemetry&) = delete;

  void start();  // allocates and makes the thread
  void stop();   // hands on everything that was pushed, flushes, ends the thread. Safe to call twice

  // Compute thread. Live: a report that finds the ring full is dropped and counted. No heap, no lock, no
  // wait.
  bool offer(const FrameReport& report);
  // Compute thread of a replay, before it takes the next frame: waits until a report has room, so none is
  // ever dropped.
  void wait_for_room() const;
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  void run();
  void drain();

  ReportRing& ring_;
  std::vector<TelemetrySink*> sinks_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::uint64_t> dropped_{0};
  std::thread thread_;
};

}  // namespace st
