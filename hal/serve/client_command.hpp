// What a client of `run --serve` asks for, on its way from the server's thread to the compute thread: the
// newest command alone, since nobody wants an older one obeyed. No lock, no wait, and nothing that can be
// full.
#pragma once

#include <atomic>
#include <bit>
#include <cstdint>

namespace st {

inline constexpr double kClientPatience_s = 0.5;  // without a word from the client, the robot stands

struct ClientCommand {
  std::int64_t monotonic_ns = 0;  // when it came; 0: nobody has asked for anything
  double v_mps = 0, w_rps = 0;

  bool stops() const { return v_mps == 0 && w_rps == 0; }
};

class NewestCommand {
 public:
  // The server's thread.
  void put(const ClientCommand& command) {
    // Time last: whoever reads it finds these speeds or newer ones, never older ones under a newer time.
    speeds_.store(packed(command), std::memory_order_release);
    monotonic_ns_.store(command.monotonic_ns, std::memory_order_release);
    if (command.stops()) stopped_ns_.store(command.monotonic_ns, std::memory_order_release);
  }

  // The compute thread, once a frame. A stop wins: it is what the next frame takes, whatever came after it.
  ClientCommand take() {
    if (const std::int64_t ns = stopped_ns_.exchange(0, std::memory_order_acq_rel); ns != 0)
      return {ns, 0, 0};
    const std::int64_t ns = monotonic_ns_.load(std::memory_order_acquire);
    const Speeds speeds = std::bit_cast<Speeds>(speeds_.load(std::memory_order_acquire));
    return {ns, speeds.v_mps, speeds.w_rps};
  }

 private:
  struct Speeds {  // both change at once
    float v_mps = 0, w_rps = 0;
  };
  static std::uint64_t packed(const ClientCommand& command) {
    return std::bit_cast<std::uint64_t>(
        Speeds{static_cast<float>(command.v_mps), static_cast<float>(command.w_rps)});
  }

  std::atomic<std::uint64_t> speeds_{packed({})};
  std::atomic<std::int64_t> monotonic_ns_{0}, stopped_ns_{0};
};

}  // namespace st
