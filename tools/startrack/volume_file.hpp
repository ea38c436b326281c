// 3-D SIFT of a volume in a file, to compare with other implementations.
#pragma once

#include <string>

namespace st {

// One line per feature on stdout: `keypoint,octave,x,y,z,sigma,contrast,r00,...,r22`; place and scale in
// voxels of the volume, the frame row by row (p_volume = R p_keypoint). `descriptors`: a file to write, or
// empty. Throws Failure (kBadInput) when the file is no such volume.
void print_keypoints(const std::string& volume, const std::string& descriptors);

}  // namespace st
