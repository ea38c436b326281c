// What each pixel sees when nothing is in front of it: one inverse-depth code and a tolerance a pixel,
// learned in a few frames of any scene (nothing needs to be empty) and kept up selectively.
//
//  * what goes away reveals its background, which is learned at once (two frames that agree);
//  * what comes is foreground. Where nobody owns it and it stands still for `absorb_frames`, it becomes
//  background;
//    pixels that a track owns never do;
//  * pixels that flicker between two surfaces (depth edges) get a tolerance that spans both;
//  * slow drift of the sensor is followed by an eighth of a code every fourth frame, on pixels that agree.
#pragma once

#include <cstdint>
#include <span>

#include "algo/core/bump.hpp"
#include "algo/core/fixed_vector.hpp"
#include "algo/core/image.hpp"
#include "algo/depth/depth_tables.hpp"
#include "algo/segmentation/floor.hpp"

namespace st {

// From kWeak on it is foreground.
enum class PixelClass : std::uint8_t {
  kSame = 0,     // the background
  kHole = 1,     // no reading: projector shadow, gloss, edges. Never foreground
  kFarther = 2,  // something went away here
  kFresh = 3,    // a reading where no background is known, not yet to be relied on
  kWeak = 4,     // the same, steady for kWeakFrames
  kNearer = 5,   // in front of the background
};

struct BackgroundSettings {
  int learn_frames = 8;    // at most 15
  int absorb_frames = 90;  // 3 s
  int fresh_frames = 45;   // for a steady reading where no background was known
};

class Background {
 public:
  static constexpr int kUnit = 8;  // background and tolerance are in eighths of a code
  static constexpr int kWeakFrames = 3;
  static constexpr int kMaxRevealed = 32768;

  // A pixel that has just been seen to lie farther than its background, twice in agreement.
  struct Revealed {
    std::uint32_t pixel;
    std::uint16_t before, after;  // background codes in eighths
  };

  void bind(Bump& memory, int width, int height);
  void configure(const DepthTables& tables, const BackgroundSettings& settings = {});

  // Forgets everything and learns anew from the next frame on.
  void restart();
  bool ready() const { return learned_ >= settings_.learn_frames; }
  // One frame of the learning phase.
  void learn(ImageView<const std::uint16_t> code);

  // Classifies a frame and updates the background. `owner`: 0 none, else track slot + 1, of the previous
  // frame; may be empty. `floor` says where a fresh reading is plainly floor.
  void update(ImageView<const std::uint16_t> code, ImageView<const std::uint8_t> owner, const Floor& floor);

  ImageView<const std::uint8_t> classes() const { return view(class_); }  // PixelClass
  ImageView<const std::uint16_t> code8() const { return view(mean_); }    // eighths of a code, 0 unknown
  std::span<const Revealed> revealed() const {
    return {revealed_.data(), revealed_count_};
  }  // in the last update
  std::uint32_t revealed_refused() const { return revealed_refused_; }
  int farther_pixels() const { return farther_; }  // in the last update
  int known_pixels() const { return known_; }
  int absorbed_pixels() const { return absorbed_; }  // in the last update: what stood still, or was new

  // Makes `code8` the background of a pixel from now on and reclassifies it for the current reading. With a
  // tolerance of 0 it is a mere bound: whatever is seen beyond it becomes background at once.
  void expect(int u, int v, std::uint16_t code8, std::uint16_t tolerance, std::uint16_t reading);
  bool is_bound(int u, int v) const { return tolerance_[static_cast<std::size_t>(v * width_ + u)] == 0; }
  // Readings that differ by less are the same, eighths of a code.
  std::uint16_t least_tolerance(std::uint16_t code8) const;

 private:
  template <typename T>
  ImageView<T> view(std::span<T> s) const {
    return {s.data(), width_, height_};
  }
  void learn_other_surface(std::size_t i, std::uint16_t code8);
  void finish_row(std::size_t from);
  void finish_pixel(std::size_t i);
  void visit_row(const std::uint16_t* code, const std::uint8_t* owner, int v, const Floor& floor);
  PixelClass visit_farther(std::size_t i, std::uint16_t code8);
  PixelClass visit_nearer(std::size_t i, std::uint16_t code8, bool owned);
  PixelClass visit_fresh(std::size_t i, std::uint16_t code8, bool owned, bool is_floor);
  bool agrees_with_candidate(std::size_t i, std::uint16_t code8);

  BackgroundSettings settings_;
  int width_ = 0, height_ = 0;
  std::uint16_t step_factor_ = 0;  // least tolerance's growth with the stored step, see least_tolerance()
  int learned_ = 0;
  std::uint32_t frame_ = 0;
  int farther_ = 0, known_ = 0, absorbed_ = 0;
  std::uint32_t revealed_refused_ = 0;
  std::size_t revealed_count_ = 0;
  std::span<std::uint16_t> mean_, tolerance_, candidate_;
  std::span<std::uint8_t> count_;    // frames that agreed with the candidate
  std::span<std::uint8_t> toggles_;  // how often this pixel was revealed lately
  std::span<std::uint8_t> class_;
  std::span<Revealed> revealed_;
};

}  // namespace st
