// Pose of one object in one frame: all terms in one set of normal equations, Gauss-Newton from coarse to
// fine.
#pragma once

#include <span>

#include "algo/tracking/color_term.hpp"
#include "algo/tracking/color_time.hpp"
#include "algo/tracking/contour_term.hpp"
#include "algo/tracking/depth_term.hpp"
#include "algo/tracking/model_view.hpp"
#include "algo/tracking/normal_equations.hpp"

namespace st {

// What is expected before the frame is looked at: a Gaussian about the predicted pose.
struct MotionPrior {
  Pose mean;                 // T_camera_object
  double information[36]{};  // row-major, camera axes, rotation about the pivot
};

// An object that rests on a plane keeps its height and stays upright: stiff, but finite, so that a lifted one
// shows.
struct FloorPrior {
  bool on = false;
  Vec3 up_camera{};         // unit floor normal, camera frame
  double d = 0;             // up_camera . p + d = 0 on the floor
  Vec3 up_object{0, 0, 1};  // the same direction in the object's frame while it rests
  double height_m = 0;      // of the object's origin above the floor while it rests
  double sigma_height_m = 0.001, sigma_tilt_rad = 0.0015;
};

// The heading that the object's way of driving implies, as a turn about the vertical from prior.mean.
struct HeadingPrior {
  bool on = false;
  double turn_rad = 0, sigma_rad = 0;
};

struct AlignTerms {
  bool contour = true, floor = true, motion = true;
};

struct AlignInput {
  std::span<const ObservedPoint> points;
  ModelView view;                  // rendered at, or near, prior.mean
  ImageView<const float> depth_z;  // whole frame, metres, 0 = none
  Pinhole camera;
  Pose start;  // where to begin; usually prior.mean
  Vec3 pivot;  // camera frame
  MotionPrior prior;
  FloorPrior floor;
  const ColorFrame* color = nullptr;  // null: no colour term
  ColorTime color_time;               // its tie's frame has its z axis up
  HeadingPrior heading;               // counts where terms.motion does, and with a floor
  AlignTerms terms;
  double largest_start_error_m = 0.03;  // sets the coarsest gate
  int point_stride = 1;                 // a late loop looks at fewer points
  int levels = 3;                       // of coarse to fine; fewer for a first look
};

struct AlignResult {
  Pose T_camera_object;
  bool solved = false;
  DepthTermResult depth;  // at the last iteration, all points
  ColorTermResult color;
  ColorGain gain;
  TieRest color_rest;
  Pose color_motion;  // p in the depth image is at color_motion * p in the colour image's time, camera frame
  int contour_used = 0;
  int iterations = 0;
  double covariance[36]{};         // of the pose, all terms; camera axes, rotation about the pivot
  double data_information[36]{};   // depth, contour and colour, as if of the same time
  double shape_information[36]{};  // depth and contour alone
};

// Work memory of align(), owned by the caller.
struct AlignScratch {
  ViewTable view;
  PointTable points, color_points;
  OutlinePoint outline[kMaxContourPoints];
  std::size_t outline_count = 0;
  ContourPoint contour[kMaxContourPoints];

  void bind(Bump& memory, int max_width, int max_height) {
    view.bind(memory, max_width, max_height);
    points.bind(memory);
    color_points.bind(memory);
  }
};

AlignResult align(const AlignInput& input, AlignScratch& scratch);

// The same points beside the same view once more, with another start or prior, or with fewer terms: what
// align() has laid out in `scratch` is used again. A third of the time is spared.
AlignResult align_again(const AlignInput& input, AlignScratch& scratch);

// One-sigma error of the turn about `axis` (camera frame, unit) when everything else is unknown too; huge
// when unseen.
double turn_sigma_rad(const double (&information)[36], const Vec3& axis);

}  // namespace st
