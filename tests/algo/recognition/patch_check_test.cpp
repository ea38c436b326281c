#include "algo/recognition/patch_check.hpp"

#include "algo/core/scalar_math.hpp"
#include "tests/algo/volume/analytic_view.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;
using namespace st::test;

namespace {

constexpr double kPitch = 0.6, kYaw = 0.4;

std::uint32_t striped(const Vec3& p) {
  const bool bright = sin_cos(60 * p.x).sin > 0;
  return bright ? pack_rgb(220, 200, 60) : pack_rgb(40, 60, 90);
}
std::uint32_t other_stripes(const Vec3& p) { return striped({p.y, p.x, p.z}); }

// A printed box as a model, from all round.
struct Model {
  Model() : bench(128) {
    bench.volume.reset(0.004f, 0.016f, {0, 0, 0});
    std::mt19937 random(4);
    Rendering how;
    how.noise = 0.3;
    how.paint = striped;
    for (int i = 0; i < 12; ++i)
      bench.fuse(render(Box({0.12, 0.10, 0.06}), looking_at(1.1, 2 * kPi * i / 12, kPitch), how, random));
  }

  // The model at `pose` beside a frame of the solid at kYaw.
  PatchCheck beside(const Solid& solid, const Paint& paint, double model_yaw, double light = 1) {
    std::mt19937 random(8);
    Rendering how;
    how.noise = 0.3;
    how.paint = paint;
    View frame = render(solid, looking_at(1.1, kYaw, kPitch), how, random);
    for (std::uint32_t& c : frame.color)
      if (c != 0) {
        const auto lit = [&](int x) { return static_cast<std::uint8_t>(light * x); };
        c = pack_rgb(lit(red_of(c)), lit(green_of(c)), lit(blue_of(c)));
      }
    ModelView view;
    view.T_camera_object = looking_at(1.1, model_yaw, kPitch);
    const Rect box = visible_rect(bench.volume, frame.camera, view.T_camera_object);
    raycast(bench.volume, frame.camera, box, view.T_camera_object, bench.raycasting, bench.maps);
    view.maps = bench.maps;
    PatchInput in;
    in.view = &view;
    in.camera = frame.camera;
    in.depth_z = {frame.depth.data(), 640, 480};
    in.owners = {frame.owners.data(), 640, 480};
    in.owner = 1;
    in.color = {frame.color.data(), 640, 480};
    in.skirt_z_m = -1;
    return check_patches(in);
  }
  Bench bench;
};

const Box kBox({0.12, 0.10, 0.06});

}  // namespace

TEST_GROUP(PatchCheck){};

TEST(PatchCheck, TheThingItselfAgreesInAnyLight) {
  Model model;
  for (const double light : {0.6, 1.0, 1.1}) {
    const PatchCheck check = model.beside(kBox, striped, kYaw, light);
    CHECK_TRUE(check.shape > 30);
    CHECK_TRUE(check.print > 30);
    CHECK_TRUE(check.agrees());
  }
}

TEST(PatchCheck, AnotherPrintInTheSameOutlineDoesNotAgree) {
  Model model;
  const PatchCheck check = model.beside(kBox, other_stripes, kYaw);
  CHECK_EQUAL(0, check.shape_off);
  CHECK_FALSE(check.agrees());
}

TEST(PatchCheck, AKnobMoreIsSeenThoughNineTenthsAgree) {
  Model model;
  const PatchCheck check = model.beside(Box({0.12, 0.10, 0.10}), striped, kYaw);
  CHECK_TRUE(check.shape_off * 20 > check.shape);
  CHECK_FALSE(check.agrees());
}

TEST(PatchCheck, TheOtherWayRoundIsRefutedByThePrintAlone) {
  Model model;  // stripes across x: turned by half a turn its phase is another one
  const PatchCheck here = model.beside(kBox, striped, kYaw), turned = model.beside(kBox, striped, kYaw + kPi);
  CHECK_EQUAL(0, turned.shape_off);
  CHECK_TRUE(here.refutes(turned));
  CHECK_FALSE(turned.refutes(here));
  CHECK_FALSE(here.refutes(here));
}
