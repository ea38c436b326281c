#include "firmware_like/path_file.hpp"

#include <CppUTest/TestHarness.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "algo/core/scalar_math.hpp"
#include "hal/error.hpp"
#include "hal/sim/random.hpp"

using namespace st;

namespace {

const std::string kExamples = std::string(STARTRACK_SOURCE_DIR) + "/examples/paths/";

std::string refusal(const std::string& text, bool csv = false) {
  try {
    csv ? parse_path_csv(text, "p") : parse_path_toml(text, "p");
  } catch (const Failure& failure) {
    LONGS_EQUAL(2, static_cast<int>(failure.code()));
    return failure.what();
  }
  return "accepted";
}

void check_refusal(const char* text, const char* line, const char* word, bool csv = false) {
  const std::string message = refusal(text, csv);
  STRCMP_CONTAINS(line, message.c_str());
  STRCMP_CONTAINS(word, message.c_str());
}

}  // namespace

TEST_GROUP(PathFile){};

TEST(PathFile, ExamplesAreWhatTheirNamesSay) {
  const Path circle = load_path(kExamples + "circle-0.5.toml");
  DOUBLES_EQUAL(2 * kPi * 0.5, circle.length_m(), 1e-9);
  const Path square = load_path(kExamples + "square-1m.toml");
  UNSIGNED_LONGS_EQUAL(8, square.size());
  DOUBLES_EQUAL(4.0, square.length_m(), 1e-9);
  const Path eight = load_path(kExamples + "figure-eight.toml");
  UNSIGNED_LONGS_EQUAL(4, eight.size());
  DOUBLES_EQUAL(0.0, sample(eight, eight.duration_s()).yaw_rad, 1e-9);
  const Path way = load_path(kExamples + "waypoints.csv");
  const PathSample end = sample(way, way.duration_s());
  DOUBLES_EQUAL(0.0, std::hypot(end.x_m, end.y_m), 1e-9);
}

TEST(PathFile, EveryExampleCanBeDriven) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kExamples)) {
    const Path path = load_path(entry.path().string());
    CHECK(path.duration_s() > 1 && path.fastest_wheel_mps(0.26) <= 0.5);
    ++count;
  }
  CHECK(count >= 8);
  for (const char* closed : {"triangle.toml", "umbmark-left.toml", "umbmark-right.toml",
                             "there-and-back.toml", "clover.toml", "figure-eight.toml"}) {
    const Path path = load_path(kExamples + closed);
    const PathSample end = sample(path, path.duration_s());
    DOUBLES_EQUAL_TEXT(0.0, std::hypot(end.x_m, end.y_m), 1e-6, closed);
  }
}

TEST(PathFile, PolygonsAndEightsAreSumsOfLinesTurnsAndArcs) {
  const Path hexagon =
      parse_path_toml("[[step]]\npolygon = { sides = 6, side_m = 0.5, direction = \"right\" }\n", "p");
  UNSIGNED_LONGS_EQUAL(12, hexagon.size());
  DOUBLES_EQUAL(3.0, hexagon.length_m(), 1e-12);
  DOUBLES_EQUAL(-2 * kPi, sample(hexagon, hexagon.duration_s()).yaw_rad, 1e-9);
  const Path eight = parse_path_toml("[[step]]\nfigure_eight = { radius_m = 0.4 }\n", "p");
  UNSIGNED_LONGS_EQUAL(2, eight.size());
  DOUBLES_EQUAL(4 * kPi * 0.4, eight.length_m(), 1e-9);
}

TEST(PathFile, APathThatLeavesItsAreaIsRefusedWithTheStepThatDoes) {
  const char* area = "area = { x_m = [-0.3, 1.2], y_m = [-0.3, 0.3] }\n";
  STRCMP_EQUAL("accepted", refusal(std::string(area) + "[[step]]\nline = 1\n").c_str());
  check_refusal("area = { x_m = [-0.3, 1.2], y_m = [-0.3, 0.3] }\n[[step]]\nline = 1\n[[step]]\nline = 0.1\n",
                "p:5: ", "would leave the area at x 1.1");
  // The ends of an arc may lie within it, and the way between them not.
  check_refusal(
      "area = { x_m = [-0.3, 0.3], y_m = [-0.3, 2.3] }\n[[step]]\narc = { radius_m = 1, angle_deg = 180 }\n",
      "p:3: ", "would leave");
  check_refusal("area = { x_m = [-0.1, 1], y_m = [-1, 1] }\n[[step]]\nwait = 1\n", "p:3: ", "would leave");
  check_refusal("area = { x_m = [1, -1], y_m = [0, 1] }\n[[step]]\nline = 1\n", "p:1: ", "smaller");
  check_refusal("area = { x_m = [1], y_m = [0, 1] }\n[[step]]\nline = 1\n", "p:1: ", "[least, most]");
  check_refusal("area = { x_m = [0, 1] }\n[[step]]\nline = 1\n", "p:1: ", "y_m is missing");
  check_refusal("[[step]]\npolygon = { sides = 2, side_m = 1 }\n", "p:2: ", "3 to 36");
  check_refusal("[[step]]\npolygon = { sides = 4.5, side_m = 1 }\n", "p:2: ", "whole number");
}

TEST(PathFile, ReadsEveryStep) {
  const Path path = parse_path_toml(
      "speed_mps = 0.3\naccel_mps2 = 0.5\nturn_deg_per_s = 45\n"
      "[[step]]\nline = 1\n[[step]]\nturn = -90\n[[step]]\nwait = 2.5\n"
      "[[step]]\narc = { radius_m = 0.4, angle_deg = 180 }\n"
      "[[step]]\ncircle = { radius_m = 0.5, turns = 2, direction = \"right\" }\n"
      "[[step]]\nrepeat = { times = 3, steps = [ { line = 0.5 }, { turn = 120 } ] }\n",
      "p");
  UNSIGNED_LONGS_EQUAL(5 + 6, path.size());
  DOUBLES_EQUAL(0.3, path.limits.speed_mps, 0);
  DOUBLES_EQUAL(kPi / 4, path.limits.turn_rps, 1e-12);
  DOUBLES_EQUAL(-kPi / 2, path.segment(2).start.yaw_rad, 1e-12);
  DOUBLES_EQUAL(-kPi / 2 + kPi, path.segment(4).start.yaw_rad, 1e-12);
  DOUBLES_EQUAL(-kPi / 2 + kPi - 4 * kPi, path.segment(5).start.yaw_rad, 1e-9);
  DOUBLES_EQUAL(-4 * kPi + kPi / 2 + 2 * kPi, sample(path, path.duration_s()).yaw_rad, 1e-9);
}

TEST(PathFile, WayPointsAreDrivenInTheFrameOfTheStart) {
  const Path path = parse_path_csv("# lab\r\nx, y\r\n0,0\r\n1,0\r\n\r\n1,-1\r\n", "p");
  const PathSample end = sample(path, path.duration_s());
  DOUBLES_EQUAL(1.0, end.x_m, 1e-12);
  DOUBLES_EQUAL(-1.0, end.y_m, 1e-12);
  DOUBLES_EQUAL(-kPi / 2, end.yaw_rad, 1e-12);
}

TEST(PathFile, SaysWhereAndWhatAndWhatIsAllowed) {
  check_refusal("[[step]]\nline = 1.0\n[[step]]\nlien = 1.0\n", "p:4: ", "allowed: line, turn");
  check_refusal("[[step]]\ncircle = { radius_m = 0.5, turn = 1 }\n",
                "p:2: ", "`turn` is not known; allowed: radius_m, turns, direction");
  check_refusal("[[step]]\ncircle = { turns = 1 }\n", "p:2: ", "radius_m is missing");
  check_refusal("speed = 1\n[[step]]\nline = 1\n", "p:1: ", "speed_mps");
  check_refusal("speed_mps = 0.9\n[[step]]\nline = 1\n", "p:1: ", "0.01 to 0.5");
  check_refusal("[[step]]\nline = \"far\"\n", "p:2: ", "must be a number");
  check_refusal("[[step]]\nline = nan\n", "p:2: ", "allowed");
  check_refusal("[[step]]\nline = 0\n", "p:2: ", "moves nothing");
  check_refusal("[[step]]\nline = 1\nturn = 90\n", "p:1: ", "exactly one");
  check_refusal("[[step]\nline = 1\n", "p:1: ", "p:1: ");
  check_refusal("", "p:1: ", "no steps");
  check_refusal("step = 3\n", "p:1: ", "step");
  check_refusal("[[step]]\nsquare = { side_m = 1, direction = \"up\" }\n", "p:2: ", "\"left\" or \"right\"");
  check_refusal("[[step]]\nrepeat = { times = 2.5, steps = [ { line = 1 } ] }\n", "p:2: ", "whole number");
  check_refusal("[[step]]\nrepeat = { times = 500, steps = [ { line = 1 }, { turn = 9 } ] }\n",
                "p:2: ", "512");
  check_refusal("speed_mps = 0.45\n[[step]]\ncircle = { radius_m = 0.5 }\n",
                "p:3: ", "0.5 is the robot's most");
}

TEST(PathFile, RefusesNonsenseInWayPoints) {
  check_refusal("0,0\n1,1\n", "p:1: ", "x,y", true);
  check_refusal("x,y\n1\n", "p:2: ", "not a point", true);
  check_refusal("x,y\n1,2,3\n", "p:2: ", "not a point", true);
  check_refusal("x,y\n1,nan\n", "p:2: ", "not a point", true);
  check_refusal("x,y\n0,0\n", "p:2: ", "no way points", true);
  check_refusal("", "p:0: ", "no way points", true);
}

TEST(PathFile, NamesAFileThatIsNotThere) {
  try {
    load_path("/nonexistent/p.toml");
    FAIL("accepted");
  } catch (const Failure& failure) {
    STRCMP_CONTAINS("/nonexistent/p.toml", failure.what());
    LONGS_EQUAL(2, static_cast<int>(failure.code()));
  }
}

// Whatever is typed: a path that can be driven, or a refusal.
TEST(PathFile, AnyTextIsAPathOrARefusal) {
  const std::string good =
      "speed_mps = 0.2\n[[step]]\nline = 1.0\n[[step]]\nrepeat = { times = 3, steps = [ {line=0.5}, "
      "{turn=120} ] }\n"
      "[[step]]\ncircle = { radius_m = 0.5, turns = 1 }\n";
  sim::Random random(17);
  for (int trial = 0; trial < 3000; ++trial) {
    std::string text = good;
    for (int k = 1 + random.below(6); k > 0; --k) {
      const std::size_t at = static_cast<std::size_t>(random.below(static_cast<int>(text.size())));
      const char c = static_cast<char>(
          random.below(4) == 0 ? random.below(256)
                               : good[static_cast<std::size_t>(random.below(static_cast<int>(good.size())))]);
      if (random.below(2) == 0)
        text[at] = c;
      else
        text.insert(at, 1, c);
    }
    try {
      const Path path = parse_path_toml(text, "p");
      CHECK(std::isfinite(path.duration_s()) && path.duration_s() >= 0);
      CHECK(path.fastest_wheel_mps(0.26) <= 0.5);
    } catch (const Failure&) {
    }
    try {
      parse_path_csv("x,y\n" + text, "p");
    } catch (const Failure&) {
    }
  }
}
