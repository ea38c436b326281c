#include "hal/models/model_store.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "hal/error.hpp"
#include "hal/models/packed_bytes.hpp"
#include "hal/results/line_file.hpp"
#include "tests/support/temp_folder.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;

namespace {

ModelEntry entry_named(const std::string& name) {
  ModelEntry entry;
  entry.name = name;
  entry.source = "a recording";
  entry.program = "0.1.0";
  entry.width_m = 0.3;
  entry.features = 12;
  return entry;
}

// Three blobs that belong together: each says the same number.
ModelContent content_of(int number, std::size_t bytes = 1000) {
  const std::string text = std::to_string(number) + std::string(bytes, static_cast<char>('a' + number % 26));
  return {"v" + text, "f" + text, "s" + text, "t"};
}

void refused(const std::string& path, const char* why) {
  const std::string before = read_whole_file(path);
  std::string said;
  try {
    ModelStore store(path);
  } catch (const Failure& failure) {
    said = failure.what();
    LONGS_EQUAL(static_cast<int>(ExitCode::kBadInput), static_cast<int>(failure.code()));
  }
  STRCMP_CONTAINS(path.c_str(), said.c_str());
  STRCMP_CONTAINS(why, said.c_str());
  CHECK_EQUAL_TEXT(before, read_whole_file(path), "a refused file was touched");
}

}  // namespace

TEST_GROUP(ModelStore) {
  TempFolder folder;
  std::string path() const { return folder / "models.db"; }
};

TEST(ModelStore, KeepsWhatItIsGivenAndNumbersWhatHasNoName) {
  std::string id;
  {
    ModelStore store(path());
    id = store.add(entry_named(""), content_of(1)).id;
    STRCMP_EQUAL("object-2", store.add(entry_named(""), content_of(2)).name.c_str());
  }
  ModelStore store(path());
  LONGS_EQUAL(2, store.list().size());
  const auto found = store.find("object-1");
  CHECK_TRUE(found.has_value());
  CHECK_EQUAL(id, found->entry.id);
  CHECK_EQUAL(content_of(1).volume, found->content.volume);
  CHECK_EQUAL(content_of(1).statistics, found->content.statistics);
  DOUBLES_EQUAL(0.3, found->entry.width_m, 1e-12);
  LONGS_EQUAL(12, found->entry.features);
  CHECK_TRUE(store.find(id).has_value());
  CHECK_FALSE(store.find("nobody").has_value());
}

TEST(ModelStore, AnUpdateIsTheNextVersionAndOldOnesStay) {
  ModelStore store(path());
  ModelEntry entry = store.add(entry_named("create"), content_of(1));
  for (int version = 2; version <= 6; ++version)
    LONGS_EQUAL(version, store.update(entry, content_of(version)).version);
  CHECK_EQUAL(content_of(6).volume, store.find("create")->content.volume);
  CHECK_EQUAL(content_of(5).volume, store.find("create", 5)->content.volume);
  LONGS_EQUAL(6, store.history(entry.id).size());
  CHECK_FALSE(store.find("create", 1).has_value());  // content is kept for the newest
  CHECK_FALSE(store.history(entry.id)[0].has_content);
  CHECK_TRUE(store.history(entry.id)[2].has_content);
}

TEST(ModelStore, RenamesErasesAndRefusesTakenNames) {
  ModelStore store(path());
  const ModelEntry one = store.add(entry_named("one"), content_of(1));
  const ModelEntry two = store.add(entry_named("two"), content_of(2));
  CHECK_THROWS(Failure, store.add(entry_named("two"), content_of(3)));
  CHECK_THROWS(Failure, store.rename(one.id, "two"));
  store.erase(two.id);
  store.rename(one.id, "two");
  LONGS_EQUAL(1, store.list().size());
  STRCMP_EQUAL("two", store.list()[0].name.c_str());
  CHECK_TRUE(store.history(two.id).empty());
}

TEST(ModelStore, MergesWhatItDoesNotHave) {
  ModelStore store(path()), other(folder / "other.db");
  store.add(entry_named("create"), content_of(1));
  ModelEntry theirs = other.add(entry_named("create"), content_of(2));
  other.update(theirs, content_of(3));
  LONGS_EQUAL(1, store.merge(other));
  LONGS_EQUAL(0, store.merge(other));
  LONGS_EQUAL(2, store.list().size());
  CHECK_EQUAL(content_of(3).volume, store.find("create-2")->content.volume);
  CHECK_EQUAL(content_of(2).volume, store.find("create-2", 1)->content.volume);
}

TEST(ModelStore, TwoMayHaveItOpen) {
  ModelStore one(path()), other(path());
  one.add(entry_named("a"), content_of(1));
  other.add(entry_named("b"), content_of(2));
  LONGS_EQUAL(2, one.list().size());
}

TEST(ModelStore, RefusesForeignFilesAndLeavesThemAlone) {
  std::ofstream(path()) << "Dear diary, today I was no database at all. " << std::string(4096, '.');
  refused(path(), "no model database");
  {
    Database foreign(folder / "foreign.db", Database::Access::kCreate);
    foreign.run("CREATE TABLE bookmarks(url TEXT); PRAGMA application_id=77");
  }
  refused(folder / "foreign.db", "another program");
  { ModelStore store(folder / "newer.db"); }
  {
    Database newer(folder / "newer.db", Database::Access::kCreate);
    newer.run("PRAGMA user_version=99");
  }
  refused(folder / "newer.db", "newer startrack");
  CHECK_THROWS(Failure, ModelStore(folder.path()));
  CHECK_THROWS(Failure, ModelStore(folder / "no/such/folder/models.db"));
}

TEST(ModelStore, RefusesDamagedFilesAndLeavesThemAlone) {
  {
    ModelStore store(path());
    for (int i = 0; i < 20; ++i) store.add(entry_named(""), content_of(i, 20000));
  }
  const std::string whole = read_whole_file(path());
  int refusals = 0;
  for (std::size_t page = 0; page < 12; ++page) {
    std::string bytes = whole;
    for (std::size_t i = 0; i < 300; ++i)
      bytes[page * 4096 + (page == 0 ? 20 : 0) + i] = static_cast<char>(i * 7);
    const std::string name = folder / ("damaged-" + std::to_string(page));
    std::ofstream(name, std::ios::binary) << bytes;
    try {
      ModelStore store(name);
      for (const ModelEntry& entry : store.list()) store.find(entry.id);
    } catch (const Failure&) {
      ++refusals;
      if (read_whole_file(name) != bytes) FAIL("a refused file was touched");
    }
  }
  CHECK_TRUE(refusals >= 3);
  std::ofstream(folder / "cut", std::ios::binary) << whole.substr(0, whole.size() / 2);
  refused(folder / "cut", "damaged");
}

TEST(ModelStore, BringsAnOlderSchemaUpToDateAfterACopy) {
  {
    Database old(path(), Database::Access::kCreate);
    old.run(
        "CREATE TABLE model(id TEXT PRIMARY KEY, name TEXT NOT NULL UNIQUE, created TEXT NOT NULL,"
        " source TEXT NOT NULL, program TEXT NOT NULL, width_m REAL NOT NULL, depth_m REAL NOT NULL,"
        " height_m REAL NOT NULL, feature_count INTEGER NOT NULL, volume BLOB NOT NULL, features BLOB NOT "
        "NULL,"
        " statistics BLOB NOT NULL);"
        "INSERT INTO model VALUES('00ff', 'create', '2024-03-09T08:07:06Z', 'lab', '0.0.9', 0.34, 0.33, "
        "0.09, 7,"
        " x'01', x'02', x'03');"
        "PRAGMA application_id=1400130916; PRAGMA user_version=1");
  }
  ModelStore store(path());
  const auto model = store.find("create");
  CHECK_TRUE(model.has_value());
  STRCMP_EQUAL("00ff", model->entry.id.c_str());
  DOUBLES_EQUAL(0.34, model->entry.width_m, 1e-12);
  STRCMP_EQUAL("\x02", model->content.features.c_str());
  LONGS_EQUAL(2, store.update(model->entry, content_of(4)).version);
  Database copy(path() + ".schema-1", Database::Access::kRead);
  LONGS_EQUAL(1, copy.number("PRAGMA user_version"));
  LONGS_EQUAL(7, copy.number("SELECT feature_count FROM model"));
}

// A child saves without end; it is killed at a random moment, a hundred times.
TEST(ModelStore, AKilledProgramLeavesTheOldOrTheNew) {
  {
    ModelStore store(path());
    store.add(entry_named("robot"), content_of(0, 300000));
  }
  int versions_seen = 0, last = 1;
  for (int round = 0; round < 100; ++round) {
    const pid_t child = fork();
    if (child == 0) {
      ModelStore store(path());
      ModelEntry entry = store.find("robot")->entry;
      for (;;) entry = store.update(entry, content_of(entry.version, 300000));
    }
    usleep(static_cast<useconds_t>(1000 + 1777 * round % 29000));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    ModelStore store(path());
    const auto model = store.find("robot");
    CHECK_TRUE(model.has_value());
    const ModelContent expected = content_of(model->entry.version - 1, 300000);
    CHECK_TRUE(model->content.volume == expected.volume && model->content.features == expected.features &&
               model->content.statistics == expected.statistics);
    versions_seen += model->entry.version > last ? 1 : 0;
    last = model->entry.version;
  }
  CHECK_TRUE(versions_seen > 10);  // it was killed while it saved, not before
}

TEST(ModelStore, CompressedBytesComeBackAndDamageShows) {
  std::string content(100000, '\0');
  for (std::size_t i = 0; i < content.size(); ++i) content[i] = static_cast<char>(i * i >> 7);
  std::string packed = compress_bytes(content);
  CHECK_TRUE(packed.size() < content.size());
  CHECK_TRUE(content == expand_bytes(packed, content.size(), "m"));
  CHECK_THROWS(Failure, expand_bytes(packed, content.size() - 1, "m"));
  for (std::size_t at : {std::size_t{2}, std::size_t{20}, packed.size() / 2, packed.size() - 1}) {
    std::string damaged = packed;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x15);
    CHECK_THROWS(Failure, expand_bytes(damaged, content.size(), "m"));
  }
  CHECK_THROWS(Failure, expand_bytes("abc", 100, "m"));
}
