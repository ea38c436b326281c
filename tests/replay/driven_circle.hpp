// Short recordings to replay: a simulated robot sets off along a circle, a hand scans a room. Small images,
// so that they are quickly made and replayed in every build.
#pragma once

#include <cstddef>
#include <string>

#include "tests/support/temp_folder.hpp"

namespace st::test {

// Made at the first call in a process, kept until its end.
const std::string& driven_circle();

// The same, and then somebody covers the camera for 40 frames: the robot is lost, but did not leave.
void driven_then_covered(const std::string& folder);

// A camera in a hand goes about a robot that stands, with truth.tum: 89 frames. Made once, as above.
const std::string& hand_scan();
// The same with the camera covered from one depth frame to another (not included).
void scan_covered_between(const std::string& folder, std::size_t from, std::size_t to);

}  // namespace st::test
