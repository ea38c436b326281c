#include "algo/segmentation/segmenter.hpp"

#include <cstring>

#include "algo/segmentation/grow.hpp"

namespace st {
namespace {

constexpr int kGapSteepness = 1;

constexpr std::uint8_t kForegroundBit = 4;  // set in kWeak and kNearer alone
constexpr int kGravityFrames = 64;
constexpr std::uint32_t kFloorRetry_frames = 64;
constexpr int kChangedPixels = 100;  // of the background, before its things are cut anew
constexpr int kCalmFrames = 10, kCalmPixels = 20;
constexpr float kMostChanged = 0.3f;  // share of the view that goes farther at once: the camera was moved
constexpr std::uint32_t kLargeCells = 2048;
constexpr float kRimShare = 0.7f;
constexpr float kWeakShare = 0.85f;    // of a segment: then it must be four times as large
constexpr float kLeastDensity = 0.5f;  // of foreground in its cells: scattered flicker is thinner
constexpr float kFlatBottom_m = -0.05f;

}  // namespace

void Segmenter::bind(Bump& memory, const Calibration& calibration) {
  width_ = calibration.depth.width;
  height_ = calibration.depth.height;
  step_ = grid_step(width_);
  const auto n = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  tables_.bind(memory, calibration);
  background_.bind(memory, width_, height_);
  floor_finder_.bind(memory);
  protos_.bind(memory, width_, height_);
  texture_.bind(memory, width_, height_);
  components_.bind(memory, grid_size(width_, step_), grid_size(height_, step_));
  code_ = memory.take<std::uint16_t>(n);
  stored_ = memory.take<std::uint16_t>(calibration.depth.distorted() ? n : 0);
  rest_ = memory.take<std::uint16_t>(n);
  labels_ = memory.take<std::uint8_t>(n);
}

void Segmenter::configure(const Calibration& calibration, const SegmenterSettings& settings) {
  settings_ = settings;
  tables_.configure(calibration);
  background_.configure(tables_, settings.background);
  protos_.clear();
  texture_.clear();
  std::memset(labels_.data(), 0, labels_.size());
  std::memset(rest_.data(), 0, rest_.size_bytes());
  out_ = {};
  gravity_ = {};
  gravity_frames_ = 0;
  frames_ready_ = 0;
  changed_pixels_ = calm_frames_ = 0;
}

// The mean of the first frames: the sensor stands still, and its noise is far below the 10 degrees that
// matter.
void Segmenter::average_gravity(const FrameInput& frame) {
  if (!frame.has_gravity || gravity_frames_ >= kGravityFrames) return;
  gravity_ += frame.gravity_mps2;
  ++gravity_frames_;
}

const CleanDepth& Segmenter::preprocess(const FrameInput& frame) {
  const ImageView<std::uint16_t> code{code_.data(), width_, height_};
  out_.depth = st::preprocess(tables_, frame.depth, code, {stored_.data(), width_, height_});
  return out_.depth;
}

const Segmentation& Segmenter::segment(const FrameInput& frame, ImageView<const std::uint8_t> owner) {
  out_.labels = {labels_.data(), width_, height_};
  out_.classes = background_.classes();
  out_.segments.clear();
  out_.has_released = out_.restarted = false;
  out_.held_back = out_.refused_runs = 0;
  std::memset(labels_.data(), 0, labels_.size());
  average_gravity(frame);
  if (!background_.ready()) {
    learn();
    return out_;
  }
  background_.update(out_.depth.code, owner, out_.floor);
  if (view_has_changed()) {
    background_.restart();
    protos_.clear();
    texture_.clear();
    out_.floor = {};
    out_.restarted = true;
    out_.background_ready = false;
    return out_;
  }
  update_protos();
  release_moved(frame);
  make_segments();
  return out_;
}

void Segmenter::learn() {
  background_.learn(out_.depth.code);
  out_.background_ready = background_.ready();
  if (out_.background_ready) out_.view = seen_view();
  frames_ready_ = 0;
  changed_pixels_ = kChangedPixels;  // the things in it are still to be found
  calm_frames_ = 0;
}

// Sensors leave margins without readings: outermost rows and columns in which hardly a pixel has a background
// are outside.
Rect Segmenter::seen_view() const {
  const ImageView<const std::uint16_t> mean = background_.code8();
  constexpr int kShare = 20;
  const auto row_seen = [&](int v) {
    int known = 0;
    for (int u = 0; u < width_; ++u) known += mean(u, v) != 0 ? 1 : 0;
    return known * kShare > width_;
  };
  const auto column_seen = [&](int u) {
    int known = 0;
    for (int v = 0; v < height_; ++v) known += mean(u, v) != 0 ? 1 : 0;
    return known * kShare > height_;
  };
  Rect view{0, 0, width_, height_};
  while (!view.empty() && !row_seen(view.v0)) ++view.v0;
  while (!view.empty() && !row_seen(view.v1 - 1)) --view.v1;
  while (!view.empty() && !column_seen(view.u0)) ++view.u0;
  while (!view.empty() && !column_seen(view.u1 - 1)) --view.u1;
  return view;
}

bool Segmenter::view_has_changed() const {
  return static_cast<float>(background_.farther_pixels()) >
         kMostChanged * static_cast<float>(background_.known_pixels());
}

// The floor in the first frame with a background, the things on it in the second: each takes about as long as
// all the rest of a frame. Later they are cut anew when the background has changed and come to rest.
void Segmenter::update_protos() {
  const std::uint32_t frame = frames_ready_++;
  if (!out_.floor.found && frame % kFloorRetry_frames == 0) {
    out_.floor = floor_finder_.find(tables_, background_.code8(), gravity_frames_ > 0, gravity_);
    if (out_.floor.found) changed_pixels_ = kChangedPixels;  // things were cut without it
    return;
  }
  const int changed = background_.absorbed_pixels() + static_cast<int>(background_.revealed().size());
  changed_pixels_ += changed;
  calm_frames_ = changed > kCalmPixels ? 0 : calm_frames_ + 1;
  const bool due = frame == 1 || (changed_pixels_ >= kChangedPixels && calm_frames_ >= kCalmFrames);
  if (!due || protos_.undecided()) return;
  protos_.find(tables_, background_, out_.floor, components_);
  texture_.map(tables_, background_, protos_);
  changed_pixels_ = 0;
}

void Segmenter::release_moved(const FrameInput& frame) {
  const int uncovered = protos_.observe(background_, out_.floor);
  const int turned = texture_.observe(frame, tables_, background_, protos_);
  const int label = uncovered != 0 ? uncovered : turned;
  if (label == 0) return;
  const ImageView<std::uint16_t> rest{rest_.data(), width_, height_};
  out_.released = protos_.release(label, tables_, out_.floor, out_.depth.code, background_, rest);
  out_.released_code = rest;
  out_.has_released = true;
}

void Segmenter::fill_cells(ImageView<std::uint16_t> cells) const {
  const ImageView<const std::uint8_t> classes = background_.classes();
  const ImageView<const std::uint16_t> code = out_.depth.code;
  constexpr std::uint64_t kAnyForeground = 0x0404040404040404u;
  for (int v = 0; v < height_; ++v) {
    const std::uint8_t* kind = classes.row(v);
    const std::uint16_t* q = code.row(v);
    std::uint16_t* out = cells.row(v / step_);
    for (int u = 0; u < width_;) {
      if (u + 8 <= width_) {
        std::uint64_t eight;
        std::memcpy(&eight, kind + u, sizeof eight);
        if ((eight & kAnyForeground) == 0) {
          u += 8;
          continue;
        }
      }
      const int end = u + 8 <= width_ ? u + 8 : width_;
      for (; u < end; ++u)
        if ((kind[u] & kForegroundBit) != 0 && q[u] > out[u / step_]) out[u / step_] = q[u];
    }
  }
}

// Counts every pixel, and measures one in each cell (in every fourth of a large segment).
void Segmenter::add_run(const Components::Run& run, bool large, SegmentSums& sums) const {
  const ImageView<const std::uint8_t> classes = background_.classes(), rim = protos_.rim();
  const int v0 = run.v * step_, v1 = v0 + step_ < height_ ? v0 + step_ : height_;
  sums.cells += run.u1 - run.u0;
  for (int x = run.u0; x < run.u1; ++x) {
    sums.rim_cells += rim(x, run.v) != 0 ? 1 : 0;
    const int u0 = x * step_, u1 = u0 + step_ < width_ ? u0 + step_ : width_;
    int at_u = -1, at_v = -1;
    for (int v = v0; v < v1; ++v) {
      for (int u = u0; u < u1; ++u) {
        const std::uint8_t kind = classes(u, v);
        if ((kind & kForegroundBit) == 0) continue;
        ++sums.pixels;
        sums.unknown += kind == static_cast<std::uint8_t>(PixelClass::kWeak) ? 1 : 0;
        at_u = u, at_v = v;
      }
    }
    sums.box.include(u0, v0);
    sums.box.include(u1 - 1, v1 - 1);
    if (!large || x % 4 == 0) measure(at_u, at_v, sums);
  }
}

void Segmenter::measure(int u, int v, SegmentSums& sums) const {
  const std::uint16_t q = out_.depth.code(u, v);
  const auto z = static_cast<double>(tables_.z_of_code()[q]);
  sums.add(q, {z * static_cast<double>(tables_.ray_x()[static_cast<std::size_t>(u)]),
               z * static_cast<double>(tables_.ray_y()[static_cast<std::size_t>(v)]), z});
  if (out_.has_released && out_.released_code(u, v) != 0) ++sums.released;
  if (out_.floor.found)
    sums.add_height(out_.floor.height_m(static_cast<float>(q), out_.floor.codes.at(u, v)));
}

void Segmenter::paint_run(const Components::Run& run, std::uint8_t label) {
  const ImageView<const std::uint8_t> classes = background_.classes();
  const int v1 = (run.v + 1) * step_ < height_ ? (run.v + 1) * step_ : height_;
  const int u1 = run.u1 * step_ < width_ ? run.u1 * step_ : width_;
  for (int v = run.v * step_; v < v1; ++v)
    for (int u = run.u0 * step_; u < u1; ++u)
      if ((classes(u, v) & kForegroundBit) != 0) labels_[static_cast<std::size_t>(v * width_ + u)] = label;
}

bool Segmenter::is_segment(const SegmentSums& sums, float area_cm2) {
  const float scale = static_cast<float>(width_ * height_) / (640.0f * 480.0f);
  const float least_pixels = static_cast<float>(settings_.least_pixels) * scale;
  if (static_cast<float>(sums.pixels) < (least_pixels > 12.0f ? least_pixels : 12.0f)) return false;
  if (static_cast<float>(sums.pixels) < kLeastDensity * static_cast<float>(sums.cells * step_ * step_))
    return false;
  const bool weak = static_cast<float>(sums.unknown) > kWeakShare * static_cast<float>(sums.pixels);
  if (weak && area_cm2 < 4 * settings_.least_area_cm2) return false;
  if (static_cast<float>(sums.rim_cells) > kRimShare * static_cast<float>(sums.cells)) {
    ++out_.held_back;
    return false;
  }
  return true;
}

void Segmenter::make_segments() {
  fill_cells(components_.begin());
  components_.label(kGapSteepness);
  out_.refused_runs = components_.refused_runs();
  const std::uint64_t least = components_.weighted_of_area(settings_.least_area_cm2, tables_, step_);
  const int count = components_.select(4, least, Components::kMaxSelected);
  for (int i = 0; i < count; ++i) sums_[i] = {};
  for (const Components::Run& run : components_.runs())
    if (const int number = components_.number_of(run); number != 0)
      add_run(run, components_.selected(number).cells > kLargeCells, sums_[number - 1]);
  std::uint8_t label_of_number[Components::kMaxSelected + 1]{};
  for (int number = 1; number <= count; ++number) {
    const float area = components_.area_cm2(number, tables_, step_);
    if (sums_[number - 1].measured == 0 || !is_segment(sums_[number - 1], area)) continue;
    const Segment segment = describe(sums_[number - 1], area, out_.floor.found, out_.view);
    if (segment.has_height && segment.top_m < settings_.least_top_m && segment.bottom_m > kFlatBottom_m)
      continue;
    if (!out_.segments.push_back(segment)) break;
    label_of_number[number] = static_cast<std::uint8_t>(out_.segments.size());
  }
  for (const Components::Run& run : components_.runs())
    if (const std::uint8_t label = label_of_number[components_.number_of(run)]; label != 0)
      paint_run(run, label);
  for (std::size_t i = 0; i < out_.segments.size(); ++i) {
    Segment& segment = out_.segments[i];
    segment.pixels += grow_label(static_cast<std::uint8_t>(i + 1), segment.box, background_, out_.depth.code,
                                 {labels_.data(), width_, height_});
  }
}

}  // namespace st
