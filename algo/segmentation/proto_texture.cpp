#include "algo/segmentation/proto_texture.hpp"

#include <cmath>
#include <cstring>

namespace st {
namespace {

constexpr int kReferenceFrames = 4;
constexpr std::uint16_t kUnknown = 0xFFFF;
constexpr std::uint32_t kNowhere = 0xFFFFFFFFu;
constexpr int kApart = 2;             // cells between the two sides of an edge
constexpr float kStrongEdge = 0.15f;  // (a - b) / (a + b): several times the colour noise of a Kinect
constexpr float kLostShare = 0.7f;    // of an edge's strength
constexpr int kLeastEdges = 24;
constexpr float kMovedShare = 0.4f;  // of a thing's edges
constexpr std::uint8_t kStreak = 3;
constexpr float kDark = 16.0f;  // keeps noise in the dark from looking like edges

float edge(float a, float b) { return (a - b) / (a + b + kDark); }

}  // namespace

void ProtoTexture::bind(Bump& memory, int width, int height) {
  step_ = grid_step(width);
  width_ = grid_size(width, step_);
  height_ = grid_size(height, step_);
  const auto n = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  byte_ = memory.take<std::uint32_t>(n);
  reference_ = memory.take<std::uint16_t>(n);
  edges_ = memory.take<Edge>(kMaxEdges);
}

void ProtoTexture::clear() {
  mapped_ = false;
  edge_count_ = 0;
  reference_frames_ = 0;
  std::memset(byte_.data(), 0xFF, byte_.size_bytes());
  std::memset(reference_.data(), 0, reference_.size_bytes());
  std::memset(edges_of_, 0, sizeof edges_of_);
  std::memset(streak_, 0, sizeof streak_);
}

void ProtoTexture::map(const DepthTables& tables, const Background& background, const Protos& protos) {
  clear();
  const Calibration& calibration = tables.calibration();
  if (!calibration.has_color && !calibration.color_registered) return;
  const Intrinsics& camera = calibration.color_registered ? calibration.depth : calibration.color;
  const Pose T = calibration.color_registered ? Pose{} : calibration.T_color_depth;
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (protos.core()(x, y) == 0) continue;
      const int u = x * step_, v = y * step_;
      const auto z = static_cast<double>(
          tables.z_of_code()[static_cast<std::size_t>(background.code8()(u, v) / Background::kUnit)]);
      const Vec3 p = T * Vec3{static_cast<double>(tables.ray_x()[static_cast<std::size_t>(u)]) * z,
                              static_cast<double>(tables.ray_y()[static_cast<std::size_t>(v)]) * z, z};
      if (!(p.z > 0.1)) continue;
      const Normalized at = distort(camera, {p.x / p.z, p.y / p.z});
      const double cu = std::floor(at.x * camera.fx + camera.cx + 0.5),
                   cv = std::floor(at.y * camera.fy + camera.cy + 0.5);
      if (!(cu >= 0 && cv >= 0 && cu < camera.width && cv < camera.height)) continue;
      const int pixel = static_cast<int>(cv) * camera.width + static_cast<int>(cu);
      byte_[static_cast<std::size_t>(y * width_ + x)] = static_cast<std::uint32_t>(3 * pixel);
      mapped_ = true;
    }
  }
}

// 1-251; 0 where something hides the cell, or it is overexposed.
std::uint8_t ProtoTexture::brightness(const FrameInput& frame, const Background& background,
                                      std::uint32_t cell) const {
  const int u = static_cast<int>(cell) % width_ * step_, v = static_cast<int>(cell) / width_ * step_;
  if (background.classes()(u, v) > static_cast<std::uint8_t>(PixelClass::kHole)) return 0;
  const std::uint8_t* rgb = frame.color.data + byte_[cell];
  const int value = (rgb[0] + 2 * rgb[1] + rgb[2]) / 4;
  return static_cast<std::uint8_t>(value > 250 ? 0 : value + 1);
}

void ProtoTexture::add_to_reference(const FrameInput& frame, const Background& background) {
  for (std::uint32_t cell = 0; cell < byte_.size(); ++cell) {
    if (byte_[cell] == kNowhere || reference_[cell] == kUnknown) continue;
    const std::uint8_t now = brightness(frame, background, cell);
    reference_[cell] = now != 0 ? static_cast<std::uint16_t>(reference_[cell] + now) : kUnknown;
  }
  ++reference_frames_;
}

void ProtoTexture::collect_edge(std::uint32_t cell, std::uint32_t beside, const Protos& protos) {
  const std::uint8_t label = protos.core().data[cell];
  if (byte_[beside] == kNowhere || reference_[beside] == kUnknown || protos.core().data[beside] != label)
    return;
  const float before = edge(static_cast<float>(reference_[cell]) / kReferenceFrames,
                            static_cast<float>(reference_[beside]) / kReferenceFrames);
  if (std::fabs(before) < kStrongEdge || edge_count_ >= edges_.size() || edges_of_[label] >= kMaxEdgesOfOne)
    return;
  edges_[edge_count_++] = {{cell, beside}, before, label};
  ++edges_of_[label];
}

void ProtoTexture::collect_edges(const Protos& protos) {
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto cell = static_cast<std::uint32_t>(y * width_ + x);
      if (byte_[cell] == kNowhere || reference_[cell] == kUnknown || protos.core().data[cell] == 0) continue;
      if (x + kApart < width_) collect_edge(cell, cell + kApart, protos);
      if (y + kApart < height_)
        collect_edge(cell, cell + static_cast<std::uint32_t>(kApart * width_), protos);
    }
  }
}

int ProtoTexture::observe(const FrameInput& frame, const DepthTables& tables, const Background& background,
                          const Protos& protos) {
  const Calibration& calibration = tables.calibration();
  const Intrinsics& camera = calibration.color_registered ? calibration.depth : calibration.color;
  if (!mapped_ || !frame.color_is_new || frame.color.width != 3 * camera.width ||
      frame.color.height != camera.height)
    return 0;
  if (reference_frames_ < kReferenceFrames) {
    add_to_reference(frame, background);
    if (reference_frames_ == kReferenceFrames) collect_edges(protos);
    return 0;
  }
  int seen[Protos::kMax + 1]{}, lost[Protos::kMax + 1]{};
  for (std::size_t i = 0; i < edge_count_; ++i) {
    const Edge& e = edges_[i];
    if (protos.core().data[e.cell[0]] != e.label) continue;  // released meanwhile
    const std::uint8_t a = brightness(frame, background, e.cell[0]),
                       b = brightness(frame, background, e.cell[1]);
    if (a == 0 || b == 0) continue;
    const float after = edge(static_cast<float>(a), static_cast<float>(b));
    ++seen[e.label];
    lost[e.label] += std::fabs(after - e.before) > kLostShare * std::fabs(e.before) ? 1 : 0;
  }
  int moved = 0;
  for (int label = 1; label <= Protos::kMax; ++label) {
    const bool changed = seen[label] >= kLeastEdges &&
                         static_cast<float>(lost[label]) > kMovedShare * static_cast<float>(seen[label]);
    streak_[label] = changed
                         ? static_cast<std::uint8_t>(streak_[label] < kStreak ? streak_[label] + 1 : kStreak)
                         : std::uint8_t{0};
    if (moved == 0 && streak_[label] >= kStreak) moved = label;
  }
  return moved;
}

}  // namespace st
