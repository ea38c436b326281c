// A short recording to replay: a simulated robot sets off along a circle. Small images, so that it is quickly
// made and replayed in every build.
#pragma once

#include <string>

#include "tests/support/temp_folder.hpp"

namespace st::test {

// Made at the first call in a process, kept until its end.
const std::string& driven_circle();

// The same, and then somebody covers the camera for 40 frames: the robot is lost, but did not leave.
void driven_then_covered(const std::string& folder);

}  // namespace st::test
