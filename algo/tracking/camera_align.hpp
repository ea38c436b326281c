// Pose of a hand-held camera in one frame: every pixel of the depth image against the view of the scene,
// projective point-to-plane ICP from coarse to fine (KinectFusion, Newcombe et al. 2011, section 3.5).
#pragma once

#include "algo/depth/pyramid.hpp"
#include "algo/tracking/model_view.hpp"

namespace st {

// What is expected before the frame is looked at: a Gaussian about the view's pose. It holds what the depth
// does not see (a flat wall) and is far too wide to hold anything else.
struct CameraPrior {
  double sigma_m = 0.02, sigma_rad = 0.02;
  bool has_up = false;
  Vec3 up_frame{}, up_view{};  // the accelerometer's up, unit, in the frame's and in the view's camera
  double sigma_up_rad = 0.05;
};

struct CameraAlignInput {
  const DepthPyramid& depth;
  const ModelMaps& view;  // of the whole image
  Pinhole camera;
  Pose start;  // T_view_camera to begin with
  CameraPrior prior;
  double gate_m = 0.1;  // at the coarsest level; halves with each
  int finest = 0;       // level of the pyramid to end with
};

struct CameraAlignResult {
  Pose T_view_camera;
  bool solved = false;
  int pixels = 0;                 // of the finest level that was used
  int readings = 0;               // with depth
  int facing = 0;                 // with a surface of the view before or behind them
  int paired = 0;                 // with one in reach
  int inliers = 0;                // within three sigma
  double rms_m = 0;               // of the inliers
  long pixels_visited = 0;        // over all iterations
  double data_information[36]{};  // of the pose by depth alone; view's camera axes, rotation about its centre
};

CameraAlignResult align_camera(const CameraAlignInput& input);

// Smallest eigenvalue's square root of the information, turned into a length: how far the camera may move, in
// the direction that the depth sees least, until one sigma of evidence says so. Rotations count at
// `distance_m`.
double least_seen_sigma_m(const double (&information)[36], double distance_m);

}  // namespace st
