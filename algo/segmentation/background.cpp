#include "algo/segmentation/background.hpp"

#include <cmath>
#include <cstring>

#include "algo/segmentation/background_kernels.hpp"

namespace st {
namespace {

namespace kernels = background_kernels;

constexpr int kDriftPhases = 4;  // rows take turns
constexpr int kRevealFrames = 2;
constexpr std::uint8_t kTogglesOfAnEdge = 2;
constexpr int kMinHits = 2;
constexpr int kMaxCount = 255;
constexpr int kEdgeChanges = 3;
constexpr int kMostLearnFrames = 15;  // counted in four bits
constexpr int kMostTolerance = kernels::kMostTolerance;

int distance(std::uint16_t a, std::uint16_t b) { return a > b ? a - b : b - a; }

// How many more pixels may be skipped after one of class kSame, by eights.
int agreeing_run(const std::uint8_t* kind, int left) {
  int run = 0;
  for (; run + 8 <= left; run += 8) {
    std::uint64_t eight;
    std::memcpy(&eight, kind + run, sizeof eight);
    if (eight != 0) break;
  }
  return run > 0 ? run - 1 : 0;
}

}  // namespace

void Background::bind(Bump& memory, int width, int height) {
  width_ = width;
  height_ = height;
  const auto n = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  mean_ = memory.take<std::uint16_t>(n);
  tolerance_ = memory.take<std::uint16_t>(n);
  candidate_ = memory.take<std::uint16_t>(n);
  count_ = memory.take<std::uint8_t>(n);
  toggles_ = memory.take<std::uint8_t>(n);
  class_ = memory.take<std::uint8_t>(n);
  revealed_ = memory.take<Revealed>(kMaxRevealed);
}

void Background::configure(const DepthTables& tables, const BackgroundSettings& settings) {
  settings_ = settings;
  if (settings_.learn_frames > kMostLearnFrames) settings_.learn_frames = kMostLearnFrames;
  const double factor = 2.0 * kUnit * 1024.0 * 65536.0 * tables.step_per_squared_code();
  step_factor_ = static_cast<std::uint16_t>(factor < 65535.0 ? factor : 65535.0);
  restart();
}

void Background::restart() {
  learned_ = 0;
  frame_ = 0;
  farther_ = known_ = absorbed_ = 0;
  revealed_count_ = 0;
  for (std::size_t i = 0; i < mean_.size(); ++i) {
    mean_[i] = tolerance_[i] = candidate_[i] = 0;
    count_[i] = toggles_[i] = class_[i] = 0;
  }
}

std::uint16_t Background::least_tolerance(std::uint16_t code8) const {
  return kernels::least_tolerance(code8, step_factor_);
}

// While learning, a pixel keeps two surfaces: the first in `mean_` with its spread in `tolerance_`
// (background_kernels::learn), another in `candidate_`, here. `count_` holds the frames of both, four bits
// each.
void Background::learn_other_surface(std::size_t i, std::uint16_t code8) {
  int second = count_[i] >> 4;
  if (second == 0 || distance(code8, candidate_[i]) > 2 * least_tolerance(code8)) {
    candidate_[i] = code8;
    second = 1;
  } else {
    if (second < kMostLearnFrames) ++second;
    candidate_[i] = static_cast<std::uint16_t>(candidate_[i] + (code8 - candidate_[i]) / second);
  }
  count_[i] = static_cast<std::uint8_t>((count_[i] & 15) | second << 4);
  if ((toggles_[i] & 0x80) == 0) toggles_[i] = static_cast<std::uint8_t>((toggles_[i] + 1) | 0x80);
}

void Background::finish_pixel(std::size_t i) {
  const int first = count_[i] & 15, second = count_[i] >> 4, changes = toggles_[i] & 0x7F;
  std::uint16_t mean = mean_[i];
  int tolerance = 2 * tolerance_[i];
  if (second >= 1 && changes >= kEdgeChanges) {  // an edge: the tolerance spans both surfaces
    const int gap = distance(mean, candidate_[i]);
    if (candidate_[i] < mean) mean = candidate_[i];
    tolerance += gap;
  } else if (second >= kMinHits) {
    // Something passed, or stood here for a while: what lies farther was seen beyond it.
    const bool second_is_farther = candidate_[i] < mean;
    if (second_is_farther || second > first) mean = candidate_[i], tolerance = 0;
  }
  if (first + second < kMinHits) mean = 0;
  const int least = least_tolerance(mean) + (tolerance > 0 ? tolerance / 4 : 0);
  if (tolerance < least) tolerance = least;
  mean_[i] = mean;
  tolerance_[i] = static_cast<std::uint16_t>(tolerance < kMostTolerance ? tolerance : kMostTolerance);
  candidate_[i] = 0;
  count_[i] = toggles_[i] = 0;
}

void Background::learn(ImageView<const std::uint16_t> code) {
  const auto weight = static_cast<std::uint16_t>(65535 / (learned_ + 1));
  const bool last = learned_ + 1 >= settings_.learn_frames;
  known_ = 0;
  for (int v = 0; v < height_; ++v) {
    const std::uint16_t* row = code.row(v);
    const auto from = static_cast<std::size_t>(v) * static_cast<std::size_t>(width_);
    std::uint8_t* kind = class_.data() + from;
    kernels::learn(row, mean_.data() + from, tolerance_.data() + from, count_.data() + from,
                   toggles_.data() + from, kind, width_, weight, step_factor_);
    for (int u = 0; u < width_; ++u) {
      if (kind[u] != static_cast<std::uint8_t>(PixelClass::kFarther)) continue;
      learn_other_surface(from + static_cast<std::size_t>(u), static_cast<std::uint16_t>(row[u] * kUnit));
      kind[u] = static_cast<std::uint8_t>(PixelClass::kSame);
    }
    if (last) finish_row(from);
  }
  ++learned_;
}

void Background::finish_row(std::size_t from) {
  for (std::size_t i = from; i < from + static_cast<std::size_t>(width_); ++i) {
    finish_pixel(i);
    known_ += mean_[i] != 0 ? 1 : 0;
  }
}

bool Background::agrees_with_candidate(std::size_t i, std::uint16_t code8) {
  const bool agrees = count_[i] > 0 && distance(code8, candidate_[i]) <= least_tolerance(code8);
  if (!agrees) {
    candidate_[i] = code8;
    count_[i] = 1;
  } else if (count_[i] < kMaxCount) {
    ++count_[i];
  }
  return agrees;
}

PixelClass Background::visit_farther(std::size_t i, std::uint16_t code8) {
  ++farther_;
  agrees_with_candidate(i, code8);
  if (count_[i] < kRevealFrames) return PixelClass::kFarther;
  const std::uint16_t before = mean_[i];
  const auto after = static_cast<std::uint16_t>((candidate_[i] + code8) / 2);
  if (toggles_[i] < 255) ++toggles_[i];
  const int gap = toggles_[i] > kTogglesOfAnEdge ? before - after : 0;
  const int tolerance = least_tolerance(after) * 3 / 2 + gap;
  mean_[i] = after;
  tolerance_[i] = static_cast<std::uint16_t>(tolerance < kMostTolerance ? tolerance : kMostTolerance);
  count_[i] = 0;
  if (revealed_count_ < revealed_.size()) {
    revealed_[revealed_count_++] = {static_cast<std::uint32_t>(i), before, after};
  } else {
    ++revealed_refused_;
  }
  return PixelClass::kFarther;
}

PixelClass Background::visit_nearer(std::size_t i, std::uint16_t code8, bool owned) {
  if (owned) {
    count_[i] = 0;
    return PixelClass::kNearer;
  }
  agrees_with_candidate(i, code8);
  if (count_[i] < settings_.absorb_frames) return PixelClass::kNearer;
  mean_[i] = code8;
  tolerance_[i] = static_cast<std::uint16_t>(least_tolerance(code8) * 3 / 2);
  count_[i] = 0;
  ++absorbed_;
  return PixelClass::kSame;
}

PixelClass Background::visit_fresh(std::size_t i, std::uint16_t code8, bool owned, bool is_floor) {
  agrees_with_candidate(i, code8);
  const bool learn = is_floor ? count_[i] >= kRevealFrames : !owned && count_[i] >= settings_.fresh_frames;
  if (learn) {
    mean_[i] = code8;
    tolerance_[i] = static_cast<std::uint16_t>(least_tolerance(code8) * 3 / 2);
    count_[i] = 0;
    ++known_;
    if (!is_floor) ++absorbed_;
    return PixelClass::kSame;
  }
  return !is_floor && count_[i] >= kWeakFrames ? PixelClass::kWeak : PixelClass::kFresh;
}

void Background::visit_row(const std::uint16_t* code, const std::uint8_t* owner, int v, const Floor& floor) {
  const auto from = static_cast<std::size_t>(v) * static_cast<std::size_t>(width_);
  std::uint8_t* kind = class_.data() + from;
  for (int u = 0; u < width_; ++u) {
    const auto c = static_cast<PixelClass>(kind[u]);
    const std::size_t i = from + static_cast<std::size_t>(u);
    if (c == PixelClass::kSame) {
      u += agreeing_run(kind + u, width_ - u);
      continue;
    }
    if (c == PixelClass::kHole) {
      if (mean_[i] == 0) count_[i] = 0;  // where no background is known, only steady readings count
      continue;
    }
    const auto code8 = static_cast<std::uint16_t>(code[u] * kUnit);
    const bool owned = owner[u] != 0;
    PixelClass now = c;
    if (c == PixelClass::kFarther) {
      now = visit_farther(i, code8);
    } else if (c == PixelClass::kNearer) {
      now = visit_nearer(i, code8, owned);
    } else {
      const float off = std::fabs(static_cast<float>(code8) - floor.codes.at(u, v) * kUnit);
      now = visit_fresh(i, code8, owned,
                        floor.found && off <= 1.5f * static_cast<float>(least_tolerance(code8)));
    }
    kind[u] = static_cast<std::uint8_t>(now);
  }
}

void Background::update(ImageView<const std::uint16_t> code, ImageView<const std::uint8_t> owner,
                        const Floor& floor) {
  static constexpr std::uint8_t kNobody[kMaxWidth]{};
  farther_ = absorbed_ = 0;
  revealed_count_ = 0;
  ++frame_;
  for (int v = 0; v < height_; ++v) {
    const std::uint16_t* row = code.row(v);
    const std::uint8_t* owners = owner.empty() ? kNobody : owner.row(v);
    const auto from = static_cast<std::size_t>(v) * static_cast<std::size_t>(width_);
    kernels::classify(row, mean_.data() + from, tolerance_.data() + from, class_.data() + from, width_);
    if ((static_cast<std::uint32_t>(v) + frame_) % kDriftPhases == 0)
      kernels::drift(row, class_.data() + from, owners, mean_.data() + from, tolerance_.data() + from, width_,
                     step_factor_);
    visit_row(row, owners, v, floor);
  }
  // An edge is what toggles again and again: one toggle a pixel is forgotten each 16 s (at 480 rows).
  const auto row = static_cast<std::size_t>(frame_ % static_cast<std::uint32_t>(height_)) *
                   static_cast<std::size_t>(width_);
  for (std::size_t i = row; i < row + static_cast<std::size_t>(width_); ++i)
    toggles_[i] = static_cast<std::uint8_t>(toggles_[i] - (toggles_[i] > 0 ? 1 : 0));
}

void Background::expect(int u, int v, std::uint16_t code8, std::uint16_t tolerance, std::uint16_t reading) {
  const auto i = static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u);
  mean_[i] = code8;
  tolerance_[i] = tolerance;
  candidate_[i] = 0;
  count_[i] = toggles_[i] = 0;
  const int code = reading * kUnit;
  const PixelClass now = reading == 0               ? PixelClass::kHole
                         : code > code8 + tolerance ? PixelClass::kNearer
                         : code + tolerance < code8 ? PixelClass::kFarther
                                                    : PixelClass::kSame;
  class_[i] = static_cast<std::uint8_t>(now);
}

}  // namespace st
