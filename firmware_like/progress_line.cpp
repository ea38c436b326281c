#include "firmware_like/progress_line.hpp"

#include <cstdio>

namespace st {

ProgressLine::~ProgressLine() {
  if (frames_ > 0) std::fputc('\n', stderr);
}

void ProgressLine::take(const FrameReport& report) {
  ++frames_;
  scanning_ = report.has_camera;
  camera_ = report.camera.state;
  tracked_ = 0;
  for (const ObjectSample& object : report.objects) tracked_ += object.in_tum ? 1 : 0;
}

void ProgressLine::flush() {
  std::fprintf(stderr, "\rframe %llu", static_cast<unsigned long long>(frames_));
  if (expected_ > 0) std::fprintf(stderr, " of %llu", static_cast<unsigned long long>(expected_));
  if (scanning_)
    std::fprintf(stderr, ", camera %s ", name_of(camera_));
  else
    std::fprintf(stderr, ", %d object(s) tracked ", tracked_);
}

}  // namespace st
