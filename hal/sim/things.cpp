#include "hal/sim/things.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "algo/core/scalar_math.hpp"
#include "hal/error.hpp"
#include "hal/sim/furniture.hpp"
#include "hal/sim/mesh_builder.hpp"

namespace st::sim {
namespace {

constexpr float kTurn = static_cast<float>(2 * kPi), kQuarter = static_cast<float>(kPi / 2);

float between(Random& random, double low, double high) {
  return static_cast<float>(random.uniform(low, high));
}

// Of one hue and the brightness wanted.
Paint paint_of(Random& random, float brightness) {
  float c[3] = {between(random, 0.15, 1), between(random, 0.15, 1), between(random, 0.15, 1)};
  const float level = brightness / (0.3f * c[0] + 0.6f * c[1] + 0.1f * c[2]);
  for (float& x : c) x = std::min(0.95f, x * level);
  return {c[0], c[1], c[2], between(random, 0.3, 0.7)};
}

// Blobs, stripes, checks or dots in two paints.
Material printed(Random& random) {
  constexpr float kPeriod_m = 0.5f;
  const Paint dark = paint_of(random, between(random, 0.05, 0.2)),
              light = paint_of(random, between(random, 0.4, 0.8));
  const float cell = kPeriod_m / static_cast<float>(5 + random.below(9));
  const float filled = between(random, 0.3, 0.6);
  const SmoothNoise blobs(kPeriod_m, cell, random);
  const auto share = [cell](float x) { return x / cell - std::floor(x / cell); };
  const auto pattern = [&, kind = random.below(4)](float u, float v) {
    switch (kind) {
      case 0:
        return blobs.at(u, v) > 0.5f;
      case 1:
        return share(u) < filled;
      case 2:
        return (share(u) < filled) != (share(v) < filled);
      default: {
        const float du = share(u) - 0.5f, dv = share(v) - 0.5f;
        return du * du + dv * dv < 0.3f * filled;
      }
    }
  };
  return {Paint{1, 1, 1, 1}, std::make_shared<Texture>(8, kPeriod_m, [&](float u, float v) {
            return pattern(u, v) ? light : dark;
          })};
}

// Materials of the parts, drawn apart from the shape: the same shape may carry any print.
class Prints {
 public:
  Prints(const ThingSpec& spec, MeshBuilder& builder)
      : random_(spec.print != 0 ? spec.print : spec.number, 0x9717),
        bold_(spec.print != 0),
        builder_(builder) {}
  std::uint32_t next() {
    const bool plain = random_.uniform() < 0.5;
    if (bold_ || !plain) return builder_.material(printed(random_));
    return builder_.material(paint_of(random_, between(random_, 0.12, 0.7)));
  }

 private:
  Random random_;
  bool bold_;
  MeshBuilder& builder_;
};

// A ring of n corners, without the first one once more.
std::vector<Point2> corners(Point2 centre, float radius, float from_rad, int n) {
  std::vector<Point2> ring = arc(centre, radius, from_rad, from_rad + kTurn, n);
  ring.pop_back();
  return ring;
}

void prism(MeshBuilder& m, const std::vector<Point2>& outline, float low, float high, Prints& prints) {
  m.walls(outline, low, high, false, prints.next());
  m.polygon(outline, high, true, prints.next(), 0.25f);
}

// Top and flanks of their own prints.
void box(MeshBuilder& m, Point2 c, float x, float y, float yaw, float low, float high, Prints& prints) {
  const SinCos sc = sin_cos(yaw);
  const auto co = static_cast<float>(sc.cos), si = static_cast<float>(sc.sin);
  std::vector<Point2> outline;
  for (const Point2 p : {Point2{-x, -y}, Point2{x, -y}, Point2{x, y}, Point2{-x, y}})
    outline.push_back({c.x + co * p.x - si * p.y, c.y + si * p.x + co * p.y});
  prism(m, outline, low, high, prints);
}

void ball(MeshBuilder& m, Point2 c, float radius, float z, float from_rad, std::uint32_t material) {
  m.lathe(arc({0, z}, radius, from_rad, kQuarter, 12), 0, kTurn, 28, material, c);
}

void wedge(MeshBuilder& m, Point2 c, float x, float y, float low, float high, std::uint32_t material) {
  const Vec3f o{c.x, c.y, low};
  const float h = high - low;
  const Vec3f a = o + Vec3f{-x, -y, 0}, b = o + Vec3f{x, -y, 0}, d = o + Vec3f{x, y, 0},
              e = o + Vec3f{-x, y, 0}, up{0, 0, h};
  m.quad(a, b, d + up, e + up, material);  // the slope
  m.quad(d, e, e + up, d + up, material);  // the high flank
  m.quad(b, d, d + up, d + up, material);  // the flanks are triangles
  m.quad(e, a, e + up, e + up, material);
}

struct Body {
  float reach_x, reach_y;  // half the room on top of it
  float top_m;
};

Body add_body(MeshBuilder& m, Random& random, Prints& prints) {
  const float half = between(random, 0.07, 0.2), half_y = half * between(random, 0.5, 1.0);
  const float height = std::clamp(half * between(random, 0.3, 1.2), 0.06f, 0.22f);
  switch (random.below(5)) {
    case 0:
      box(m, {}, half, half_y, 0, 0, height, prints);
      return {half, half_y, height};
    case 1: {  // a drum, low and wide as robots are
      const float low = std::min(height, 0.12f);
      prism(m, corners({}, half, 0, 48), 0, low, prints);
      return {0.7f * half, 0.7f * half, low};
    }
    case 2: {  // a prism of three, five or six sides, drawn out in x
      constexpr int kSides[] = {3, 5, 6};
      std::vector<Point2> outline = corners({}, half, 0, kSides[random.below(3)]);
      for (Point2& p : outline) p.y *= half_y / half;
      prism(m, outline, 0, height, prints);
      return {0.45f * half, 0.45f * half_y, height};
    }
    case 3: {  // a dome on a low rim
      const float rim = 0.03f, round = std::min(half, 0.16f);
      prism(m, corners({}, round, 0, 40), 0, rim, prints);
      ball(m, {}, 0.9f * round, rim, 0, prints.next());
      return {0.4f * round, 0.4f * round, rim + 0.78f * round};
    }
    default: {  // two steps
      const float step = between(random, -0.4, 0.3) * half;
      box(m, {}, half, half_y, 0, 0, 0.5f * height, prints);
      box(m, {0.5f * (half + step), 0}, 0.5f * (half - step), half_y, 0, 0.5f * height, height, prints);
      return {half, half_y, 0.5f * height};
    }
  }
}

void add_part(MeshBuilder& m, const Body& body, Random& random, Prints& prints) {
  const Point2 at{body.reach_x * between(random, -0.7, 0.7), body.reach_y * between(random, -0.7, 0.7)};
  const float size = between(random, 0.02, 0.055), low = body.top_m - 0.02f,
              high = body.top_m + between(random, 0.02, 0.09), yaw = between(random, -kPi, kPi);
  switch (random.below(5)) {
    case 0:
      box(m, at, size, size * between(random, 0.5, 1), yaw, low, high, prints);
      return;
    case 1:
      prism(m, corners(at, size, 0, 24), low, high, prints);
      return;
    case 2:
      ball(m, at, size, body.top_m, -kQuarter, prints.next());
      return;
    case 3:
      m.lathe(arc({size, body.top_m + 0.012f}, 0.35f * size + 0.006f, 0, kTurn, 12), 0, kTurn, 28,
              prints.next(), at);
      return;
    default:
      wedge(m, at, size, size * between(random, 0.6, 1.2), low, high, prints.next());
  }
}

void mirror(Mesh& mesh) {
  for (Vertex& v : mesh.vertices) {
    v.position.y = -v.position.y;
    v.normal.y = -v.normal.y;
  }
  for (Face& f : mesh.faces) std::swap(f.b, f.c);
}

[[noreturn]] void refuse(const std::string& text, const std::string& what) {
  throw Failure(ExitCode::kBadInput, "thing '" + text + "': " + what +
                                         "; take a number, and print=NUMBER, scale=FACTOR or mirror after a "
                                         "colon: 12:print=7,scale=1.12");
}

template <typename T>
T number_in(const std::string& part, const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
  if (error != std::errc{} || end != part.data() + part.size()) refuse(text, "'" + part + "' is no number");
  return value;
}

}  // namespace

ThingSpec parse_thing(const std::string& text) {
  constexpr double kLeastScale = 0.5, kMostScale = 2;
  ThingSpec spec;
  const std::size_t colon = text.find(':');
  spec.number = number_in<std::uint64_t>(text.substr(0, colon), text);
  for (std::size_t at = colon; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at + 1), text.size());
    const std::string part = text.substr(at + 1, end - at - 1);
    at = end;
    if (part == "mirror") {
      spec.mirrored = true;
    } else if (part.starts_with("print=")) {
      spec.print = number_in<std::uint64_t>(part.substr(6), text);
    } else if (part.starts_with("scale=")) {
      spec.scale = number_in<double>(part.substr(6), text);
      if (!(spec.scale >= kLeastScale && spec.scale <= kMostScale)) refuse(text, "the scale is 0.5 to 2");
    } else {
      refuse(text, "'" + part + "' is not known");
    }
  }
  return spec;
}

Mesh make_thing(const ThingSpec& spec) {
  constexpr int kMostParts = 4;
  Random shape(spec.number, 0x7419);
  MeshBuilder builder;
  Prints prints(spec, builder);
  const Body body = add_body(builder, shape, prints);
  const int parts = 1 + shape.below(kMostParts);
  for (int i = 0; i < parts; ++i) add_part(builder, body, shape, prints);
  Mesh mesh = builder.take();
  for (Vertex& v : mesh.vertices) v.position = v.position * static_cast<float>(spec.scale);
  if (spec.mirrored) mirror(mesh);
  return mesh;
}

double radius_of(const Mesh& mesh) {
  float square = 0;
  for (const Vertex& v : mesh.vertices)
    square = std::max(square, v.position.x * v.position.x + v.position.y * v.position.y);
  return std::sqrt(static_cast<double>(square));
}

}  // namespace st::sim
