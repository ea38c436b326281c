#include "hal/create/sim_state_file.hpp"

#include "hal/error.hpp"
#include "tests/hal/create/processes.hpp"

// Last: it redefines new.
#include <CppUTest/TestHarness.h>

using namespace st;

TEST_GROUP(SimStateFile){};

TEST(SimStateFile, HoldsTheLastEntriesAndOnlyThose) {
  const TempFolder folder;
  SimStateWriter writer(folder.file("state"));
  const SimStateReader reader(folder.file("state"));
  SimStateEntry entry;
  CHECK_FALSE(reader.newest(entry));
  for (int i = 0; i < 3000; ++i) {
    entry.x_m = i;
    writer.publish(entry);
  }
  UNSIGNED_LONGS_EQUAL(3000, reader.written());
  CHECK(reader.newest(entry));
  DOUBLES_EQUAL(2999, entry.x_m, 0);
  CHECK(reader.entry(3000 - SimStateRing::kEntries + 1, entry));
  DOUBLES_EQUAL(3000.0 - SimStateRing::kEntries + 1, entry.x_m, 0);
  CHECK_FALSE(reader.entry(100, entry));
}

TEST(SimStateFile, SaysWhenThereIsNoRobotBehindIt) {
  const TempFolder folder;
  CHECK_THROWS(Failure, SimStateReader(folder.file("none")));
  CHECK_THROWS(Failure, SimStateReader(folder.file("short", "not a state")));
  CHECK_THROWS(Failure, SimStateReader(folder.file("foreign", std::string(sizeof(SimStateRing), 'x'))));
  CHECK_THROWS(Failure, SimStateWriter("/nonexistent/state"));
}
