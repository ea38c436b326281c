#include "algo/recognition/sift3d.hpp"

namespace st {

void Sift3d::bind(Bump& memory, int side) {
  input_.side = side;
  input_.values = memory.take<float>(input_.count());
  space_.bind(memory, side);
  features_ = memory.take<Feature>(kMaxFeatures);
  descriptors_ = memory.take<Descriptor>(kMaxFeatures);
  histogram_ = memory.take<float>(kDescriptorLength);
}

void Sift3d::start(const KeypointLimits& limits) {
  limits_ = limits;
  keypoints_.clear();
  counts_ = {};
  used_ = next_keypoint_ = 0;
  octave_ = level_ = axis_ = 0;
  stage_ = Stage::kBlur;
}

std::size_t Sift3d::keypoints_to_describe() const {
  const auto most = static_cast<std::size_t>(limits_.most_described);
  return keypoints_.size() < most ? keypoints_.size() : most;
}

// The strongest keypoints come first, so that those that find no room are the weakest.
void Sift3d::describe_next() {
  for (std::size_t i = next_keypoint_ + 1; i < keypoints_.size(); ++i) {
    if (!(keypoints_[i].contrast > keypoints_[next_keypoint_].contrast)) continue;
    const Keypoint stronger = keypoints_[i];
    keypoints_[i] = keypoints_[next_keypoint_];
    keypoints_[next_keypoint_] = stronger;
  }
  const Keypoint& keypoint = keypoints_[next_keypoint_];
  const Grid& level = space_.levels[keypoint.octave][keypoint.level];
  Mat3f frames[kMaxOrientations];
  const int count = find_orientations(level, keypoint.voxel, keypoint.sigma, frames);
  for (int i = 0; i < count && used_ < features_.size(); ++i, ++used_) {
    describe(level, keypoint.voxel, keypoint.sigma, frames[i], histogram_);
    features_[used_] = {level.position(keypoint.voxel), keypoint.sigma * level.voxel_m, frames[i],
                        static_cast<int>(next_keypoint_)};
    descriptors_[used_] = to_bytes(histogram_);
  }
  ++next_keypoint_;
}

bool Sift3d::step() {
  switch (stage_) {
    case Stage::kBlur:
      space_.blur_pass(input_, octave_, level_, axis_);
      if (++axis_ < 3) break;
      axis_ = 0;
      if (++level_ < kGaussians) break;
      level_ = 0;
      if (++octave_ < space_.octaves) break;
      octave_ = 0;
      level_ = 1;
      stage_ = Stage::kExtrema;
      break;
    case Stage::kExtrema:
      find_keypoints(space_, octave_, level_, limits_, keypoints_, counts_);
      if (++level_ <= kScalesPerOctave) break;
      level_ = 1;
      if (++octave_ < space_.octaves) break;
      stage_ = keypoints_.empty() ? Stage::kDone : Stage::kDescribe;
      break;
    case Stage::kDescribe:
      if (used_ < features_.size()) describe_next();
      if (next_keypoint_ == keypoints_to_describe() || used_ == features_.size()) stage_ = Stage::kDone;
      break;
    default:
      break;
  }
  return stage_ == Stage::kDone;
}

}  // namespace st
