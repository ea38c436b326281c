// What `startrack doctor` looks at. Everything is read below `root` ("" for the real machine), so that tests
// can lay out a machine of their own.
#pragma once

#include <string>
#include <vector>

namespace st {

struct Finding {
  enum class Level { kOk, kWarn, kFail };
  Level level = Level::kOk;
  std::string check;     // a word or two; the same word for the same question on every machine
  std::string found;     // one line
  std::string remedy{};  // what to do; empty for kOk
};

// The Kinect (present, fed, fast enough, permitted) and the robot's serial port.
std::vector<Finding> check_devices(const std::string& root);

// The settings of this machine that the loop's timing rests on, read without trying anything.
std::vector<Finding> check_settings(const std::string& root);

// What only trying shows: locking memory, huge pages, real-time priority, the vector units, and how fast
// `folder` takes a recording. Takes a second or two and up to 64 MiB of memory and of disk, which it gives
// back.
std::vector<Finding> try_machine(const std::string& folder);

}  // namespace st
