// The whole recognition, from a volume to its answer, on things with known shapes.
#include "algo/recognition/recognition.hpp"

#include "algo/core/scalar_math.hpp"
#include "tests/algo/volume/analytic_view.hpp"
#include "tests/support/bound.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;
using namespace st::test;

namespace {

constexpr double kPitch = 0.6;

// A print of patches that has one heading only.
std::uint32_t print_at(const Vec3& p) {
  std::uint8_t grey = 90;
  const double patches[][2] = {{0.06, 0.03}, {-0.04, 0.07}, {0.01, -0.06},  {-0.09, -0.03}, {0.10, -0.05},
                               {0.0, 0.015}, {0.03, 0.11},  {-0.07, -0.09}, {0.055, -0.11}, {-0.11, 0.045}};
  for (const auto& at : patches) {
    const double x = p.x - at[0], y = p.y - at[1];
    if (x * x + y * y < 0.016 * 0.016) grey = 230;
  }
  return pack_rgb(grey, grey, grey);
}

// A volume of a thing that was seen from these sides, and the thing as a known model.
struct Thing {
  Thing(const Solid& solid, const std::vector<double>& yaws, bool printed = true) : bench(128) {
    bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
    std::mt19937 random(9);
    Rendering how;
    how.noise = 0.3;
    if (printed) how.paint = print_at;
    for (const double yaw : yaws) bench.fuse(render(solid, looking_at(1.1, yaw, kPitch), how, random));
  }
  KnownModel known() {
    bricks.resize(count_packed(bench.volume));
    Recognition describer;
    const BoundMemory memory([&](Bump& bump) { describer.bind(bump, 128); });
    const FeatureSet set = describer.describe(bench.volume);
    features.assign(set.features.begin(), set.features.end());
    descriptors.assign(set.descriptors.begin(), set.descriptors.end());
    KnownModel model;
    model.volume = pack(bench.volume, bricks);
    model.features = {features, descriptors};
    std::vector<SurfacePoint> points(kFitPoints);
    std::vector<Vec3f> scratch(kFitPoints);
    model.traits.bounds = sample_surface(bench.volume, points, scratch).bounds;
    model.traits.color = color_stats(bench.volume);
    return model;
  }
  Bench bench;
  std::vector<PackedBrick> bricks;
  std::vector<Feature> features;
  std::vector<Descriptor> descriptors;
};

std::vector<double> all_round(double first) {
  std::vector<double> yaws;
  for (int i = 0; i < 12; ++i) yaws.push_back(first + 2 * kPi * i / 12);
  return yaws;
}

struct Answer {
  Recognised best;
  int frames = 0;
};

Answer recognise(std::span<const KnownModel> models, const Thing& thing, double yaw,
                 RecognitionWay way = RecognitionWay::kMatchesAndHeadings) {
  Recognition recognition;
  const BoundMemory memory([&](Bump& bump) { recognition.bind(bump, 128); });
  RecognitionSubject subject;
  subject.volume = &thing.bench.volume;
  subject.towards = to_float(normalized(Vec3{-sin_cos(yaw).sin, -sin_cos(yaw).cos, 0}));
  constexpr bool kNone[kMaxKnownModels]{};
  recognition.start(models, kNone, subject, way);
  Answer answer;
  for (answer.frames = 1; !recognition.advance(Recognition::kUnitsPerFrame); ++answer.frames) {
  }
  answer.best = recognition.best();
  return answer;
}

}  // namespace

TEST_GROUP(Recognition){};

TEST(Recognition, KnowsWhichOfTwoItIsAndHowItStands) {
  Thing disc(Disc(0.15, 0.05), all_round(0)), box(Box({0.14, 0.12, 0.05}), all_round(0));
  const KnownModel models[] = {disc.known(), box.known()};
  CHECK_TRUE(models[0].features.features.size() >= 5);
  const Thing disc_again(Disc(0.15, 0.05), {2.1, 2.2, 2.3}),
      box_again(Box({0.14, 0.12, 0.05}), {0.7, 0.8, 0.9});
  const Answer a = recognise(models, disc_again, 2.2), b = recognise(models, box_again, 0.8);
  LONGS_EQUAL(0, a.best.model);
  LONGS_EQUAL(1, b.best.model);
  for (const Answer* answer : {&a, &b}) {
    CHECK_TRUE(is_sure_model(answer->best));
    // Any other heading has a print that is clearly another one.
    for (const VolumeFit& other : answer->best.other_headings)
      CHECK_TRUE(other.score() < answer->best.fit.score() - 0.05f);
    CHECK_TRUE(norm(answer->best.fit.T_model_seen.t) < 0.006);
    CHECK_TRUE(rotation_angle(answer->best.fit.T_model_seen.R) < 0.06);
    CHECK_TRUE(answer->frames <= 35);
  }
}

// One thing that came into the database twice is known all the same; two that share no more than their shape
// are not told apart, and neither is given out.
TEST(Recognition, ATwinInTheDatabaseDoesNotMakeItUnknown) {
  Thing disc(Disc(0.15, 0.05), all_round(0)), again(Disc(0.15, 0.05), all_round(0.1));
  const KnownModel models[] = {disc.known(), again.known()};
  const Thing seen(Disc(0.15, 0.05), {2.1, 2.2, 2.3});
  CHECK_TRUE(is_sure_model(recognise(models, seen, 2.2).best));
}

TEST(Recognition, TwoPlainThingsOfOneShapeAreNotToldApart) {
  Thing disc(Disc(0.15, 0.05), all_round(0), false), again(Disc(0.15, 0.05), all_round(0.1), false);
  const KnownModel models[] = {disc.known(), again.known()};
  const Thing seen(Disc(0.15, 0.05), {2.1, 2.2, 2.3}, false);
  CHECK_FALSE(is_sure_model(recognise(models, seen, 2.2).best));
}

TEST(Recognition, WhatIsNotThereIsUnknown) {
  Thing disc(Disc(0.15, 0.05), all_round(0));
  const KnownModel models[] = {disc.known()};
  const Thing other(Box({0.12, 0.13, 0.05}), {0.2, 0.3, 0.4});
  CHECK_FALSE(is_sure_model(recognise(models, other, 0.3).best));
  const Thing small(Box({0.04, 0.04, 0.04}), {0.2});
  LONGS_EQUAL(-1, recognise(models, small, 0.2).best.model);  // the gate
}

// Seen from other sides than the model was.
TEST(Recognition, MatchesAloneGiveThePoseOfAPrintedDisc) {
  Thing disc(Disc(0.15, 0.05), all_round(0));
  const KnownModel models[] = {disc.known()};
  const Thing again(Disc(0.15, 0.05), all_round(0.25));
  const Recognised best = recognise(models, again, 0, RecognitionWay::kMatchesAlone).best;
  CHECK_TRUE(best.agreeing >= 3);
  CHECK_TRUE(rotation_angle(best.T_model_seen_matched.R) < 0.1);
  CHECK_TRUE(norm(best.T_model_seen_matched.t) < 0.012);
}
