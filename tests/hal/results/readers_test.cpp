#include <CppUTest/TestHarness.h>

#include "hal/error.hpp"
#include "hal/results/csv_table.hpp"
#include "hal/results/duration_histogram.hpp"
#include "hal/results/object_files.hpp"
#include "hal/results/tum_file.hpp"

using namespace st;

TEST_GROUP(CsvTable){
    static std::string refusal(const std::string& text){try {const CsvTable table = parse_csv(text, "t.csv");
for (std::size_t i = 0; i < table.rows(); ++i) table.number(i, table.column("b"));
}
catch (const Failure& failure) {
  return failure.what();
}
return {};
}
}
;

TEST(CsvTable, ReadsRowsEmptyFieldsAndForeignLineEnds) {
  const CsvTable table = parse_csv("a,b\r\n1,2\r\n,4\r\n", "t.csv");
  LONGS_EQUAL(2, table.rows());
  DOUBLES_EQUAL(4, table.number(1, 1), 0);
  DOUBLES_EQUAL(-1, table.number(1, 0, -1), 0);
}

TEST(CsvTable, SaysWhatIsWrongAndWhere) {
  STRCMP_CONTAINS("t.csv: line 3", refusal("a,b\n1,2\n1,2,3\n1,2\n").c_str());
  STRCMP_CONTAINS("row 1, column b: 'x'", refusal("a,b\n1,x\n").c_str());
  STRCMP_CONTAINS("column b: 'nan'", refusal("a,b\n1,nan\n").c_str());
  STRCMP_CONTAINS("no column 'b'", refusal("a,c\n1,2\n").c_str());
  STRCMP_CONTAINS("is empty", refusal("").c_str());
}

TEST(CsvTable, ALastLineThatWasCutIsLeftOut) {
  LONGS_EQUAL(1, parse_csv("a,b\n1,2\n3", "t.csv").rows());
  LONGS_EQUAL(1, parse_csv("a,b\n1,2\n3,4", "t.csv").rows());
}

TEST(CsvTable, AWrongStateIsRefused) {
  const std::string header = std::string(kObjectColumns) + "\n";
  CHECK_THROWS(Failure, parse_object_csv(header + "1,happy" + std::string(28, ',') + "\n", "o.csv"));
  LONGS_EQUAL(0, parse_object_csv(header, "o.csv").size());
}

TEST_GROUP(TumFile){};

TEST(TumFile, TakesCommentsCommasAndTracksAndDropsWhatIsBad) {
  const TumTrajectory read = parse_tum(
      "# a comment\n2 1 2 3 0 0 0 1\n1, 4, 5, 6, 0, 0, 0, 2, b\n3 1 2 3 0 0 0 0\n4 1 2 nan 0 0 0 1\n5 1 "
      "2\nhello\n\n6 0 0 0 0 0 1 0");
  LONGS_EQUAL(3, read.poses.size());
  LONGS_EQUAL(4, read.dropped_lines);
  DOUBLES_EQUAL(1, read.poses[0].t_s, 0);
  STRCMP_EQUAL("b", read.poses[0].track.c_str());
  DOUBLES_EQUAL(1, read.poses[0].T.R(0, 0), 1e-15);
  DOUBLES_EQUAL(-1, read.poses[2].T.R(0, 0), 1e-15);
}

TEST_GROUP(DurationHistogram){};

TEST(DurationHistogram, PercentilesAreThoseOfTheValues) {
  DurationHistogram histogram;
  for (int i = 1; i <= 10000; ++i) histogram.add(i);
  const DurationSummary s = histogram.summary();
  DOUBLES_EQUAL(5000, s.p50_us, 5);
  DOUBLES_EQUAL(9900, s.p99_us, 10);
  DOUBLES_EQUAL(9990, s.p999_us, 10);
  DOUBLES_EQUAL(10000, s.max_us, 0);
}

TEST(DurationHistogram, ShortAndHugeValuesFit) {
  DurationHistogram histogram;
  histogram.add(3.2);
  DOUBLES_EQUAL(3.2, histogram.summary().p50_us, 1e-9);
  histogram.add(4e9);
  histogram.add(4e9);
  DOUBLES_EQUAL(4e9, histogram.summary().max_us, 0);
  CHECK(histogram.summary().p50_us > 1e6);
  DOUBLES_EQUAL(0, DurationHistogram().summary().p999_us, 0);
}
