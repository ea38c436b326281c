// The file behind SimStateRing: made and written by the simulated robot, read by the simulated Kinect and by
// tests.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/create/sim_state.hpp"

namespace st {

class SimStateWriter {
 public:
  // Creates the file, or empties it. Throws Failure (kBadInput) when it cannot be made.
  explicit SimStateWriter(const std::string& path);
  ~SimStateWriter();
  SimStateWriter(const SimStateWriter&) = delete;
  SimStateWriter& operator=(const SimStateWriter&) = delete;

  void publish(const SimStateEntry& entry);

 private:
  SimStateRing* ring_ = nullptr;
};

class SimStateReader {
 public:
  // Throws Failure (kDeviceFault) when there is no such file, or no simulated robot has written it.
  explicit SimStateReader(const std::string& path);
  ~SimStateReader();
  SimStateReader(const SimStateReader&) = delete;
  SimStateReader& operator=(const SimStateReader&) = delete;

  std::uint64_t written() const;
  // Entry `index`, counted from the first ever written. False when it is not written yet, or no longer there.
  // No heap.
  bool entry(std::uint64_t index, SimStateEntry& out) const;
  // The newest entry; false while there is none. No heap.
  bool newest(SimStateEntry& out) const;

 private:
  const SimStateRing* ring_ = nullptr;
};

}  // namespace st
