// Depth images of real recordings, for tests that need them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace st::test {

// The folder of recordings: the environment's STARTRACK_DATA, else ../shared/data beside the source tree.
std::string data_folder();

// A 16-bit grey PNG of this size, row by row. Empty when it cannot be read or is another.
std::vector<std::uint16_t> read_depth_png(const std::string& path, int width, int height);

}  // namespace st::test
