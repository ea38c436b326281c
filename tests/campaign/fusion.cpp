// What the weights of the noise model are worth: the same simulated frames at their true poses, fused with
// them and by plain averaging, and the model's vertices held against the true shape.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <vector>

#include "algo/volume/mesh.hpp"
#include "tests/campaign/campaign.hpp"
#include "tests/campaign/robot_views.hpp"
#include "tests/support/bound.hpp"

namespace st::campaign {
namespace {

// Closest point of a triangle (Ericson 2005, section 5.1.5).
float distance_m(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Vec3f ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp), d5 = dot(ab, cp),
              d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return norm(ap);
  if (d3 >= 0 && d4 <= d3) return norm(bp);
  if (d6 >= 0 && d5 <= d6) return norm(cp);
  const float va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return norm(ap - ab * (d1 / (d1 - d3)));
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return norm(ap - ac * (d2 / (d2 - d6)));
  if (va <= 0 && d4 >= d3 && d5 >= d6) return norm(bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
  const float whole = va + vb + vc;
  return whole > 0 ? norm(ap - ab * (vb / whole) - ac * (vc / whole)) : norm(ap);
}

class TrueShape {
 public:
  explicit TrueShape(const sim::Mesh& mesh) {
    for (const sim::Face& f : mesh.faces) {
      const Vec3f a = mesh.vertices[f.a].position, b = mesh.vertices[f.b].position,
                  c = mesh.vertices[f.c].position;
      const Vec3f middle = (a + b + c) * (1.0f / 3);
      faces_.push_back({a, b, c, middle, std::max({norm(a - middle), norm(b - middle), norm(c - middle)})});
    }
  }
  float distance_from(const Vec3f& p) const {
    float least = 1e9f;
    for (const Face& f : faces_)
      if (norm(p - f.middle) - f.radius < least) least = std::min(least, distance_m(p, f.a, f.b, f.c));
    return least;
  }

 private:
  struct Face {
    Vec3f a, b, c, middle;
    float radius;
  };
  std::vector<Face> faces_;
};

struct ModelError {
  double mean_mm = 0, rms_mm = 0, p95_mm = 0;
};

class Fusion {
 public:
  void begin(float distance_m) {
    constexpr float kVoxel_m = 0.48f / kSide;
    volume_.reset(kVoxel_m, choose_truncation_m(kVoxel_m, depth_sigma_m(distance_m)), {0, 0, 0.1f});
  }
  void add(const RobotViews& views, const RobotFrame& frame, bool noise_aware) {
    IntegrateOptions options;
    options.noise.noise_aware = noise_aware;
    integrate(volume_, frame.evidence(views.camera()), frame.T_camera_robot, options, integrating_);
  }
  ModelError error(const TrueShape& shape) {
    const MeshCounts counts = count_mesh(volume_, {}, meshing_);
    std::vector<MeshVertex> vertices(counts.vertices);
    std::vector<std::uint32_t> indices(3 * counts.triangles);
    extract_mesh(volume_, {}, meshing_, vertices, indices);
    std::vector<double> off_mm;
    double sum = 0, squares = 0;
    for (const MeshVertex& vertex : vertices) {
      off_mm.push_back(1e3 * static_cast<double>(shape.distance_from(vertex.position)));
      sum += off_mm.back();
      squares += off_mm.back() * off_mm.back();
    }
    std::sort(off_mm.begin(), off_mm.end());
    const double n = static_cast<double>(off_mm.size());
    return {sum / n, std::sqrt(squares / n), off_mm[off_mm.size() * 95 / 100]};
  }

 private:
  static constexpr int kSide = 128;
  Volume volume_;
  IntegrateScratch integrating_;
  MeshScratch meshing_;
  test::BoundMemory memory_{[this](Bump& bump) {
    volume_.bind(bump, kSide);
    integrating_.bind(bump, 640, 480, kSide);
    meshing_.bind(bump, kSide);
  }};
};

struct Drive {
  const char* name;
  const char* scene;
  int frames;  // evenly over the scene's drive
};
constexpr Drive kDrives[] = {{"circle, 20 frames", "circle", 20},
                             {"circle, 120 frames", "circle", 120},
                             {"square, 120 frames", "square", 120},
                             {"figure8, 120 frames", "figure8", 120},
                             {"turn on the spot, 120 frames", "spin-in-place", 120}};

struct Pair {
  ModelError plain, weighted;
};

void print_row(const char* what, const Pair& p) {
  std::printf("| %s | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f |\n", what, p.plain.mean_mm,
              p.weighted.mean_mm, p.plain.rms_mm, p.weighted.rms_mm, p.plain.p95_mm, p.weighted.p95_mm,
              p.weighted.mean_mm / p.plain.mean_mm);
  std::fflush(stdout);
}

Pair fuse_drive(const Drive& drive, std::uint64_t seed, bool laptop) {
  RobotViews views(drive.scene, seed, laptop);
  const TrueShape shape(views.scene().objects[0].mesh);
  Fusion plain, weighted;
  const double begin_s = views.scene().start_s, length_s = views.scene().duration_s - begin_s - 1;
  double nearest_m = 1e9, farthest_m = 0;
  for (int i = 0; i < drive.frames; ++i) {
    const RobotFrame frame = views.look(views.T_room_robot(begin_s + length_s * i / drive.frames));
    const double z_m = frame.T_camera_robot.t.z;
    if (i == 0) {
      plain.begin(static_cast<float>(z_m));
      weighted.begin(static_cast<float>(z_m));
    }
    nearest_m = std::min(nearest_m, z_m), farthest_m = std::max(farthest_m, z_m);
    plain.add(views, frame, false);
    weighted.add(views, frame, true);
  }
  const Pair errors{plain.error(shape), weighted.error(shape)};
  char what[100];
  std::snprintf(what, sizeof what, "%s%s, seed %llu, %.1f-%.1f m", drive.name, laptop ? ", with laptop" : "",
                static_cast<unsigned long long>(seed), nearest_m, farthest_m);
  print_row(what, errors);
  return errors;
}

void add_share(const ModelError& error, double share, ModelError& mean) {
  mean.mean_mm += share * error.mean_mm;
  mean.rms_mm += share * error.rms_mm;
  mean.p95_mm += share * error.p95_mm;
}

}  // namespace

void print_fusion() {
  std::printf(
      "Distance of the model's vertices from the true shape, mm: plain averaging beside weights of the "
      "noise model\n\n"
      "| drive | mean, plain | weighted | RMS, plain | weighted | 95 %%, plain | weighted | weighted / plain "
      "|\n"
      "|---|--:|--:|--:|--:|--:|--:|--:|\n");
  for (const bool laptop : {false, true}) {
    Pair mean;
    constexpr double kShare = 1.0 / static_cast<double>(std::size(kDrives) * kSeeds);
    for (const Drive& drive : kDrives)
      for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const Pair errors = fuse_drive(drive, seed, laptop);
        add_share(errors.plain, kShare, mean.plain);
        add_share(errors.weighted, kShare, mean.weighted);
      }
    print_row(laptop ? "mean, with laptop" : "mean, round robot", mean);
  }
}

}  // namespace st::campaign
