// camera.toml: what is known about a camera, as a file. The keys are those of the contract; any other is
// refused with its line.
#pragma once

#include <string>
#include <string_view>

#include "algo/core/calibration.hpp"

namespace st {

// The calibration of a recording that brings no camera.toml, and of the keys that a camera.toml leaves out.
enum class CameraKind { kKinect, kTum };
Calibration default_calibration(CameraKind kind);

// The encoding follows from the kind. `name` is what errors call the file. Throws Failure (kBadInput).
Calibration parse_camera_toml(std::string_view text, const std::string& name, CameraKind kind);
Calibration read_camera_file(const std::string& path, CameraKind kind);

std::string format_camera_toml(const Calibration& calibration);

}  // namespace st
