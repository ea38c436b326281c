#include "hal/sim/robots.hpp"

#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "hal/sim/mesh_builder.hpp"

namespace st::sim {
namespace {

constexpr float kTurn = static_cast<float>(2 * kPi);
constexpr float kPrint_m = 0.36f;  // the texture's side: covers the top, its middle over the axle

// Glossy dark plastic throws the projector's dots away from the camera: what comes back is far less than it
// looks.
constexpr Paint kBumper{0.035f, 0.035f, 0.04f, 0.011f};
constexpr Paint kWhite{0.74f, 0.74f, 0.76f, 0.62f};
constexpr Paint kUnderside{0.05f, 0.05f, 0.05f, 0.03f};

bool in_box(float x, float y, float x0, float x1, float y0, float y1) {
  return x > x0 && x < x1 && y > y0 && y < y1;
}

// A word as a row of upright strokes; at the distance of a Kinect that is all that letters are. Reads from
// behind.
bool in_word(float x, float y, float at_x, float at_y, float height, float width, unsigned strokes) {
  if (!in_box(x, y, at_x, at_x + height, at_y - width, at_y)) return false;
  const int cell = static_cast<int>((at_y - y) / width * 24.0f);
  return ((strokes >> (cell % 24)) & 1u) != 0;
}

Paint create1_print(float s, float t) {
  const float x = s - kPrint_m / 2, y = t - kPrint_m / 2;
  const float r = std::sqrt(x * x + y * y);
  const float panel = std::sqrt((x - 0.018f) * (x - 0.018f) + y * y);
  const Paint ink{0.08f, 0.08f, 0.09f, 0.10f}, grey{0.36f, 0.37f, 0.39f, 0.40f};
  if (x > 0.020f && panel < 0.066f) {
    const float power = std::sqrt((x - 0.050f) * (x - 0.050f) + y * y);
    if (power < 0.010f) return {0.12f, 0.55f, 0.16f, 0.4f};
    if (power < 0.014f) return ink;
    for (const float side : {-1.0f, 1.0f}) {
      const float button = std::sqrt((x - 0.038f) * (x - 0.038f) + (y - side * 0.036f) * (y - side * 0.036f));
      if (button < 0.009f) return {0.85f, 0.85f, 0.86f, 0.6f};
      if (button < 0.0105f) return ink;
    }
    return in_word(x, y, 0.026f, 0.024f, 0.006f, 0.048f, 0xb5d6adu) ? ink : grey;
  }
  // The seam between lid and bumper, and the arc over the panel.
  const float seam = 0.030f - 0.18f * (std::fabs(y) - 0.085f);
  if (std::fabs(y) > 0.085f && std::fabs(x - seam) < 0.0032f) return ink * 3.0f;
  if (x > 0.030f && std::fabs(r - 0.1065f) < 0.0030f && std::fabs(y) < 0.090f) return ink * 3.0f;
  if (in_word(x, y, 0.118f, 0.050f, 0.014f, 0.062f, 0x6db76du)) return ink;
  if (in_word(x, y, 0.118f, -0.020f, 0.010f, 0.036f, 0x5adb5bu)) return {0.30f, 0.42f, 0.62f, 0.35f};
  for (const float sx : {-0.002f, -0.072f})
    for (const float sy : {-0.113f, 0.113f})
      if ((x - sx) * (x - sx) + (y - sy) * (y - sy) < 0.0035f * 0.0035f) return ink;
  // The serial port's cover on the right.
  if (in_box(x, y, -0.088f, -0.062f, -0.146f, -0.124f)) return grey;
  return kWhite;
}

Paint create2_print(float s, float t) {
  const float x = s - kPrint_m / 2, y = t - kPrint_m / 2;
  const float r = std::sqrt(x * x + y * y);
  const Paint body{0.20f, 0.21f, 0.22f, 0.34f}, ink{0.05f, 0.05f, 0.05f, 0.08f},
      pale{0.80f, 0.82f, 0.80f, 0.6f};
  const float clean = std::sqrt(x * x + y * y);
  if (clean < 0.024f) return pale;
  if (clean < 0.029f) return {0.25f, 0.65f, 0.25f, 0.5f};
  for (const float side : {-1.0f, 1.0f}) {
    const float button = std::sqrt((x - 0.006f) * (x - 0.006f) + (y - side * 0.046f) * (y - side * 0.046f));
    if (button < 0.011f) return pale;
  }
  for (int i = -2; i <= 2; ++i)  // the clock's keys in front of the display
    if (in_box(x, y, 0.046f, 0.054f, 0.018f * static_cast<float>(i) - 0.006f,
               0.018f * static_cast<float>(i) + 0.006f))
      return pale;
  if (in_box(x, y, 0.060f, 0.078f, -0.030f, 0.030f)) return ink;
  if (in_word(x, y, -0.062f, 0.034f, 0.014f, 0.068f, 0xdb6dabu)) return pale;
  // The faceplate: a green disc with a printed ruler along its rim and a cut-out at the back for the handle.
  if (r < 0.118f) {
    if (x < -0.080f && std::fabs(y) < 0.045f) return ink;
    const float angle = static_cast<float>(arc_tan2(y, x));
    if (r > 0.106f && std::fmod(angle + 7.0f, 0.2f) < 0.07f) return pale;
    return {0.22f, 0.50f, 0.20f, 0.52f};
  }
  if (in_box(x, y, -0.052f, -0.020f, 0.126f, 0.150f)) return ink;  // the serial port's cover, left
  if (r > 0.150f && r < 0.154f && x > -0.01f) return ink;          // gap to the bumper
  return body;
}

Material printed(Paint (*print)(float, float)) {
  return {Paint{1, 1, 1, 1}, std::make_shared<Texture>(9, kPrint_m, print)};
}

void add_underside(MeshBuilder& m) {
  const std::uint32_t dark = m.material(kUnderside);
  const Point2 profile[] = {{0.140f, 0.004f}, {0.155f, 0.016f}, {0.160f, 0.022f}};
  m.lathe(profile, 0, kTurn, 48, dark);
  for (const float side : {-1.0f, 1.0f})
    m.box({-0.034f, side * 0.1225f - 0.011f, 0.0f}, {0.034f, side * 0.1225f + 0.011f, 0.03f}, dark);
}

Mesh create1() {
  MeshBuilder m;
  const std::uint32_t shell = m.material(kWhite), bumper = m.material(kBumper),
                      top = m.material(printed(create1_print));
  const std::uint32_t bay = m.material(Paint{0.62f, 0.62f, 0.64f, 0.5f}), slit = m.material(kUnderside);
  const std::uint32_t plug = m.material(Paint{0.10f, 0.10f, 0.11f, 0.12f});
  add_underside(m);
  const float front = 1.70f;  // the bumper reaches a little behind the axle on both sides
  const Point2 dark_band[] = {{0.158f, 0.014f}, {0.1650f, 0.018f}, {0.1650f, 0.053f}, {0.1610f, 0.056f}};
  const Point2 gap[] = {{0.1600f, 0.056f}, {0.1600f, 0.061f}};
  const Point2 lid_edge[] = {
      {0.1600f, 0.061f}, {0.1645f, 0.061f}, {0.1645f, 0.066f}, {0.1600f, 0.0715f}, {0.1480f, 0.0760f}};
  const Point2 rear_band[] = {
      {0.158f, 0.016f}, {0.1640f, 0.020f}, {0.1645f, 0.066f}, {0.1600f, 0.0715f}, {0.1480f, 0.0760f}};
  m.lathe(dark_band, -front, front, 52, bumper);
  m.lathe(gap, -front, front, 52, slit);
  m.lathe(lid_edge, -front, front, 52, shell);
  m.lathe(rear_band, front, kTurn - front, 40, shell);
  // The bay: 192 mm wide, from the axle back to a rounded rear rim.
  const float back = 0.137f, half = 0.096f, front_x = 0.010f;
  const float corner = static_cast<float>(arc_tan2(half, -0.0978));
  std::vector<Point2> pit = arc({0, 0}, back, corner, kTurn - corner, 20);
  pit.push_back({front_x, -half});
  pit.push_back({front_x, half});
  std::vector<Point2> outline =
      arc({0, 0}, 0.148f, 0, kTurn, 72);  // keyhole: round the rim, over to the pit, round it backwards
  for (std::size_t i = 0; i <= pit.size(); ++i) outline.push_back(pit[(2 * pit.size() - 1 - i) % pit.size()]);
  m.polygon(outline, 0.0760f, true, top, kPrint_m / 2);
  m.walls(pit, 0.024f, 0.0760f, true, bay);
  m.polygon(pit, 0.024f, true, bay);
  m.box({-0.028f, -half, 0.024f}, {front_x, half, 0.043f}, bay);
  m.box({-0.012f, -0.031f, 0.043f}, {0.008f, 0.031f, 0.052f}, plug);  // the 25-pin connector
  // The button panel stands 2 mm proud.
  std::vector<Point2> panel =
      arc({0.018f, 0}, 0.068f, static_cast<float>(-kPi / 2), static_cast<float>(kPi / 2), 24);
  m.walls(panel, 0.0760f, 0.0782f, false, shell);
  m.polygon(panel, 0.0782f, true, top, kPrint_m / 2);
  return m.take();
}

Mesh create2() {
  MeshBuilder m;
  const std::uint32_t body = m.material(Paint{0.20f, 0.21f, 0.22f, 0.34f}), bumper = m.material(kBumper);
  const std::uint32_t top = m.material(printed(create2_print)), slit = m.material(kUnderside);
  const std::uint32_t dome = m.material(Paint{0.06f, 0.05f, 0.06f, 0.05f}),
                      trim = m.material(Paint{0.5f, 0.5f, 0.52f, 0.45f});
  add_underside(m);
  const float front = 1.50f;
  const Point2 rear[] = {
      {0.156f, 0.014f}, {0.1640f, 0.020f}, {0.1650f, 0.066f}, {0.1610f, 0.0775f}, {0.1540f, 0.0820f}};
  m.lathe(rear, front, kTurn - front, 40, body);
  const Point2 inner[] = {
      {0.1560f, 0.020f}, {0.1560f, 0.0800f}, {0.1540f, 0.0820f}};  // the body behind the bumper
  m.lathe(inner, -front, front, 44, slit);
  // The bumper: moved forward so that the robot is 348.5 mm long over it; its window for the light sensors is
  // darkest.
  const Point2 ring_centre{0.0140f, 0};
  const Point2 outside[] = {{0.160f, 0.016f}, {0.1655f, 0.020f}, {0.1655f, 0.058f}};
  const Point2 cap[] = {
      {0.1655f, 0.058f}, {0.1640f, 0.066f}, {0.1570f, 0.0735f}, {0.1490f, 0.0745f}, {0.1490f, 0.060f}};
  m.lathe(outside, -front, front, 44, bumper, ring_centre);
  m.lathe(cap, -front, front, 44, trim, ring_centre);
  std::vector<Point2> rim = arc({0, 0}, 0.154f, 0, kTurn, 72);
  rim.pop_back();
  m.polygon(rim, 0.0820f, true, top, kPrint_m / 2);
  const Point2 plate[] = {{0.118f, 0.0820f}, {0.1170f, 0.0829f}};
  m.lathe(plate, 0, kTurn, 48, body);
  std::vector<Point2> disc = arc({0, 0}, 0.117f, 0, kTurn, 48);
  disc.pop_back();
  m.polygon(disc, 0.0829f, true, top, kPrint_m / 2);
  const Point2 eye[] = {{0.0150f, 0.0740f}, {0.0150f, 0.0870f}, {0.0110f, 0.0910f}, {0.0f, 0.09225f}};
  m.lathe(eye, 0, kTurn, 16, dome, {0.1440f, 0});
  return m.take();
}

void add_laptop(MeshBuilder& m, float top_m) {
  const Material keys{Paint{1, 1, 1, 1}, std::make_shared<Texture>(7, 0.24f, [](float s, float t) {
                        const bool key = std::fmod(s, 0.018f) > 0.003f && std::fmod(t, 0.018f) > 0.003f;
                        return key ? Paint{0.06f, 0.06f, 0.06f, 0.09f} : Paint{0.30f, 0.30f, 0.31f, 0.35f};
                      })};
  const std::uint32_t shell = m.material(Paint{0.32f, 0.33f, 0.35f, 0.38f}), keyboard = m.material(keys);
  const std::uint32_t screen = m.material(Paint{0.10f, 0.14f, 0.25f, 0.02f});
  const float h = top_m + 0.022f;
  m.box({-0.12f, -0.155f, top_m}, {0.10f, 0.155f, h}, shell);
  m.quad({-0.02f, 0.14f, h + 0.0005f}, {-0.02f, -0.14f, h + 0.0005f}, {0.09f, -0.14f, h + 0.0005f},
         {0.09f, 0.14f, h + 0.0005f}, keyboard);
  // The lid stands at the front edge and leans forward by 20 degrees; the glass looks back and up.
  MeshBuilder lid;
  const std::uint32_t ls = lid.material(Paint{0.32f, 0.33f, 0.35f, 0.38f});
  lid.box({0, -0.155f, 0}, {0.008f, 0.155f, 0.21f}, ls);
  m.append(lid.take(), {rotation_from_vector({0, 0.35, 0}), {0.098, 0, h}});
  const Pose T{rotation_from_vector({0, 0.35, 0}), {0.098, 0, h}};
  const auto at = [&](double y, double z) {
    const Vec3 p = T * Vec3{-0.0008, y, z};
    return to_float(p);
  };
  m.quad(at(0.145, 0.012), at(-0.145, 0.012), at(-0.145, 0.2), at(0.145, 0.2), screen);
}

}  // namespace

RobotShape make_robot(RobotModel model, bool with_laptop) {
  RobotShape shape;
  const bool first = model == RobotModel::kCreate1;
  shape.wheel_base_m = first ? 0.258 : 0.235;
  shape.radius_m = first ? 0.165 : 0.180;
  const float top = first ? 0.0782f : 0.0829f;
  shape.height_m = first ? 0.0782 : 0.09225;
  MeshBuilder m;
  m.append(first ? create1() : create2(), Pose{});
  if (with_laptop) {
    add_laptop(m, top);
    shape.height_m = top + 0.22;
  }
  shape.mesh = m.take();
  return shape;
}

}  // namespace st::sim
