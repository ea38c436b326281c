// Things that stand on the floor from the first frame on: they are background until they move, and must then
// become one whole segment at once rather than a crescent that grows. So the learned background itself is cut
// into compact things above the floor, and a thing counts as moved when what lies behind it is seen inside
// its outline. A hand that passes in front, or its projector shadow, cannot do that.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/fixed_vector.hpp"
#include "algo/core/image.hpp"
#include "algo/depth/depth_tables.hpp"
#include "algo/segmentation/background.hpp"
#include "algo/segmentation/components.hpp"
#include "algo/segmentation/floor.hpp"

namespace st {

// A thing in the background that has just moved, as it stood before.
struct ReleasedProto {
  Rect box{};  // pixels
  int pixels = 0;
  Vec3f centroid_m{};  // camera frame
  float area_cm2 = 0;  // seen head-on
  float top_m = 0;     // above the floor
};

class Protos {
 public:
  static constexpr int kMax = 24;

  struct Proto {
    Rect box{};  // cells
    int cells = 0;
    float area_cm2 = 0, top_m = 0;
    float evidence_pixels = 0;  // pixels lately revealed inside its outline
  };

  void bind(Bump& memory, int width, int height);
  void clear();

  // Cuts the background anew. `scratch` is overwritten. Without a floor there are none.
  void find(const DepthTables& tables, const Background& background, const Floor& floor, Components& scratch);

  // Weighs the last update's revealed pixels. Returns the label of the thing that has moved most surely, 0
  // for none.
  int observe(const Background& background, const Floor& floor);

  // Takes `label` out of the background: writes what it looked like to `rest` (codes; only inside the
  // returned box, 0 beside the thing), and puts the floor, or what is seen beside it, behind it.
  ReleasedProto release(int label, const DepthTables& tables, const Floor& floor,
                        ImageView<const std::uint16_t> code, Background& background,
                        ImageView<std::uint16_t> rest);

  const FixedVector<Proto, kMax>& all() const { return protos_; }  // label = index + 1
  ImageView<const std::uint8_t> labels() const {
    return {labels_.data(), width_, height_};
  }  // cells of grid_step()
  ImageView<const std::uint8_t> core() const {
    return {core_.data(), width_, height_};
  }  // without the outermost
  // Cells along a thing's outline, within about 6 pixels on either side: slivers there are its own edge
  // moving.
  ImageView<const std::uint8_t> rim() const { return {rim_.data(), width_, height_}; }
  bool undecided() const;  // some thing has evidence, but not enough
  int refused() const { return refused_; }

 private:
  struct Shape {  // of a component while it is judged
    Rect box = Rect::nothing();
    int cells = 0, border_cells = 0, low_cells = 0;
    float top_m = 0, min_x = 1e9f, max_x = -1e9f, min_z = 1e9f, max_z = -1e9f;
  };
  void fill_raised(const Background& background, const Floor& floor, ImageView<std::uint16_t> cells) const;
  void measure_shapes(const DepthTables& tables, const Floor& floor, const Components& scratch);
  bool plausible(const Shape& shape, float area_cm2) const;
  void paint(const Components& scratch);
  void paint_core_and_rim();
  bool belongs(int label, int u, int v, std::uint16_t code8, const Background& background) const;
  std::uint16_t seen_beside(int u, int v, const Rect& box, const Background& background,
                            ImageView<const std::uint16_t> rest) const;
  void put_behind(int u, int v, const Rect& box, const Floor& floor, ImageView<const std::uint16_t> rest,
                  std::uint16_t reading, Background& background) const;
  float threshold(const Proto& proto) const;

  int width_ = 0, height_ = 0, step_ = 1;  // cells
  FixedVector<Proto, kMax> protos_;
  int refused_ = 0;
  std::span<std::uint8_t> labels_, core_, rim_;
  Shape shapes_[Components::kMaxSelected];
  std::uint8_t label_of_number_[Components::kMaxSelected + 1]{};
};

}  // namespace st
