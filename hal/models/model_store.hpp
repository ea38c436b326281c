// The model database: one SQLite file with every object that was ever met. A save is one transaction in
// write-ahead mode: a killed program leaves the old content or the new one. Never used on the compute thread.
// What volumes and features look like inside is their writers' business (firmware_like/model_codec.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/models/sqlite.hpp"

namespace st {

// What `models list` shows of a model.
struct ModelEntry {
  std::string id;                // 16 hex digits, never reused
  std::string name;              // unique in its database
  int version = 1;               // rises with every update
  std::string created, updated;  // UTC, 2024-03-09T08:07:06Z
  std::string source, program;   // the recording or file of this version, and the program's version
  double width_m = 0, depth_m = 0, height_m = 0;
  int features = 0;
  std::int64_t bytes = 0;  // compressed
};

struct ModelContent {
  std::string volume, features, statistics;  // compressed
  std::string thumbnail;                     // PNG, may be empty
};

struct StoredModel {
  ModelEntry entry;
  ModelContent content;
};

struct ModelVersion {
  int version = 1;
  std::string saved, source, program;
  bool has_content = false;  // older ones are dropped in time
};

class ModelStore {
 public:
  static constexpr int kSchema = 2;
  static constexpr int kKeptVersions = 4;  // with content; of the others only the line in the history

  // Makes the file when it is not there. A foreign, damaged or newer one is refused untouched; an older
  // schema is brought up to date, after a copy was put beside it (FILE.schema-1). Throws Failure (kBadInput).
  explicit ModelStore(const std::string& path);

  std::vector<ModelEntry> list();  // by name
  // By id or name. `version` 0: the newest. Nothing when there is no such model.
  std::optional<StoredModel> find(const std::string& id_or_name, int version = 0);
  std::vector<ModelVersion> history(const std::string& id);

  // A new model; entry.name empty: "object-N" with the first N that is free. Returns the entry as stored.
  // Throws Failure when the name is taken.
  ModelEntry add(ModelEntry entry, const ModelContent& content);
  // The next version of entry.id; the one before is kept. Sizes, source and program from `entry`.
  ModelEntry update(ModelEntry entry, const ModelContent& content);
  void rename(const std::string& id, const std::string& name);
  void erase(const std::string& id);
  // Every model of `other` that is not here (by id), with its versions; a taken name gets a number. Returns
  // how many came over.
  int merge(ModelStore& other);

  const std::string& path() const { return database_.path(); }

 private:
  void prepare();
  void migrate(int from);
  bool has_name(const std::string& name);
  std::string free_name(const std::string& stem, bool bare_first);
  void write_content(const ModelEntry& entry, const ModelContent& content);

  Database database_;
};

// Now, as ModelEntry has it.
std::string utc_now();

}  // namespace st
