#include "firmware_like/model_codec.hpp"

#include <bit>
#include <cmath>
#include <cstring>

#include "algo/recognition/appearance.hpp"
#include "algo/recognition/volume_fit.hpp"
#include "firmware_like/heap_memory.hpp"
#include "hal/error.hpp"
#include "hal/models/packed_bytes.hpp"

namespace st {
namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they lie in memory");

constexpr std::uint32_t kVolumeMark = 0x31565453, kFeatureMark = 0x31465453, kTraitMark = 0x31545453;
constexpr std::uint32_t kMostBricks = 64 * 64 * 64;
constexpr std::size_t kMostBytes = std::size_t{1} << 31;

class Writer {
 public:
  template <typename T>
  void put(const T& value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::string packed() const { return compress_bytes(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  Reader(std::string_view packed, const std::string& name)
      : bytes_(expand_bytes(packed, kMostBytes, name)), name_(name) {}
  template <typename T>
  void get(T& value) {
    if (bytes_.size() - at_ < sizeof value) fail();
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
  }
  void expect(std::uint32_t mark) {
    std::uint32_t found = 0;
    get(found);
    if (found != mark) fail();
  }
  void check(bool possible) const {
    if (!possible) fail();
  }
  void end() const { check(at_ == bytes_.size()); }

 private:
  [[noreturn]] void fail() const {
    throw Failure(ExitCode::kBadInput,
                  "model " + name_ + ": its content is damaged; delete it with startrack models delete");
  }
  std::string bytes_;
  std::string name_;
  std::size_t at_ = 0;
};

// Alike values side by side: they compress to half of what whole bricks would.
std::string encode_volume(const PackedVolume& volume) {
  Writer out;
  out.put(kVolumeMark);
  out.put(static_cast<std::uint32_t>(volume.side));
  out.put(volume.voxel_m);
  out.put(volume.truncation_m);
  out.put(volume.origin);
  out.put(volume.integrations);
  out.put(static_cast<std::uint32_t>(volume.bricks.size()));
  for (const PackedBrick& b : volume.bricks)
    out.put(b.x), out.put(b.y), out.put(b.z), out.put(b.flags), out.put(b.octants);
  for (const PackedBrick& b : volume.bricks) out.put(b.tsdf);
  for (const PackedBrick& b : volume.bricks) out.put(b.weight);
  for (const PackedBrick& b : volume.bricks) out.put(b.observations);
  for (const PackedBrick& b : volume.bricks) out.put(b.color);
  return out.packed();
}

void decode_volume(std::string_view bytes, const std::string& name, OwnedModel& model) {
  Reader in(bytes, name);
  in.expect(kVolumeMark);
  std::uint32_t side = 0, count = 0;
  PackedVolume& v = model.volume;
  in.get(side);
  in.get(v.voxel_m);
  in.get(v.truncation_m);
  in.get(v.origin);
  in.get(v.integrations);
  in.get(count);
  in.check(side >= 64 && side <= 512 && side % kBrickSide == 0 && count > 0 && count <= kMostBricks);
  in.check(v.voxel_m > 1e-4f && v.voxel_m < 1 && v.truncation_m > 0 && v.truncation_m < 1);
  in.check(std::isfinite(v.origin.x) && std::isfinite(v.origin.y) && std::isfinite(v.origin.z));
  v.side = static_cast<int>(side);
  model.bricks.resize(count);
  for (PackedBrick& b : model.bricks) {
    in.get(b.x), in.get(b.y), in.get(b.z), in.get(b.flags), in.get(b.octants);
    in.check(b.x < side / kBrickSide && b.y < side / kBrickSide && b.z < side / kBrickSide);
  }
  for (PackedBrick& b : model.bricks) in.get(b.tsdf);
  for (PackedBrick& b : model.bricks) in.get(b.weight);
  for (PackedBrick& b : model.bricks) in.get(b.observations);
  for (PackedBrick& b : model.bricks) in.get(b.color);
  in.end();
  v.bricks = model.bricks;
}

std::string encode_features(const FeatureSet& set) {
  Writer out;
  out.put(kFeatureMark);
  out.put(static_cast<std::uint32_t>(set.features.size()));
  for (const Feature& f : set.features) {
    out.put(f.p_m), out.put(f.sigma_m), out.put(f.R);
    out.put(static_cast<std::uint32_t>(f.keypoint));
  }
  for (const Descriptor& d : set.descriptors) out.put(d);
  return out.packed();
}

void decode_features(std::string_view bytes, const std::string& name, OwnedModel& model) {
  Reader in(bytes, name);
  in.expect(kFeatureMark);
  std::uint32_t count = 0;
  in.get(count);
  in.check(count <= kMaxFeatures);
  model.features.resize(count);
  model.descriptors.resize(count);
  for (Feature& f : model.features) {
    std::uint32_t keypoint = 0;
    in.get(f.p_m), in.get(f.sigma_m), in.get(f.R), in.get(keypoint);
    in.check(std::isfinite(f.p_m.x + f.p_m.y + f.p_m.z) && f.sigma_m > 0 && keypoint < kMaxKeypoints);
    for (const float m : f.R.m) in.check(std::isfinite(m));
    f.keypoint = static_cast<int>(keypoint);
  }
  for (Descriptor& d : model.descriptors) in.get(d);
  in.end();
}

std::string encode_traits(const ModelTraits& traits) {
  Writer out;
  out.put(kTraitMark);
  out.put(traits.bounds.low), out.put(traits.bounds.high);
  out.put(traits.color), out.put(traits.sides), out.put(traits.integrated);
  return out.packed();
}

void decode_traits(std::string_view bytes, const std::string& name, ModelTraits& traits) {
  Reader in(bytes, name);
  in.expect(kTraitMark);
  in.get(traits.bounds.low), in.get(traits.bounds.high);
  in.get(traits.color), in.get(traits.sides), in.get(traits.integrated);
  in.end();
  const Vec3 size = traits.bounds.size();
  in.check(size.x > 0 && size.y > 0 && size.z > 0 && size.x + size.y + size.z < 100);
}

}  // namespace

KnownModel OwnedModel::view() const {
  KnownModel model{volume, {features, descriptors}, traits};
  model.volume.bricks = bricks;
  return model;
}

ModelContent encode_model(const KnownModel& model) {
  return {encode_volume(model.volume), encode_features(model.features), encode_traits(model.traits), {}};
}

OwnedModel decode_model(const ModelContent& content, const std::string& name) {
  OwnedModel model;
  decode_volume(content.volume, name, model);
  decode_features(content.features, name, model);
  decode_traits(content.statistics, name, model.traits);
  return model;
}

OwnedModel describe_volume(const Volume& volume, const ModelTraits& traits) {
  OwnedModel model;
  model.traits = traits;
  std::vector<SurfacePoint> points(kFitPoints);
  std::vector<Vec3f> scratch(kFitPoints);
  model.traits.bounds = sample_surface(volume, points, scratch).bounds;
  model.traits.color = color_stats(volume);
  model.bricks.resize(count_packed(volume));
  model.volume = pack(volume, model.bricks);
  Sift3d sift;
  const HeapMemory memory([&](Bump& bump) { sift.bind(bump, kAppearanceSide); });
  place_appearance(sift.input(), model.traits.bounds);
  fill_appearance(volume, appearance_of(model.traits), sift.input(), 0, kAppearanceSide);
  sift.start(kObjectKeypoints);
  while (!sift.step()) {
  }
  const FeatureSet set = sift.features();
  model.features.assign(set.features.begin(), set.features.end());
  model.descriptors.assign(set.descriptors.begin(), set.descriptors.end());
  return model;
}

ModelEntry entry_of(const KnownModel& model) {
  ModelEntry entry;
  const Vec3 size = model.traits.bounds.size();
  entry.width_m = size.x;
  entry.depth_m = size.y;
  entry.height_m = size.z;
  entry.features = static_cast<int>(model.features.features.size());
  return entry;
}

}  // namespace st
