// Whether a known model, where it was put, agrees with the frame everywhere and not only on the whole: two
// things that differ in one knob or one label agree in nine tenths of their surface.
#pragma once

#include "algo/tracking/model_view.hpp"

namespace st {

struct PatchInput {
  const ModelView* view = nullptr;  // the model at the pose in question
  Pinhole camera;
  ImageView<const float> depth_z;  // metres; 0: none
  ImageView<const std::uint8_t> owners;
  std::uint8_t owner = 0;                // of the object's pixels
  ImageView<const std::uint32_t> color;  // of the object's pixels, pack_rgb; empty: none
  float skirt_z_m = 0;  // what lies lower (object frame) is not looked at: floor that hangs on to the object
};

// Patches of about 3 cm of the surface.
struct PatchCheck {
  int shape = 0, shape_off = 0;  // with depth; of these such that most of it contradicts the model
  int print = 0, print_off = 0;  // with colour; of these such that its colour is clearly another one

  PatchCheck& operator+=(const PatchCheck& more) {
    shape += more.shape, shape_off += more.shape_off, print += more.print, print_off += more.print_off;
    return *this;
  }
  // In any light, and allowing for the seams where a patch holds two surfaces.
  bool agrees() const;
  // Whether the other one is contradicted where this one is not.
  bool refutes(const PatchCheck& other) const;
};
PatchCheck check_patches(const PatchInput& in);

}  // namespace st
