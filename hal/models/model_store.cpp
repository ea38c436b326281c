#include "hal/models/model_store.hpp"

#include <sys/stat.h>

#include <array>
#include <ctime>
#include <filesystem>
#include <random>

#include "hal/error.hpp"

namespace st {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kApplicationId = 0x53744d64;  // "StMd": what makes a file a model database

// The schema as it is made now; migrate() brings older ones here.
constexpr const char* kTables = R"(
CREATE TABLE model(id TEXT PRIMARY KEY, name TEXT NOT NULL UNIQUE, version INTEGER NOT NULL,
  created TEXT NOT NULL);
CREATE TABLE version(model TEXT NOT NULL REFERENCES model(id) ON DELETE CASCADE, version INTEGER NOT NULL,
  saved TEXT NOT NULL, source TEXT NOT NULL, program TEXT NOT NULL,
  width_m REAL NOT NULL, depth_m REAL NOT NULL, height_m REAL NOT NULL, feature_count INTEGER NOT NULL,
  PRIMARY KEY(model, version));
CREATE TABLE content(model TEXT NOT NULL REFERENCES model(id) ON DELETE CASCADE, version INTEGER NOT NULL,
  volume BLOB NOT NULL, features BLOB NOT NULL, statistics BLOB NOT NULL, thumbnail BLOB NOT NULL,
  PRIMARY KEY(model, version));
)";

constexpr const char* kEntryColumns =
    "SELECT m.id, m.name, m.version, m.created, v.saved, v.source, v.program, v.width_m, v.depth_m, "
    "v.height_m,"
    " v.feature_count, coalesce(length(c.volume) + length(c.features), 0), v.version"
    " FROM model m JOIN version v ON v.model = m.id LEFT JOIN content c ON c.model = m.id AND c.version = "
    "v.version";

ModelEntry entry_of(const Statement& row) {
  ModelEntry entry;
  entry.id = row.text_at(0);
  entry.name = row.text_at(1);
  entry.version = static_cast<int>(row.number_at(12));
  entry.created = row.text_at(3);
  entry.updated = row.text_at(4);
  entry.source = row.text_at(5);
  entry.program = row.text_at(6);
  entry.width_m = row.real_at(7);
  entry.depth_m = row.real_at(8);
  entry.height_m = row.real_at(9);
  entry.features = static_cast<int>(row.number_at(10));
  entry.bytes = row.number_at(11);
  return entry;
}

std::string random_id() {
  std::random_device device;
  std::array<char, 17> text{};
  std::snprintf(text.data(), text.size(), "%08x%08x", device(), device());
  return text.data();
}

// Reads only, so that a file that is refused stays as it was.
void refuse_foreign(const std::string& path) {
  Database look(path, Database::Access::kRead);
  if (look.number("SELECT count(*) FROM sqlite_master") == 0 && look.number("PRAGMA application_id") == 0)
    return;  // empty: becomes one
  if (look.number("PRAGMA application_id") != kApplicationId)
    throw Failure(ExitCode::kBadInput,
                  path +
                      ": is a database of another program; name another file with --models "
                      "(this one was not touched)");
  const std::int64_t schema = look.number("PRAGMA user_version");
  if (schema > ModelStore::kSchema)
    throw Failure(ExitCode::kBadInput, path + ": was written by a newer startrack (schema " +
                                           std::to_string(schema) + ", this one knows " +
                                           std::to_string(ModelStore::kSchema) + "); update this one");
  const std::string check = look.text("PRAGMA quick_check(1)");
  if (check != "ok")
    throw Failure(ExitCode::kBadInput,
                  path + ": is damaged (" + check +
                      "); take a backup, or name another file with --models (this one was "
                      "not touched)");
}

const std::string& checked(const std::string& path) {
  if (path.empty()) throw Failure(ExitCode::kBadInput, "--models: needs the name of a file");
  if (fs::is_directory(path))
    throw Failure(ExitCode::kBadInput, path + ": is a folder; --models names the database's file");
  if (fs::exists(path)) refuse_foreign(path);
  return path;
}

}  // namespace

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

ModelStore::ModelStore(const std::string& path) : database_(checked(path), Database::Access::kCreate) {
  prepare();
}

void ModelStore::prepare() {
  database_.run("PRAGMA journal_mode=WAL");
  database_.run("PRAGMA synchronous=FULL");
  database_.run("PRAGMA foreign_keys=ON");
  const auto schema = static_cast<int>(database_.number("PRAGMA user_version"));
  if (schema == kSchema) return;
  if (schema > 0) {
    migrate(schema);
    return;
  }
  Transaction transaction(database_);
  if (database_.number("PRAGMA user_version") == 0) {  // else another program was faster
    database_.run(kTables);
    database_.run("PRAGMA application_id=" + std::to_string(kApplicationId));
    database_.run("PRAGMA user_version=" + std::to_string(kSchema));
  }
  transaction.commit();
}

// Schema 1 had one version of each model, in the table of the models.
void ModelStore::migrate(int from) {
  const std::string backup = path() + ".schema-" + std::to_string(from), partial = backup + ".partial";
  fs::remove(partial);
  Statement copy(database_, "VACUUM INTO ?");
  copy.text(partial).next();
  fs::rename(partial, backup);
  Transaction transaction(database_);
  if (database_.number("PRAGMA user_version") == 1) {
    database_.run("ALTER TABLE model RENAME TO model_1");
    database_.run(kTables);
    database_.run(
        "INSERT INTO model SELECT id, name, 1, created FROM model_1;"
        "INSERT INTO version SELECT id, 1, created, source, program, width_m, depth_m, height_m, "
        "feature_count"
        " FROM model_1;"
        "INSERT INTO content SELECT id, 1, volume, features, statistics, x'' FROM model_1;"
        "DROP TABLE model_1");
    database_.run("PRAGMA user_version=" + std::to_string(kSchema));
  }
  transaction.commit();
}

std::vector<ModelEntry> ModelStore::list() {
  Statement rows(database_,
                 std::string(kEntryColumns) + " WHERE v.version = m.version ORDER BY m.name, m.id");
  std::vector<ModelEntry> entries;
  while (rows.next()) entries.push_back(entry_of(rows));
  return entries;
}

std::optional<StoredModel> ModelStore::find(const std::string& id_or_name, int version) {
  Statement row(database_,
                std::string(kEntryColumns) +
                    " WHERE (m.id = ?1 OR m.name = ?1)"
                    " AND v.version = CASE ?2 WHEN 0 THEN m.version ELSE ?2 END ORDER BY m.id = ?1 DESC");
  row.text(id_or_name).number(version);
  if (!row.next()) return std::nullopt;
  StoredModel model;
  model.entry = entry_of(row);
  Statement content(
      database_,
      "SELECT volume, features, statistics, thumbnail FROM content WHERE model = ? AND version = ?");
  content.text(model.entry.id).number(model.entry.version);
  if (!content.next()) return std::nullopt;
  model.content = {content.text_at(0), content.text_at(1), content.text_at(2), content.text_at(3)};
  return model;
}

std::vector<ModelVersion> ModelStore::history(const std::string& id) {
  Statement rows(database_,
                 "SELECT v.version, v.saved, v.source, v.program, c.model IS NOT NULL FROM version v"
                 " LEFT JOIN content c ON c.model = v.model AND c.version = v.version"
                 " WHERE v.model = ? ORDER BY v.version");
  rows.text(id);
  std::vector<ModelVersion> versions;
  while (rows.next())
    versions.push_back({static_cast<int>(rows.number_at(0)), rows.text_at(1), rows.text_at(2),
                        rows.text_at(3), rows.number_at(4) != 0});
  return versions;
}

bool ModelStore::has_name(const std::string& name) {
  Statement row(database_, "SELECT 1 FROM model WHERE name = ?");
  return row.text(name).next();
}

std::string ModelStore::free_name(const std::string& stem, bool bare_first) {
  if (bare_first && !has_name(stem)) return stem;
  for (int n = bare_first ? 2 : 1;; ++n) {
    std::string name = stem + "-" + std::to_string(n);
    if (!has_name(name)) return name;
  }
}

void ModelStore::write_content(const ModelEntry& entry, const ModelContent& content) {
  Statement version(database_, "INSERT INTO version VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?)");
  version.text(entry.id).number(entry.version).text(entry.updated).text(entry.source).text(entry.program);
  version.real(entry.width_m).real(entry.depth_m).real(entry.height_m).number(entry.features).next();
  Statement bytes(database_, "INSERT INTO content VALUES(?, ?, ?, ?, ?, ?)");
  bytes.text(entry.id).number(entry.version).blob(content.volume).blob(content.features);
  bytes.blob(content.statistics).blob(content.thumbnail).next();
  Statement old(database_, "DELETE FROM content WHERE model = ? AND version <= ?");
  old.text(entry.id).number(entry.version - kKeptVersions).next();
}

ModelEntry ModelStore::add(ModelEntry entry, const ModelContent& content) {
  Transaction transaction(database_);
  if (entry.name.empty()) entry.name = free_name("object", false);
  if (has_name(entry.name))
    throw Failure(ExitCode::kBadInput, path() + ": already has a model named " + entry.name +
                                           "; choose another name, or delete that one");
  entry.id = random_id();
  entry.version = 1;
  entry.created = entry.updated = utc_now();
  Statement model(database_, "INSERT INTO model VALUES(?, ?, ?, ?)");
  model.text(entry.id).text(entry.name).number(1).text(entry.created).next();
  write_content(entry, content);
  transaction.commit();
  return entry;
}

ModelEntry ModelStore::update(ModelEntry entry, const ModelContent& content) {
  Transaction transaction(database_);
  Statement now(database_, "SELECT name, version, created FROM model WHERE id = ?");
  if (!now.text(entry.id).next())
    throw Failure(ExitCode::kBadInput, path() + ": model " + entry.id + " is not there any more");
  entry.name = now.text_at(0);
  entry.version = static_cast<int>(now.number_at(1)) + 1;
  entry.created = now.text_at(2);
  entry.updated = utc_now();
  Statement model(database_, "UPDATE model SET version = ? WHERE id = ?");
  model.number(entry.version).text(entry.id).next();
  write_content(entry, content);
  transaction.commit();
  return entry;
}

void ModelStore::rename(const std::string& id, const std::string& name) {
  if (name.empty()) throw Failure(ExitCode::kBadInput, "a model's name must not be empty");
  Transaction transaction(database_);
  if (has_name(name)) throw Failure(ExitCode::kBadInput, path() + ": already has a model named " + name);
  Statement model(database_, "UPDATE model SET name = ? WHERE id = ?");
  model.text(name).text(id).next();
  transaction.commit();
}

void ModelStore::erase(const std::string& id) {
  Transaction transaction(database_);
  Statement model(database_, "DELETE FROM model WHERE id = ?");
  model.text(id).next();
  transaction.commit();
}

int ModelStore::merge(ModelStore& other) {
  Transaction transaction(database_);
  int came = 0;
  for (const ModelEntry& entry : other.list()) {
    Statement known(database_, "SELECT 1 FROM model WHERE id = ?");
    if (known.text(entry.id).next()) continue;
    Statement model(database_, "INSERT INTO model VALUES(?, ?, ?, ?)");
    model.text(entry.id).text(free_name(entry.name, true)).number(entry.version).text(entry.created).next();
    for (const ModelVersion& version : other.history(entry.id))
      if (const auto stored = other.find(entry.id, version.version))
        write_content(stored->entry, stored->content);
    ++came;
  }
  transaction.commit();
  return came;
}

}  // namespace st
