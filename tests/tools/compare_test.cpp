// tools/compare, as a person calls it: one table, a row for every tracker.
#include <cstdlib>
#include <string>

#include "tests/replay/driven_circle.hpp"
#include "tests/support/program.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::test;

TEST_GROUP(CompareScript) {
  TempFolder folder;

  std::string table(const std::string& arguments, int code = 0) {
    const std::string out = folder / "table";
    const std::string command = "STARTRACK_DATA= STARTRACK='" STARTRACK_BINARY "' '" STARTRACK_SOURCE_DIR
                                "/tools/compare' --out '" +
                                (folder / "runs") + "' " + arguments + " > '" + out + "' 2>&1";
    LONGS_EQUAL_TEXT(code, WEXITSTATUS(std::system(command.c_str())), content(out).c_str());
    return content(out);
  }
};

TEST(CompareScript, PrintsARowWithEveryFigureForEachTracker) {
  const std::string text = table("'" + driven_circle() + "'");
  LONGS_EQUAL_TEXT(7, lines_of(text), text.c_str());  // two lines of heading
  for (const char* tracker :
       {"| frame to frame |", "| frame to frame, keyframes every 15 |",
        "| closest point to model (Listing 1) |", "| projective ICP alone |", "| full estimator |"})
    STRCMP_CONTAINS(tracker, text.c_str());
  std::size_t bars = 0;
  for (const char c : text) bars += c == '|' ? 1 : 0;
  LONGS_EQUAL_TEXT(7 * 14, bars, text.c_str());  // thirteen columns, all of them filled
  CHECK_TEXT(text.find("| - ") == std::string::npos && text.find("|  |") == std::string::npos, text.c_str());
}

TEST(CompareScript, RefusesWhatItDoesNotKnow) { STRCMP_CONTAINS("--help", table("--fast", 2).c_str()); }
