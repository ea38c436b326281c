#include "algo/segmentation/protos.hpp"

#include <cstring>

namespace st {
namespace {

constexpr int kGapSteepness = 1;
constexpr float kLeastHeight_m = 0.02f;
constexpr float kNoiseCodes = 10.0f;  // of a learned background about its floor
constexpr float kMostHeight_m = 1.5f;
constexpr float kFootHeight_m = 0.10f;  // a thing that stands has something below this
constexpr float kLeastSide_m = 0.05f, kMostSide_m = 1.2f;
constexpr float kLeastArea_cm2 = 15.0f;
constexpr int kLeastCells = 16;
constexpr int kRing = 3;  // cells
constexpr float kLeastEvidence_pixels = 12.0f;
constexpr float kEvidenceShare = 0.015f;
constexpr float kEvidenceKept = 15.0f / 16.0f;  // a frame: slow motion adds up, stray pixels do not
constexpr int kUnit = Background::kUnit;

std::uint16_t floor_code8(const Floor& floor, int u, int v) {
  const float code8 = floor.codes.at(u, v) * kUnit;
  return code8 > 0 ? static_cast<std::uint16_t>(code8 < 65535.0f ? code8 : 65535.0f) : std::uint16_t{0};
}

// Cells of `label` within `reach` of (x, y), itself included.
int count_near(ImageView<const std::uint8_t> mask, int x, int y, int reach, int label) {
  const Rect near = Rect{x - reach, y - reach, x + reach + 1, y + reach + 1}.clipped(mask.width, mask.height);
  int count = 0;
  for (int j = near.v0; j < near.v1; ++j)
    for (int i = near.u0; i < near.u1; ++i) count += mask(i, j) == label ? 1 : 0;
  return count;
}

}  // namespace

void Protos::bind(Bump& memory, int width, int height) {
  step_ = grid_step(width);
  width_ = grid_size(width, step_);
  height_ = grid_size(height, step_);
  const auto n = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  labels_ = memory.take<std::uint8_t>(n);
  core_ = memory.take<std::uint8_t>(n);
  rim_ = memory.take<std::uint8_t>(n);
}

void Protos::clear() {
  protos_.clear();
  std::memset(labels_.data(), 0, labels_.size());
  std::memset(core_.data(), 0, core_.size());
  std::memset(rim_.data(), 0, rim_.size());
}

// Cells whose background is above the floor by more than its noise.
void Protos::fill_raised(const Background& background, const Floor& floor,
                         ImageView<std::uint16_t> cells) const {
  const ImageView<const std::uint16_t> mean = background.code8();
  for (int y = 0; y < height_; ++y) {
    const std::uint16_t* row = mean.row(y * step_);
    for (int x = 0; x < width_; ++x) {
      const std::uint16_t code8 = row[x * step_];
      if (code8 == 0 || background.is_bound(x * step_, y * step_)) continue;
      const float q = static_cast<float>(code8) * (1.0f / kUnit),
                  plane = floor.codes.at(x * step_, y * step_);
      const float height = floor.height_m(q, plane);
      if (q - plane > kNoiseCodes && height > kLeastHeight_m && height < kMostHeight_m)
        cells(x, y) = static_cast<std::uint16_t>(code8 / kUnit);
    }
  }
}

void Protos::measure_shapes(const DepthTables& tables, const Floor& floor, const Components& scratch) {
  for (Shape& shape : shapes_) shape = {};
  const auto cells = scratch.cells();
  for (const Components::Run& run : scratch.runs()) {
    const int number = scratch.number_of(run);
    if (number == 0) continue;
    Shape& shape = shapes_[number - 1];
    for (int x = run.u0; x < run.u1; ++x) {
      const int u = x * step_, v = run.v * step_;
      const std::uint16_t q = cells(x, run.v);
      const float z = tables.z_of_code()[q];
      const float height = floor.height_m(static_cast<float>(q), floor.codes.at(u, v));
      const float across = z * tables.ray_x()[static_cast<std::size_t>(u)];
      shape.box.include(x, run.v);
      ++shape.cells;
      if (x == 0 || run.v == 0 || x == width_ - 1 || run.v == height_ - 1) ++shape.border_cells;
      if (height < kFootHeight_m) ++shape.low_cells;
      if (height > shape.top_m) shape.top_m = height;
      if (across < shape.min_x) shape.min_x = across;
      if (across > shape.max_x) shape.max_x = across;
      if (z < shape.min_z) shape.min_z = z;
      if (z > shape.max_z) shape.max_z = z;
    }
  }
}

bool Protos::plausible(const Shape& shape, float area_cm2) const {
  const float wide = shape.max_x - shape.min_x, deep = shape.max_z - shape.min_z;
  const float longest = wide > deep ? wide : deep;
  const int sides = shape.box.width() + shape.box.height();
  return area_cm2 >= kLeastArea_cm2 && longest >= kLeastSide_m && longest <= kMostSide_m &&
         shape.low_cells > 0 && shape.border_cells * 4 <= sides;
}

void Protos::paint(const Components& scratch) {
  for (const Components::Run& run : scratch.runs()) {
    const std::uint8_t label = label_of_number_[scratch.number_of(run)];
    if (label == 0) continue;
    std::memset(labels_.data() + run.v * width_ + run.u0, label, static_cast<std::size_t>(run.u1 - run.u0));
  }
}

void Protos::paint_core_and_rim() {
  const ImageView<const std::uint8_t> mask = labels();
  for (std::size_t p = 0; p < protos_.size(); ++p) {
    const auto label = static_cast<std::uint8_t>(p + 1);
    const Rect around = protos_[p].box.grown(kRing).clipped(width_, height_);
    for (int y = around.v0; y < around.v1; ++y) {
      for (int x = around.u0; x < around.u1; ++x) {
        const auto cell = static_cast<std::size_t>(y * width_ + x);
        const bool inside = labels_[cell] == label;
        if (!inside && labels_[cell] != 0) continue;
        if (inside && count_near(mask, x, y, 1, label) == 9) core_[cell] = label;
        const int same = count_near(mask, x, y, kRing, label);
        constexpr int kAllOfRing = (2 * kRing + 1) * (2 * kRing + 1);
        if (same > 0 && same < kAllOfRing) rim_[cell] = label;
      }
    }
  }
}

void Protos::find(const DepthTables& tables, const Background& background, const Floor& floor,
                  Components& scratch) {
  clear();
  if (!floor.found) return;
  fill_raised(background, floor, scratch.begin());
  scratch.label(kGapSteepness);
  const int count = scratch.select(kLeastCells, 0, Components::kMaxSelected);
  measure_shapes(tables, floor, scratch);
  label_of_number_[0] = 0;
  for (int number = 1; number <= count; ++number) {
    label_of_number_[number] = 0;
    const Shape& shape = shapes_[number - 1];
    const float area = scratch.area_cm2(number, tables, step_);
    if (!plausible(shape, area)) continue;
    if (!protos_.push_back({shape.box, shape.cells, area, shape.top_m, 0})) continue;
    label_of_number_[number] = static_cast<std::uint8_t>(protos_.size());
  }
  refused_ = static_cast<int>(protos_.refused());
  paint(scratch);
  paint_core_and_rim();
}

float Protos::threshold(const Proto& proto) const {
  const float share = kEvidenceShare * static_cast<float>(proto.cells * step_ * step_);
  return share > kLeastEvidence_pixels ? share : kLeastEvidence_pixels;
}

int Protos::observe(const Background& background, const Floor& floor) {
  if (protos_.empty()) return 0;
  for (Proto& proto : protos_) proto.evidence_pixels *= kEvidenceKept;
  const int pixels_across = background.code8().width;
  for (const Background::Revealed& r : background.revealed()) {
    const int u = static_cast<int>(r.pixel) % pixels_across, v = static_cast<int>(r.pixel) / pixels_across;
    const int label = core_[static_cast<std::size_t>((v / step_) * width_ + u / step_)];
    if (label == 0) continue;
    // Behind a thing lies the floor or what is farther than it: a small step back is the thing's own flicker.
    const int drop = r.before - r.after, to_floor = r.before - floor_code8(floor, u, v);
    if (2 * drop >= to_floor) protos_[static_cast<std::size_t>(label - 1)].evidence_pixels += 1.0f;
  }
  int best = 0;
  float best_ratio = 1.0f;
  for (std::size_t p = 0; p < protos_.size(); ++p) {
    const float ratio = protos_[p].evidence_pixels / threshold(protos_[p]);
    if (protos_[p].cells > 0 && ratio >= best_ratio) best = static_cast<int>(p) + 1, best_ratio = ratio;
  }
  return best;
}

bool Protos::undecided() const {
  for (const Proto& proto : protos_)
    if (proto.evidence_pixels > 0.25f * threshold(proto)) return true;
  return false;
}

// A pixel of the thing itself, or of its foot and rim that were too low or too thin to be labelled: above the
// floor and continuous in depth with a labelled cell nearby.
bool Protos::belongs(int label, int u, int v, std::uint16_t code8, const Background& background) const {
  const int x = u / step_, y = v / step_;
  const ImageView<const std::uint8_t> mask = labels();
  if (mask(x, y) == label) return true;
  if (mask(x, y) != 0) return false;
  const Rect near = Rect{x - kRing, y - kRing, x + kRing + 1, y + kRing + 1}.clipped(width_, height_);
  for (int j = near.v0; j < near.v1; ++j)
    for (int i = near.u0; i < near.u1; ++i)
      if (mask(i, j) == label && Components::together(background.code8()(i * step_, j * step_) / kUnit,
                                                      code8 / kUnit, kGapSteepness))
        return true;
  return false;
}

// The nearest background left and right of the thing in this row, whichever is farther; 0 when neither is
// known.
std::uint16_t Protos::seen_beside(int u, int v, const Rect& box, const Background& background,
                                  ImageView<const std::uint16_t> rest) const {
  const ImageView<const std::uint16_t> mean = background.code8();
  const int margin = 2 * step_;
  std::uint16_t left = 0, right = 0;
  for (int i = u - 1; i >= box.u0 - margin && i >= 0 && left == 0; --i)
    if ((i < box.u0 || rest(i, v) == 0) && u - i > margin) left = mean(i, v);
  for (int i = u + 1; i < box.u1 + margin && i < mean.width && right == 0; ++i)
    if ((i >= box.u1 || rest(i, v) == 0) && i - u > margin) right = mean(i, v);
  return left == 0 ? right : right == 0 ? left : left < right ? left : right;
}

// Where the floor is seen beside the thing, the floor is behind it. Elsewhere half-way to what is seen beside
// it, or to the floor: nearer than that is the thing, farther is learned as soon as it is seen.
void Protos::put_behind(int u, int v, const Rect& box, const Floor& floor,
                        ImageView<const std::uint16_t> rest, std::uint16_t reading,
                        Background& background) const {
  const std::uint16_t plane = floor_code8(floor, u, v), beside = seen_beside(u, v, box, background, rest);
  const int apart = beside > plane ? beside - plane : plane - beside;
  if (plane > 0 && apart <= 2 * background.least_tolerance(plane)) {
    background.expect(u, v, plane, background.least_tolerance(plane), reading);
    return;
  }
  const int front = background.code8()(u, v), behind = beside > plane ? beside : plane;
  const int between = behind < front ? (front + behind) / 2 : front - static_cast<int>(kNoiseCodes) * kUnit;
  background.expect(u, v, static_cast<std::uint16_t>(between > 1 ? between : 1), 0, reading);
}

ReleasedProto Protos::release(int label, const DepthTables& tables, const Floor& floor,
                              ImageView<const std::uint16_t> code, Background& background,
                              ImageView<std::uint16_t> rest) {
  const auto at = static_cast<std::size_t>(label - 1);
  Proto& proto = protos_[at];
  const Rect cells = proto.box.grown(kRing);
  ReleasedProto out;
  out.area_cm2 = proto.area_cm2;
  out.top_m = proto.top_m;
  out.box = Rect{cells.u0 * step_, cells.v0 * step_, cells.u1 * step_, cells.v1 * step_}.clipped(code.width,
                                                                                                 code.height);
  const ImageView<const std::uint16_t> mean = background.code8();
  Vec3 sum{};
  for (int v = out.box.v0; v < out.box.v1; ++v) {
    for (int u = out.box.u0; u < out.box.u1; ++u) {
      const std::uint16_t code8 = mean(u, v);
      rest(u, v) = 0;
      if (code8 <= floor_code8(floor, u, v) + kNoiseCodes * kUnit || !belongs(label, u, v, code8, background))
        continue;
      const auto q = static_cast<std::uint16_t>((code8 + kUnit / 2) / kUnit);
      rest(u, v) = q;
      const auto z = static_cast<double>(tables.z_of_code()[q]);
      sum += Vec3{static_cast<double>(tables.ray_x()[static_cast<std::size_t>(u)]) * z,
                  static_cast<double>(tables.ray_y()[static_cast<std::size_t>(v)]) * z, z};
      ++out.pixels;
    }
  }
  if (out.pixels > 0) out.centroid_m = to_float(sum * (1.0 / out.pixels));
  for (int v = out.box.v0; v < out.box.v1; ++v)
    for (int u = out.box.u0; u < out.box.u1; ++u)
      if (rest(u, v) != 0) put_behind(u, v, out.box, floor, rest, code(u, v), background);
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    if (labels_[i] == label) labels_[i] = 0;
    if (core_[i] == label) core_[i] = 0;
    if (rim_[i] == label) rim_[i] = 0;
  }
  proto.cells = 0;
  proto.evidence_pixels = 0;
  return out;
}

}  // namespace st
