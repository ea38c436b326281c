#include "algo/volume/raycast.hpp"

#include <cstring>

#include "algo/core/scalar_math.hpp"
#include "algo/core/simd.hpp"
#include "tests/algo/volume/analytic_view.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;
using namespace st::test;

namespace {

std::uint32_t checks(const Vec3& p) { return p.x > 0 ? pack_rgb(220, 60, 20) : pack_rgb(40, 90, 200); }

struct Comparison {
  int truth = 0, hits = 0, false_hits = 0;
  double mean_z_m = 0, worst_z_m = 0, mean_angle = 0;
};

// The view of the model beside the analytic one.
Comparison compare(const Bench& bench, const Solid& solid, const Pose& T, const Pinhole& camera) {
  Comparison c;
  const Pose back = T.inverse();
  for (int v = bench.maps.roi.v0; v < bench.maps.roi.v1; ++v)
    for (int u = bench.maps.roi.u0; u < bench.maps.roi.u1; ++u) {
      const Vec3 along = back.R * to_double(camera.ray(static_cast<float>(u), static_cast<float>(v)));
      const double z = solid.enter(back.t, along);
      const std::size_t i = bench.maps.at(u, v);
      const double found = static_cast<double>(bench.maps.z[i]);
      c.truth += z > 0 ? 1 : 0;
      if (found <= 0) continue;
      if (z <= 0) {
        ++c.false_hits;
        continue;
      }
      ++c.hits;
      c.mean_z_m += std::fabs(found - z);
      c.worst_z_m = std::fmax(c.worst_z_m, std::fabs(found - z));
      const Vec3 n = T.R * solid.normal(back.t + along * z);
      c.mean_angle +=
          std::sqrt(std::fmax(0.0, 2 - 2 * dot(n, to_double(unpack_normal(bench.maps.normal[i])))));
    }
  c.mean_z_m /= c.hits;
  c.mean_angle /= c.hits;
  return c;
}

}  // namespace

TEST_GROUP(Raycast) {
  std::mt19937 random{2};
  Rendering how;
  Bench bench{96};

  void setup() override {
    how.paint = checks;
    bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
  }
  void teardown() override { select_simd(nullptr); }

  View fuse_turns(const Solid& solid, int views) {
    View view;
    for (int i = 0; i < views; ++i) {
      view = render(solid, looking_at(0.9, 0.6 * i, 0.3 + 0.1 * (i % 4)), how, random);
      bench.fuse(view);
    }
    return view;
  }
  RaycastStats cast(const View& view, const Pose& T, const Pinhole& camera) {
    const Rect roi = visible_rect(bench.volume, camera, T);
    (void)view;
    return raycast(bench.volume, camera, roi, T, bench.raycasting, bench.maps);
  }
};

TEST(Raycast, AFusedBallLooksLikeTheAnalyticOneFromANewDirection) {
  const Sphere ball(0.12);
  const View view = fuse_turns(ball, 12);
  const Pose T = looking_at(0.8, 0.33, 0.45);
  const RaycastStats stats = cast(view, T, view.camera);
  const Comparison c = compare(bench, ball, T, view.camera);
  LONGS_EQUAL(c.hits + c.false_hits, stats.hits);
  CHECK(c.hits > 0.95 * c.truth);
  CHECK(c.false_hits < 0.02 * c.truth);
  CHECK(c.mean_z_m < 0.0002);
  CHECK(c.mean_angle < 0.025);
}

TEST(Raycast, ABoxKeepsItsFacesAndItsColours) {
  const Box box({0.1, 0.08, 0.06});
  const View view = fuse_turns(box, 12);
  const Pose T = looking_at(0.8, 0.5, 0.5);
  cast(view, T, view.camera);
  const Comparison c = compare(bench, box, T, view.camera);
  CHECK(c.hits > 0.95 * c.truth);
  CHECK(c.mean_z_m < 0.0008);
  const Pose back = T.inverse();
  int colored = 0, wrong = 0;
  for (int v = bench.maps.roi.v0; v < bench.maps.roi.v1; ++v)
    for (int u = bench.maps.roi.u0; u < bench.maps.roi.u1; ++u) {
      const std::size_t i = bench.maps.at(u, v);
      if (alpha_of(bench.maps.color[i]) == 0) continue;
      const Vec3 p = back * (to_double(view.camera.ray(static_cast<float>(u), static_cast<float>(v))) *
                             static_cast<double>(bench.maps.z[i]));
      if (std::fabs(p.x) < 0.006) continue;  // the border of the paint
      ++colored;
      const std::uint32_t truth = checks(p);
      if (std::abs(red_of(truth) - red_of(bench.maps.color[i])) > 6 ||
          std::abs(blue_of(truth) - blue_of(bench.maps.color[i])) > 6)
        ++wrong;
      CHECK(bench.maps.weight[i] > 0);
    }
  CHECK(colored > 0.8 * c.truth);
  CHECK(wrong < colored / 200);
}

TEST(Raycast, ACoarserCameraSeesTheSameSurface) {
  const Sphere ball(0.12);
  const View view = fuse_turns(ball, 12);
  const Pose T = looking_at(0.8, 0.33, 0.45);
  for (int step : {2, 4}) {
    const Pinhole coarse = coarser(view.camera, step);
    cast(view, T, coarse);
    const Comparison c = compare(bench, ball, T, coarse);
    CHECK(c.truth > 40000 / (step * step * 2));
    CHECK(c.hits > 0.95 * c.truth);
    CHECK(c.mean_z_m < 0.0004);
  }
}

TEST(Raycast, AGuessNearTheSurfaceFindsWhatTheMarchFinds) {
  const Sphere ball(0.12);
  const View view = fuse_turns(ball, 12);
  const Pose T = looking_at(0.8, 0.33, 0.45);
  cast(view, T, view.camera);
  const std::vector<float> marched(bench.maps.z.begin(), bench.maps.z.end());
  const Rect roi = bench.maps.roi;
  how.noise = 1;
  const View seen = render(ball, T, how, random);
  std::vector<float> guess = seen.depth;
  guess.resize(guess.size() + 16);
  RaycastOptions options;
  options.guess = {guess.data(), view.camera.width, view.camera.height};
  raycast(bench.volume, view.camera, roi, T, bench.raycasting, bench.maps, options);
  int both = 0, marched_only = 0, elsewhere = 0;
  for (int v = roi.v0; v < roi.v1; ++v)
    for (int u = roi.u0; u < roi.u1; ++u) {
      const std::size_t i = bench.maps.at(u, v);
      if (!(marched[i] > 0)) continue;
      if (!(bench.maps.z[i] > 0)) {
        ++marched_only;
        continue;
      }
      ++both;
      elsewhere += std::fabs(bench.maps.z[i] - marched[i]) > 0.0005f ? 1 : 0;
    }
  CHECK(both > 10000);
  CHECK(marched_only < both / 50);  // at the outline, where the guess is the wall
  CHECK(elsewhere < both / 25);     // an eighth of a voxel off, at grazing rays
}

TEST(Raycast, OnlyWhatIsNearItsGuessIsLookedFor) {
  const Sphere ball(0.12);
  const View view = fuse_turns(ball, 12);
  const Pose T = view.T_camera_object;
  cast(view, T, view.camera);
  const std::vector<float> marched(bench.maps.z.begin(), bench.maps.z.end());
  const Rect roi = bench.maps.roi;
  // By stripe: right, none, within reach before and behind, out of reach before and behind.
  const float reach = kGuessReach * bench.volume.truncation_m;
  const auto stripe = [](int u) { return u / 12 % 6; };
  const float off[] = {0, 0, -0.8f * reach, 0.8f * reach, -1.3f * reach, 1.3f * reach};
  std::vector<float> guess(view.depth.size() + 16);
  for (int v = roi.v0; v < roi.v1; ++v)
    for (int u = roi.u0; u < roi.u1; ++u) {
      const float z = marched[bench.maps.at(u, v)];
      if (z > 0 && stripe(u) != 1)
        guess[static_cast<std::size_t>(v * view.camera.width + u)] = z + off[stripe(u)];
    }
  RaycastOptions options;
  options.guess = {guess.data(), view.camera.width, view.camera.height};
  raycast(bench.volume, view.camera, roi, T, bench.raycasting, bench.maps, options);
  int there[6]{}, found[6]{};
  for (int v = roi.v0; v < roi.v1; ++v)
    for (int u = roi.u0; u < roi.u1; ++u) {
      there[stripe(u)] += marched[bench.maps.at(u, v)] > 0 ? 1 : 0;
      found[stripe(u)] += bench.maps.z[bench.maps.at(u, v)] > 0 ? 1 : 0;
    }
  for (const int i : {0, 2, 3}) CHECK(found[i] > 0.9 * there[i]);
  for (const int i : {1, 4, 5}) LONGS_EQUAL(0, found[i]);
}

// One noisy frame is all the model, and its noise would come back as slopes.
TEST(Raycast, AYoungModelsNormalsAreFittedWiderAndAnOldOnesAreNot) {
  const Sphere ball(0.12);
  how.noise = 2;
  RaycastOptions smooth;
  smooth.smooth_young = true;
  const auto mean_angle = [&](const View& view, const RaycastOptions& options) {
    raycast(bench.volume, view.camera, visible_rect(bench.volume, view.camera, view.T_camera_object),
            view.T_camera_object, bench.raycasting, bench.maps, options);
    return compare(bench, ball, view.T_camera_object, view.camera).mean_angle;
  };
  View view = render(ball, looking_at(0.9, 0, 0.3), how, random);
  bench.fuse(view);
  CHECK(mean_angle(view, smooth) < 0.85 * mean_angle(view, {}));
  for (int i = 0; i < 40; ++i) {
    view = render(ball, looking_at(0.9, 0, 0.3), how, random);
    bench.fuse(view);
  }
  const double narrow = mean_angle(view, {});
  DOUBLES_EQUAL(narrow, mean_angle(view, smooth), 0.1 * narrow);
}

TEST(Raycast, TheUnseenBackOfAModelIsNotShown) {
  const Sphere ball(0.12);
  const View view = render(ball, looking_at(0.9, 0, 0.3), how, random);
  bench.fuse(view);
  const Pose behind = looking_at(0.9, kPi, -0.3);
  CHECK(cast(view, view.T_camera_object, view.camera).hits > 1000);
  const RaycastStats stats = cast(view, behind, view.camera);
  CHECK(stats.rays > 1000);
  CHECK(stats.hits < 60);  // of the ring that both sides see
}

TEST(Raycast, AllInstructionSetsGiveTheSameBytes) {
  const Disc disc(0.15, 0.045);
  how.noise = 1;
  const View view = fuse_turns(disc, 5);
  const Rect roi = visible_rect(bench.volume, view.camera, view.T_camera_object);
  std::vector<std::uint8_t> first;
  for (const char* name : supported_simd()) {
    select_simd(name);
    raycast(bench.volume, view.camera, roi, view.T_camera_object, bench.raycasting, bench.maps);
    const std::size_t n =
        static_cast<std::size_t>(bench.maps.stride) * static_cast<std::size_t>(roi.height());
    std::vector<std::uint8_t> all(n * 13);
    std::memcpy(all.data(), bench.maps.z.data(), 4 * n);
    std::memcpy(all.data() + 4 * n, bench.maps.normal.data(), 4 * n);
    std::memcpy(all.data() + 8 * n, bench.maps.color.data(), 4 * n);
    std::memcpy(all.data() + 12 * n, bench.maps.weight.data(), n);
    if (first.empty()) first = all;
    UNSIGNED_LONGS_EQUAL(first.size(), all.size());
    MEMCMP_EQUAL(first.data(), all.data(), all.size());
  }
}

TEST(Raycast, AnEmptyVolumeAndAWildPoseGiveAnEmptyImage) {
  const Pinhole camera = View{}.camera;
  CHECK(visible_rect(bench.volume, camera, looking_at(0.9, 0, 0.3)).empty());
  RaycastStats stats =
      raycast(bench.volume, camera, {10, 10, 30, 30}, looking_at(0.9, 0, 0.3), bench.raycasting, bench.maps);
  LONGS_EQUAL(0, stats.hits);
  fuse_turns(Sphere(0.12), 2);
  for (const Vec3& t : {Vec3{0, 0, -2}, Vec3{50, 0, 1}, Vec3{0, 0, std::nan("")}}) {
    Pose T = looking_at(0.9, 0, 0.3);
    T.t = t;
    stats = raycast(bench.volume, camera, {0, 0, 640, 480}, T, bench.raycasting, bench.maps);
    LONGS_EQUAL(0, stats.hits);
  }
  stats = raycast(bench.volume, camera, {600, 400, 900, 700}, looking_at(0.9, 0, 0.3), bench.raycasting,
                  bench.maps);
  LONGS_EQUAL(40, bench.maps.roi.width());
}
