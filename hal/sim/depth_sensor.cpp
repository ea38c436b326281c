#include "hal/sim/depth_sensor.hpp"

#include <algorithm>
#include <cmath>

namespace st::sim {
namespace {

constexpr int kPatternPad = 128;    // pattern columns left of the image: the shift at the shortest distance
constexpr int kNoiseMargin = 512;   // how far the noise fields can be shifted
constexpr float kStep = 32.0f;      // raw32 per raw
constexpr float kDimmest = 0.006f;  // signal (reflectance x cosine^0.75 / z^2) below which dots are lost
constexpr float kNearest_m = 0.45f;
constexpr float kOnePixel = 8.0f;     // raw steps: surfaces closer than this in disparity melt into one match
constexpr float kLeastShare = 0.44f;  // of a window's dots must agree
constexpr int kBins = 160;

}  // namespace

DepthSensor::DepthSensor(const DepthSensorOptions& options)
    : options_(options), width_(options.camera.width), height_(options.camera.height) {
  projector_camera_ = options.camera;
  projector_camera_.width += kPatternPad;
  projector_camera_.cx += kPatternPad;
  const auto image = static_cast<std::size_t>(width_ * height_);
  const auto pattern = static_cast<std::size_t>(projector_camera_.width * height_);
  for (auto* buffer : {&still_inverse_z_, &still_signal_, &inverse_z_, &signal_, &own_inverse_z_,
                       &own_signal_, &disparity_, &weight_, &expected_, &low_, &high_, &sum_, &signal_sum_})
    buffer->assign(image, 0.0f);
  padded_.resize(static_cast<std::size_t>(3 * (width_ + 2 * kHalfWindow)));
  still_projector_.assign(pattern, 0.0f);
  projector_.assign(pattern, 0.0f);
  id_.assign(image, 0);
  for (Matched* m : {&still_, &live_}) {
    m->raw32.assign(image, 0);
    m->spread.assign(image, 0);
    m->trust.assign(image, 0);
  }

  Random random(options.seed, 0xd07);
  const int window = 2 * kHalfWindow + 1;
  pattern_ = make_pattern(projector_camera_.width, height_, window, options.frozen_noise, random);
  bias_ = make_bias(width_, height_, options.bias, random);
  const std::vector<float> flicker =
      window_noise(width_ + kNoiseMargin, height_ + kNoiseMargin, window, random);
  flicker_.resize(flicker.size());
  for (std::size_t i = 0; i < flicker.size(); ++i)
    flicker_[i] = static_cast<std::int8_t>(std::lround(std::clamp(flicker[i] * 24.0f, -127.0f, 127.0f)));
}

Rect DepthSensor::draw_camera(const Mesh& mesh, const Pose& T, float* inverse_z, float* signal) {
  const float pixel = 1 / options_.camera.fx;
  return rasteriser_.draw(
      mesh, T, options_.camera, inverse_z, [](const Vec3f&, const Vec3f&) { return 1.0f; },
      [&](const Fragment& f) {
        const float soft = std::sqrt(f.cos_view);
        float reflectance = f.material->paint.ir;
        if (f.material->texture) {
          const float footprint = pixel / (f.inverse_z * (soft + 0.05f));
          reflectance *=
              static_cast<float>(f.material->texture->at(f.s, f.t, footprint) >> 24) * (1.0f / 255);
        }
        signal[f.v * width_ + f.u] = reflectance * soft * std::sqrt(soft) * f.inverse_z * f.inverse_z;
      });
}

Rect DepthSensor::draw_projector(const Mesh& mesh, const Pose& T, float* inverse_z) {
  Pose from_projector = T;
  from_projector.t.x -= options_.baseline_m;
  return rasteriser_.draw(
      mesh, from_projector, projector_camera_, inverse_z, [](const Vec3f&, const Vec3f&) { return 1.0f; },
      [](const Fragment&) {});
}

void DepthSensor::draw_still(const Mesh& mesh, const Pose& T_camera_mesh) {
  draw_camera(mesh, T_camera_mesh, still_inverse_z_.data(), still_signal_.data());
  draw_projector(mesh, T_camera_mesh, still_projector_.data());
}

void DepthSensor::seal_still() {
  inverse_z_ = still_inverse_z_;
  signal_ = still_signal_;
  projector_ = still_projector_;
  match_rect({0, 0, width_, height_}, still_);
  live_ = still_;
}

void DepthSensor::restore(Rect rect) {
  const auto n = static_cast<std::size_t>(rect.width());
  for (int v = rect.v0; v < rect.v1; ++v) {
    const auto at = static_cast<std::size_t>(v * width_ + rect.u0);
    std::copy_n(&still_inverse_z_[at], n, &inverse_z_[at]);
    std::copy_n(&still_signal_[at], n, &signal_[at]);
    std::copy_n(&still_.raw32[at], n, &live_.raw32[at]);
    std::copy_n(&still_.spread[at], n, &live_.spread[at]);
    std::copy_n(&still_.trust[at], n, &live_.trust[at]);
    std::fill_n(&id_[at], n, std::uint8_t{0});
  }
}

void DepthSensor::begin_frame() {
  for (const Rect& r : dirty_) restore(r);
  for (const Rect& r : projector_dirty_)
    for (int v = r.v0; v < r.v1; ++v) {
      const auto at = static_cast<std::size_t>(v * projector_camera_.width + r.u0);
      std::copy_n(&still_projector_[at], static_cast<std::size_t>(r.width()), &projector_[at]);
    }
  dirty_.clear();
  projector_dirty_.clear();
  std::fill(std::begin(unoccluded_), std::end(unoccluded_), 0);
}

void DepthSensor::draw_moving(const Mesh& mesh, const Pose& T_camera_mesh, std::uint8_t id) {
  const Rect seen = draw_camera(mesh, T_camera_mesh, own_inverse_z_.data(), own_signal_.data());
  for (int v = seen.v0; v < seen.v1; ++v)
    for (int u = seen.u0; u < seen.u1; ++u) {
      const auto at = static_cast<std::size_t>(v * width_ + u);
      if (own_inverse_z_[at] == 0) continue;
      ++unoccluded_[id];
      if (own_inverse_z_[at] > inverse_z_[at]) {
        inverse_z_[at] = own_inverse_z_[at];
        signal_[at] = own_signal_[at];
        id_[at] = id;
      }
      own_inverse_z_[at] = 0;
    }
  const Rect lit = draw_projector(mesh, T_camera_mesh, projector_.data());
  if (!lit.empty()) projector_dirty_.push_back(lit);
  // A shadow of the thing falls between where it is and where the infinitely far would see it: to its left.
  Rect changed = seen;
  if (!lit.empty()) {
    changed.include(lit.u0 - kPatternPad, lit.v0);
    changed.include(lit.u1 - kPatternPad, lit.v1 - 1);
    // Where the thing itself is out of view, its shadow may still reach in as far as the nearest thing
    // shifts.
    if (seen.empty()) changed.include(lit.u1, lit.v1 - 1);
  }
  changed = changed.grown(kHalfWindow + 1).clipped(width_, height_);
  if (!changed.empty()) dirty_.push_back(changed);
}

void DepthSensor::match() {
  // Overlapping rectangles become one, so that no pixel is matched twice. Every merge removes one: bounded.
  for (std::size_t i = 0; i < dirty_.size(); ++i)
    for (std::size_t k = 0; k < dirty_.size();) {
      const Rect &a = dirty_[i], &b = dirty_[k];
      if (k == i || a.u1 <= b.u0 || b.u1 <= a.u0 || a.v1 <= b.v0 || b.v1 <= a.v0) {
        ++k;
        continue;
      }
      dirty_[i] = {std::min(a.u0, b.u0), std::min(a.v0, b.v0), std::max(a.u1, b.u1), std::max(a.v1, b.v1)};
      dirty_.erase(dirty_.begin() + static_cast<std::ptrdiff_t>(k));
      if (k < i) --i;
      k = 0;
    }
  for (const Rect& r : dirty_) match_rect(r, live_);
}

int DepthSensor::pattern_column(int u, float raw) const {
  return std::clamp(
      u + kPatternPad - static_cast<int>((static_cast<float>(options_.raw_b) - raw) * 0.125f + 0.5f), 0,
      projector_camera_.width - 1);
}

// Disparity of each pixel, and the weight of its dots: nothing where the projector's ray ends on something
// nearer.
void DepthSensor::find_lit(Rect rect) {
  const float shift = static_cast<float>(options_.camera.fx * options_.baseline_m);
  const float a = static_cast<float>(options_.raw_a), b = static_cast<float>(options_.raw_b);
  for (int v = rect.v0; v < rect.v1; ++v) {
    const float* seen_by_projector = &projector_[static_cast<std::size_t>(v * projector_camera_.width)];
    for (int u = rect.u0; u < rect.u1; ++u) {
      const auto at = static_cast<std::size_t>(v * width_ + u);
      const float inv = inverse_z_[at];
      disparity_[at] = b - a * inv;
      const int column = static_cast<int>(static_cast<float>(u + kPatternPad) - shift * inv + 0.5f);
      const bool in_pattern = inv > 0 && column >= 0 && column < projector_camera_.width;
      // Three quarters of a pixel of disparity keep a sloping surface from shading itself.
      const bool lit = in_pattern && (seen_by_projector[column] - inv) * shift < 0.75f;
      const float dot = pattern_.dots[static_cast<std::size_t>(
          v * projector_camera_.width + std::clamp(column, 0, projector_camera_.width - 1))];
      const float bright = lit ? signal_[at] / (signal_[at] + 0.02f) : 0.0f;
      weight_[at] = lit ? dot * bright : -1.0f;
      // What the matcher looks for here: dots that are dim or missing count against every match.
      expected_[at] = lit ? dot * std::max(bright, 0.55f) : dot;
    }
  }
}

void DepthSensor::sum_row(int v, int u0, int u1) {
  const int wide = width_ + 2 * kHalfWindow;
  float *low = padded_.data(), *high = low + wide, *dim = high + wide;
  for (int u = u0 - kHalfWindow; u < u1 + kHalfWindow; ++u) {
    const auto at = static_cast<std::size_t>(v * width_ + std::clamp(u, 0, width_ - 1));
    const bool lit = weight_[at] >= 0;
    low[u + kHalfWindow] = lit ? disparity_[at] : -1e6f;
    high[u + kHalfWindow] = lit ? disparity_[at] : 1e6f;
    dim[u + kHalfWindow] = signal_[at];
  }
  const auto row = static_cast<std::size_t>(v * width_);
  for (int u = u0; u < u1; ++u) {
    float l = low[u], h = high[u], s = low[u], g = dim[u];
    for (int k = 1; k <= 2 * kHalfWindow; ++k) {
      l = std::min(l, low[u + k]);
      h = std::max(h, high[u + k]);
      s += low[u + k];
      g += dim[u + k];
    }
    const auto at = row + static_cast<std::size_t>(u);
    low_[at] = l;
    high_[at] = h;
    sum_[at] = s;
    signal_sum_[at] = g;
  }
}

void DepthSensor::match_row(int v, int u0, int u1, Matched& out) {
  std::size_t row[2 * kHalfWindow + 1];
  for (int k = -kHalfWindow; k <= kHalfWindow; ++k)
    row[k + kHalfWindow] = static_cast<std::size_t>(std::clamp(v + k, 0, height_ - 1) * width_);
  constexpr float kShare = 1.0f / ((2 * kHalfWindow + 1) * (2 * kHalfWindow + 1));
  for (int u = u0; u < u1; ++u) {
    float l = 1e9f, h = -1e9f, s = 0, g = 0;
    for (const std::size_t r : row) {
      const std::size_t at = r + static_cast<std::size_t>(u);
      l = std::min(l, low_[at]);
      h = std::max(h, high_[at]);
      s += sum_[at];
      g += signal_sum_[at];
    }
    if (h - l < kOnePixel)
      store(u, v, s * kShare, g * kShare, 1.0f, out);
    else
      vote(u, v, out);
  }
}

void DepthSensor::match_rect(Rect rect, Matched& out) {
  find_lit(rect.grown(kHalfWindow).clipped(width_, height_));
  for (int v = std::max(0, rect.v0 - kHalfWindow); v < std::min(height_, rect.v1 + kHalfWindow); ++v)
    sum_row(v, rect.u0, rect.u1);
  for (int v = rect.v0; v < rect.v1; ++v) match_row(v, rect.u0, rect.u1, out);
}

// More than one surface in the window, or a steep one: the disparity that most dots agree on wins it all.
void DepthSensor::vote(int u, int v, Matched& out) const {
  const int u0 = std::max(0, u - kHalfWindow), u1 = std::min(width_ - 1, u + kHalfWindow);
  const int v0 = std::max(0, v - kHalfWindow), v1 = std::min(height_ - 1, v + kHalfWindow);
  float votes[kBins + 2]{};
  float total = 0;
  int first = kBins, last = 0;
  for (int y = v0; y <= v1; ++y)
    for (int x = u0; x <= u1; ++x) {
      const auto at = static_cast<std::size_t>(y * width_ + x);
      const float w = weight_[at];
      total += expected_[at];
      if (w < 0) continue;
      const float place = std::clamp(disparity_[at] / kOnePixel, 0.0f, static_cast<float>(kBins - 1));
      const int bin = static_cast<int>(place);
      votes[bin] += w * (1 - (place - static_cast<float>(bin)));
      votes[bin + 1] += w * (place - static_cast<float>(bin));
      first = std::min(first, bin);
      last = std::max(last, bin + 1);
    }
  int best = first;
  for (int b = first; b <= last; ++b)
    if (votes[b] > votes[best]) best = b;
  float mass = 0, moment = 0;
  for (int b = std::max(first, best - 1); b <= std::min(last, best + 1); ++b) {
    mass += votes[b];
    moment += votes[b] * static_cast<float>(b);
  }
  if (first > last || mass <= 0) return store(u, v, 0, 0, 0, out);
  const float peak = kOnePixel * moment / mass;
  float agreed = 0, mean = 0, signal = 0;
  for (int y = v0; y <= v1; ++y)
    for (int x = u0; x <= u1; ++x) {
      const auto at = static_cast<std::size_t>(y * width_ + x);
      const float w = weight_[at];
      if (w < 0 || std::fabs(disparity_[at] - peak) > kOnePixel) continue;
      agreed += w;
      mean += w * disparity_[at];
      signal += w * signal_[at];
    }
  if (agreed <= 0) return store(u, v, 0, 0, 0, out);
  store(u, v, mean / agreed, signal / agreed, agreed / total, out);
}

void DepthSensor::store(int u, int v, float raw, float signal, float share, Matched& out) const {
  const auto at = static_cast<std::size_t>(v * width_ + u);
  const auto place = static_cast<std::size_t>(v * projector_camera_.width + pattern_column(u, raw));
  const float nearest = static_cast<float>(options_.raw_b - options_.raw_a / kNearest_m);
  if (signal <= 0 || u >= width_ - kDeadColumns || raw < nearest || pattern_.hole[place] != 0) {
    out.trust[at] = 0;
    return;
  }
  const float dim = std::sqrt(std::min(kDimmest / signal, 4.0f));
  const float value = raw + pattern_.frozen[place] * (0.85f + 0.8f * dim) + bias_[at];
  out.raw32[at] = static_cast<std::uint16_t>(std::clamp(value * kStep + 0.5f, 0.0f, 65000.0f));
  out.spread[at] = static_cast<std::uint8_t>(std::min(16.0f * (1 + 2.0f * dim + 2.0f * (1 - share)), 100.0f));
  const float margin = std::min(240.0f * (share - kLeastShare), 60.0f * (1 - kDimmest / signal));
  out.trust[at] = static_cast<std::uint8_t>(std::clamp(128.0f + margin, 0.0f, 255.0f));
}

void DepthSensor::sample(std::uint64_t frame_seed, ImageView<std::uint16_t> raw) const {
  Random random(options_.seed ^ mix64(frame_seed), 0xf11c);
  const int stride = width_ + kNoiseMargin;
  const auto offset = [&] {
    const int u = random.below(kNoiseMargin), v = random.below(kNoiseMargin);
    return static_cast<std::size_t>(v * stride + u);
  };
  const std::size_t a = offset(), b = offset(), c = offset();
  // Two fields of spread 24 sum to 34; times 16 (a bright surface) that is flicker_noise.
  const int scale = static_cast<int>(std::lround(options_.flicker_noise * kStep / (34.0 * 16.0) * 4096.0));
  for (int v = 0; v < height_; ++v) {
    const auto row = static_cast<std::size_t>(v * width_);
    const auto noise_row = static_cast<std::size_t>(v * stride);
    const std::int8_t *na = &flicker_[noise_row + a], *nb = &flicker_[noise_row + b],
                      *nc = &flicker_[noise_row + c];
    const std::uint16_t* clean = &live_.raw32[row];
    const std::uint8_t *spread = &live_.spread[row], *trust = &live_.trust[row];
    std::uint16_t* out = raw.row(v);
    for (int u = 0; u < width_; ++u) {
      const int error = ((na[u] + nb[u]) * spread[u] * scale) >> 12;
      const int value = (clean[u] + error + 16) >> 5;
      const bool found = trust[u] + (nc[u] >> 2) > 128;
      out[u] = found ? static_cast<std::uint16_t>(std::clamp(value, 0, 1100)) : kNoReading;
    }
  }
}

}  // namespace st::sim
