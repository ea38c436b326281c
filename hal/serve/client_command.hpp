// What a client of `run --serve` asks for, on its way from the server's thread to the compute thread.
#pragma once

#include <cstdint>

#include "hal/create/spsc_ring.hpp"

namespace st {

inline constexpr double kClientPatience_s = 0.5;  // without a word from the client, the robot stands

struct ClientCommand {
  std::int64_t monotonic_ns = 0;  // when it came; 0: nobody has asked for anything
  double v_mps = 0, w_rps = 0;
};
using ClientCommands = SpscRing<ClientCommand, 64>;

}  // namespace st
