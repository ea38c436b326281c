#include "firmware_like/model_keeper.hpp"

#include "firmware_like/model_meshes.hpp"
#include "firmware_like/stored_twin.hpp"

namespace st {
namespace {

constexpr std::uint64_t kLeastTracked = 45;  // frames: what was seen for less is no model yet
constexpr int kLeastIntegrated = 15;
constexpr int kLeastNewSides = 3;      // that make an update worth a version
constexpr std::uint8_t kSideSeen = 3;  // frames fused from a side

int sides_seen(const SeenSides& sides) {
  int count = 0;
  for (const std::uint8_t fused : sides.fused) count += fused >= kSideSeen ? 1 : 0;
  return count;
}

int new_sides(const SeenSides& now, const SeenSides& before) {
  int count = 0;
  for (std::size_t i = 0; i < std::size(now.fused); ++i)
    count += now.fused[i] >= kSideSeen && before.fused[i] < kSideSeen ? 1 : 0;
  return count;
}

const Track* track_of(const ObjectTracker& tracker, int id) {
  for (const Track& track : tracker.tracks())
    if (track.id == id && track.phase != Track::Phase::kFree) return &track;
  return nullptr;
}

ModelTraits traits_of(const Track& track) {
  ModelTraits traits;
  traits.bounds = track.bounds;
  traits.sides = track.sides;
  traits.integrated = static_cast<std::uint32_t>(track.integrated);
  return traits;
}

class Keeper {
 public:
  Keeper(const ModelLibrary& library, ModelStore& store, const KeepOptions& options)
      : library_(library), store_(store), options_(options) {}

  void keep(const ObjectCount& count, const Track* track, ObjectEnd& object) {
    if (count.known_model >= 0) {
      const auto known = static_cast<std::size_t>(count.known_model);
      object.model_from_database = true;
      name(object, library_.entry(known));
      object.T_model_object = count.T_model_object;
      if (!options_.may_store || track == nullptr || track->known_model != count.known_model) return;
      const int more = new_sides(track->sides, library_.models()[known].traits.sides);
      if (more >= kLeastNewSides) update(*track, known, more);
      return;
    }
    if (count.named_model >= 0) {  // its heading has stayed open, so its own model cannot be merged
      name(object, library_.entry(static_cast<std::size_t>(count.named_model)));
      return;
    }
    if (!options_.may_store || track == nullptr || !is_worth_it(count, *track)) return;
    const ModelTraits traits = traits_of(*track);
    const StoredTwin same = find_twin(library_.models(), track->volume);
    if (same.model >= 0) {  // known after all, from its sides that came into sight later
      const auto known = static_cast<std::size_t>(same.model);
      name(object, library_.entry(known));
      if (same.has_heading) object.T_model_object = same.T_model_volume;
      said_.push_back("object " + std::to_string(object.id) + " is the stored " + library_.entry(known).name);
      return;
    }
    add(*track, traits, object);
  }
  std::vector<std::string> take_said() { return std::move(said_); }

 private:
  static bool is_worth_it(const ObjectCount& count, const Track& track) {
    return count.tracked >= kLeastTracked && track.integrated >= kLeastIntegrated && !track.cut() &&
           (count.good_at_end || count.left_view) && sides_seen(track.sides) > 0;
  }

  static void name(ObjectEnd& object, const ModelEntry& entry) {
    object.name = entry.name;
    object.model_id = entry.id;
  }

  ModelContent content_of(const OwnedModel& model, const Volume& volume) const {
    ModelContent content = encode_model(model.view());
    ModelMeshes meshes;
    if (options_.picture) content.thumbnail = options_.picture(meshes.extract(volume));
    return content;
  }

  ModelEntry entry_for(const OwnedModel& model) const {
    ModelEntry entry = entry_of(model.view());
    entry.source = options_.source;
    entry.program = options_.program;
    return entry;
  }

  void update(const Track& track, std::size_t known, int more) {
    const OwnedModel model = describe_volume(track.volume, traits_of(track));
    ModelEntry entry = entry_for(model);
    entry.id = library_.entry(known).id;
    entry = store_.update(entry, content_of(model, track.volume));
    said_.push_back("model " + entry.name + ": " + std::to_string(more) + " new sides, version " +
                    std::to_string(entry.version));
  }

  void add(const Track& track, const ModelTraits& traits, ObjectEnd& object) {
    const OwnedModel model = describe_volume(track.volume, traits);
    if (model.bricks.empty()) return;
    const ModelEntry entry = store_.add(entry_for(model), content_of(model, track.volume));
    name(object, entry);
    said_.push_back("model " + entry.name + ": new, " + std::to_string(entry.features) + " features");
  }

  const ModelLibrary& library_;
  ModelStore& store_;
  const KeepOptions& options_;
  std::vector<std::string> said_;
};

}  // namespace

std::vector<std::string> keep_models(const ObjectTracker& tracker, const ModelLibrary& library,
                                     ModelStore& store, const KeepOptions& options,
                                     std::vector<ObjectEnd>& objects) {
  Keeper keeper(library, store, options);
  std::size_t i = 0;
  for (const ObjectCount& count : tracker.counts()) {
    if (i == objects.size()) break;
    keeper.keep(count, track_of(tracker, count.id), objects[i++]);
  }
  return keeper.take_said();
}

}  // namespace st
