#include "hal/sim/things.hpp"

#include <cmath>
#include <string>

#include "hal/error.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new breaks the headers of the standard library

using namespace st;
using namespace st::sim;

namespace {

struct Size {
  float high_m = 0, least_z_m = 1;
};
Size size_of(const Mesh& mesh) {
  Size size;
  for (const Vertex& v : mesh.vertices) {
    size.high_m = std::fmax(size.high_m, v.position.z);
    size.least_z_m = std::fmin(size.least_z_m, v.position.z);
  }
  return size;
}

std::string refusal(const std::string& text) {
  try {
    parse_thing(text);
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kBadInput), static_cast<int>(failure.code()));
    return failure.what();
  }
  return {};
}

}  // namespace

TEST_GROUP(Things){};

TEST(Things, EveryNumberIsAThingOfItsOwnThatStandsOnTheFloor) {
  Vec3f last{};
  for (std::uint64_t number = 1; number <= 40; ++number) {
    const Mesh mesh = make_thing({number, 0, 1, false});
    const double radius_m = radius_of(mesh);
    CHECK_TRUE(mesh.faces.size() > 8);
    CHECK_TRUE(radius_m > 0.05 && radius_m < 0.32);
    const Size size = size_of(mesh);
    DOUBLES_EQUAL(0, size.least_z_m, 1e-6);
    CHECK_TRUE(size.high_m > 0.05f && size.high_m < 0.4f);
    Vec3f sum{};
    for (const Vertex& v : mesh.vertices) sum += v.position;
    CHECK_TRUE(norm(sum - last) > 0);
    last = sum;
  }
}

TEST(Things, TheSameNumberIsTheSameThingAndItsRelationsDiffer) {
  const Mesh one = make_thing({12, 0, 1, false}), again = make_thing({12, 0, 1, false});
  const Mesh mirrored = make_thing({12, 0, 1, true}), larger = make_thing({12, 0, 1.12, false});
  const Mesh reprinted = make_thing({12, 7, 1, false});
  LONGS_EQUAL(one.vertices.size(), again.vertices.size());
  LONGS_EQUAL(one.vertices.size(), reprinted.vertices.size());
  for (std::size_t i = 0; i < one.vertices.size(); ++i) {
    const Vec3f p = one.vertices[i].position;
    DOUBLES_EQUAL(0, norm(p - again.vertices[i].position), 0);
    DOUBLES_EQUAL(0, norm(p - reprinted.vertices[i].position), 0);
    DOUBLES_EQUAL(-p.y, mirrored.vertices[i].position.y, 0);
    DOUBLES_EQUAL(1.12 * p.z, larger.vertices[i].position.z, 1e-6);
  }
}

TEST(Things, WhatIsNoThingIsRefusedWithTheReason) {
  const ThingSpec spec = parse_thing("12:print=7,scale=1.12,mirror");
  LONGS_EQUAL(12, spec.number);
  LONGS_EQUAL(7, spec.print);
  DOUBLES_EQUAL(1.12, spec.scale, 1e-12);
  CHECK_TRUE(spec.mirrored);
  STRCMP_CONTAINS("is no number", refusal("lamp").c_str());
  STRCMP_CONTAINS("0.5 to 2", refusal("3:scale=9").c_str());
  STRCMP_CONTAINS("'blue' is not known", refusal("3:blue").c_str());
  STRCMP_CONTAINS("is no number", refusal("").c_str());
}
