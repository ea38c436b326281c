#include "firmware_like/stored_twin.hpp"

#include <vector>

#include "algo/core/scalar_math.hpp"
#include "algo/recognition/patch_check.hpp"
#include "firmware_like/heap_memory.hpp"

namespace st {
namespace {

constexpr int kViews = 8;
constexpr double kDistance_m = 1.5, kElevation_rad = 0.6;

// A camera that looks down at `middle` from this azimuth (frame of the volume).
Pose looking_at(const Vec3& middle, double azimuth_rad) {
  const SinCos a = sin_cos(azimuth_rad), e = sin_cos(kElevation_rad);
  const Vec3 eye = middle + Vec3{a.cos * e.cos, a.sin * e.cos, e.sin} * kDistance_m;
  const Vec3 ahead = normalized(middle - eye), right = normalized(cross(ahead, Vec3{0, 0, 1}));
  return Pose{Mat3::from_columns(right, cross(ahead, right), ahead), eye}.inverse();
}

// The volume's own views, with which a model's are compared.
class Views {
 public:
  explicit Views(const Volume& volume)
      : volume_(volume), middle_(to_double(volume.centre())), owners_(pixels()), memory_([this](Bump& bump) {
          scratch_.bind(bump, camera_.width, camera_.height);
          seen_.maps.bind(bump, camera_.width, camera_.height);
          model_.maps.bind(bump, camera_.width, camera_.height);
        }) {}

  PatchCheck compare(const Volume& model, const Pose& T_model_volume, float skirt_z_m) {
    PatchCheck all;
    for (int i = 0; i < kViews; ++i) {
      const Pose T_camera_volume = looking_at(middle_, 2 * kPi * i / kViews);
      const Pose T_camera_model = T_camera_volume * T_model_volume.inverse();
      const Rect box = visible_rect(volume_, camera_, T_camera_volume);
      raycast(volume_, camera_, box, T_camera_volume, scratch_, seen_.maps);
      model_.T_camera_object = T_camera_model;
      raycast(model, camera_, visible_rect(model, camera_, T_camera_model), T_camera_model, scratch_,
              model_.maps);
      all += check(skirt_z_m);
    }
    return all;
  }

 private:
  std::size_t pixels() const { return static_cast<std::size_t>(camera_.width * camera_.height); }

  PatchCheck check(float skirt_z_m) {
    std::vector<float> z(pixels(), 0.0f);
    std::vector<std::uint32_t> color(pixels(), 0);
    const Rect roi = seen_.maps.roi;
    for (int v = roi.v0; v < roi.v1; ++v)
      for (int u = roi.u0; u < roi.u1; ++u) {
        const auto at = static_cast<std::size_t>(v * camera_.width + u);
        z[at] = seen_.maps.z[seen_.maps.at(u, v)];
        color[at] = seen_.maps.color[seen_.maps.at(u, v)];
        owners_[at] = z[at] > 0 ? 1 : 0;
      }
    PatchInput in;
    in.view = &model_;
    in.camera = camera_;
    in.depth_z = {z.data(), camera_.width, camera_.height};
    in.owners = {owners_.data(), camera_.width, camera_.height};
    in.owner = 1;
    in.color = {color.data(), camera_.width, camera_.height};
    in.skirt_z_m = skirt_z_m;
    return check_patches(in);
  }

  const Volume& volume_;
  Vec3 middle_;
  Pinhole camera_{525, 525, 319.5f, 239.5f, 640, 480};
  std::vector<std::uint8_t> owners_;
  RaycastScratch scratch_;
  ModelView seen_, model_;
  HeapMemory memory_;
};

}  // namespace

StoredTwin find_twin(std::span<const KnownModel> models, const Volume& volume) {
  if (models.empty()) return {};
  Recognition recognition;
  const HeapMemory memory([&](Bump& bump) { recognition.bind(bump, volume.side); });
  RecognitionSubject subject;
  subject.volume = &volume;
  subject.towards = {1, 0, 0};
  constexpr bool kNone[kMaxKnownModels]{};
  recognition.start(models, kNone, subject, RecognitionWay::kMatchesAndHeadings);
  while (!recognition.advance(Recognition::kUnitsPerFrame)) {
  }
  Recognised best = recognition.best();
  best.second_score = 0;  // whichever it is, it is stored already
  if (!is_sure_model(best)) return {};
  const float skirt_z_m = appearance_of(models[static_cast<std::size_t>(best.model)].traits).least_top_m;
  Views views(volume);
  const PatchCheck here = views.compare(recognition.volume(), best.fit.T_model_seen, skirt_z_m);
  if (!here.agrees()) return {};
  StoredTwin twin{best.model, true, best.fit.T_model_seen};
  for (const VolumeFit& other : best.other_headings)
    if (other.score() > 0)
      twin.has_heading = twin.has_heading &&
                         here.refutes(views.compare(recognition.volume(), other.T_model_seen, skirt_z_m));
  return twin;
}

}  // namespace st
