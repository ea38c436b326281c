// From the frame's images to the points that one object is aligned with.
#pragma once

#include <span>

#include "algo/core/calibration.hpp"
#include "algo/tracking/model_view.hpp"

namespace st {

// Colour frame as delivered: RGB, three bytes a pixel.
struct ColorImage {
  ImageView<const std::uint8_t> rgb;  // width = 3 * pixels
  bool empty() const { return rgb.empty(); }
};

// Collects the pixels of `roi` whose owner is `owner` and whose depth is known, thinned evenly so that
// out.size() is never exceeded. Returns how many were written.
std::size_t gather_points(ImageView<const float> depth_z, ImageView<const std::uint8_t> owners,
                          std::uint8_t owner, const Rect& roi, const Pinhole& camera,
                          std::span<ObservedPoint> out);

// The same, of the pixels that may lie on the model as `view` shows it: within 8 cm in depth, and an
// eightieth of the image's width beside it.
std::size_t gather_near_view(ImageView<const float> depth_z, ImageView<const std::uint8_t> owners,
                             std::uint8_t owner, const ModelView& view, const Pinhole& camera,
                             std::span<ObservedPoint> out);

// Pixels of an object near its outline: the sensor's window has drawn it wider than it is. They are the
// object's, but say nothing of its shape.
inline constexpr std::uint8_t kEdge = 254;

// Marks the owner's pixels within the sensor's half window of something much farther or nearer as kEdge.
void mark_edges(ImageView<const float> depth_z, std::uint8_t owner, const Rect& roi,
                ImageView<std::uint8_t> owners);

// Those of the owner's pixels, within a label of the segment image, that mark_edges() would leave.
int count_solid(ImageView<const float> depth_z, ImageView<const std::uint8_t> owners, std::uint8_t owner,
                ImageView<const std::uint8_t> labels, std::uint8_t label, const Rect& roi);

// Projects camera-frame points into the colour image. The object has moved between the two exposures:
// `motion` takes a point from the depth frame's instant to the colour frame's (camera frame).
class ColorRegistration {
 public:
  void configure(const Calibration& calibration);
  // RGB at the point by bilinear interpolation; false outside of the image.
  bool sample(const ColorImage& image, const PoseF& motion, const Vec3f& p, float (&rgb)[3]) const;
  // The same in the direction (x, y, 1) of the colour camera's frame.
  bool sample_pixel(const ColorImage& image, double x, double y, float (&rgb)[3]) const;

  const Intrinsics& camera() const { return color_; }
  const PoseF& T_color_depth() const { return T_color_depth_; }

 private:
  Intrinsics color_;
  PoseF T_color_depth_;
};

// Writes pack_rgb colours (alpha 255; 0 where the colour image does not reach) for the owner's pixels of
// `roi`; others are left as they are.
void register_color(const ColorRegistration& registration, const ColorImage& image, const PoseF& motion,
                    ImageView<const float> depth_z, ImageView<const std::uint8_t> owners, std::uint8_t owner,
                    const Rect& roi, const Pinhole& camera, ImageView<std::uint32_t> color);

}  // namespace st
