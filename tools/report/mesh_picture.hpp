// Pictures of a model, rendered in software: orthographic, with the colours that the camera saw and a soft
// light.
#pragma once

#include "algo/core/mesh.hpp"
#include "algo/core/pose.hpp"
#include "tools/report/png_image.hpp"

namespace st {

// Where to look from: rows of R are the picture's right, up, and towards the viewer, in the mesh's frame.
struct ViewDirection {
  Mat3 R;
};
ViewDirection view_from_above(double forward_yaw_rad);  // forward is up
ViewDirection view_from_front(double forward_yaw_rad);  // the robot looks at the viewer
ViewDirection view_oblique(double forward_yaw_rad);     // from the front left, 30 degrees down
ViewDirection view_of_scene();  // camera frame (y down, z forward), from where it stood

// One scale for several pictures of one mesh: the radius about the middle that must fit.
struct MeshFrame {
  Vec3 middle{};
  double radius_m = 0;
};
MeshFrame frame_of(const MeshView& mesh);

// A square picture on a transparent ground. `pixels` a side.
RgbaImage render_mesh(const MeshView& mesh, const MeshFrame& frame, const ViewDirection& view, int pixels);

}  // namespace st
