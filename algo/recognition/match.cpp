#include "algo/recognition/match.hpp"

#include "algo/recognition/match_kernel.hpp"

namespace st {
namespace {

constexpr std::uint32_t kFarthest = 0xffffffffu;

}  // namespace

void Matcher::bind(Bump& memory) {
  of_a_ = memory.take<Nearest>(kMaxFeatures);
  of_b_ = memory.take<Nearest>(kMaxFeatures);
}

void Matcher::start(const FeatureSet& a, const FeatureSet& b) {
  a_ = a;
  b_ = b;
  next_ = 0;
  for (Nearest& nearest : of_a_) nearest = {-1, kFarthest, kFarthest};
  for (Nearest& nearest : of_b_) nearest = {-1, kFarthest, kFarthest};
}

// The same keypoint in another frame, or one that lies within a sigma of it, is no rival.
void Matcher::Nearest::see(int other, std::uint32_t d, std::span<const Feature> others) {
  const Feature& seen = others[static_cast<std::size_t>(other)];
  const auto one_place = [&](const Feature& kept) {
    return kept.keypoint == seen.keypoint || norm(kept.p_m - seen.p_m) < seen.sigma_m;
  };
  const bool same = feature >= 0 && one_place(others[static_cast<std::size_t>(feature)]);
  if (d < distance) {
    if (!same) next = distance;
    distance = d;
    feature = other;
  } else if (d < next && !same) {
    next = d;
  }
}

bool Matcher::Nearest::is_clear(float ratio) const {
  return static_cast<float>(distance) < ratio * ratio * static_cast<float>(next);
}

bool Matcher::step() {
  if (next_ < a_.features.size()) {
    const int i = static_cast<int>(next_);
    for (std::size_t j = 0; j < b_.features.size(); ++j) {
      const std::uint32_t d =
          squared_distance(a_.descriptors[next_].bytes, b_.descriptors[j].bytes, kDescriptorLength);
      of_a_[next_].see(static_cast<int>(j), d, b_.features);
      of_b_[j].see(i, d, a_.features);
    }
    ++next_;
  }
  return next_ >= a_.features.size();
}

void Matcher::finish(float ratio, Matches& matches) const {
  matches.clear();
  for (std::size_t i = 0; i < a_.features.size(); ++i) {
    const Nearest& forth = of_a_[i];
    if (forth.feature < 0 || !forth.is_clear(ratio)) continue;
    const Nearest& back = of_b_[static_cast<std::size_t>(forth.feature)];
    if (back.feature == static_cast<int>(i) && back.is_clear(ratio))
      matches.push_back({static_cast<int>(i), forth.feature, forth.distance});
  }
}

}  // namespace st
