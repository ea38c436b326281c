#include "hal/sim/truth_files.hpp"

#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstring>

#include "algo/core/scalar_math.hpp"
#include "hal/error.hpp"

namespace st::sim {
namespace {

std::string numbered(const Scene& scene, const std::string& folder, std::size_t i, const char* extension) {
  std::string name = folder + "/truth";
  if (scene.objects.size() > 1) name.append("-").append(std::to_string(i + 1));
  return name + extension;
}

void print_intrinsics(TextFile& out, const Intrinsics& k) {
  out.print("width = %d\nheight = %d\nfx = %.6g\nfy = %.6g\ncx = %.6g\ncy = %.6g\n", k.width, k.height, k.fx,
            k.fy, k.cx, k.cy);
}

void print_pose(TextFile& out, double t_s, const Pose& T) {
  const Quaternion q = to_quaternion(T.R);
  out.print("%.6f %.6f %.6f %.6f %.7f %.7f %.7f %.7f\n", t_s, T.t.x, T.t.y, T.t.z, q.x, q.y, q.z, q.w);
}

void write_shape(const Mesh& mesh, const std::string& path) {
  TextFile out(path);
  out.print(
      "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty float x\nproperty float "
      "y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\nproperty uchar "
      "green\nproperty uchar blue\n"
      "element face %zu\nproperty list uchar int vertex_indices\nend_header\n",
      mesh.vertices.size(), mesh.faces.size());
  std::vector<std::uint32_t> material_of(mesh.vertices.size(), 0);
  for (const Face& f : mesh.faces) material_of[f.a] = material_of[f.b] = material_of[f.c] = f.material;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Vertex& v = mesh.vertices[i];
    const Material& m = mesh.materials[material_of[i]];
    const std::uint32_t t = m.texture ? m.texture->at(v.u, v.v, 0.001f) : 0xffffffffu;
    const auto level = [&](float paint, unsigned shift) {
      const double linear = paint * static_cast<float>((t >> shift) & 255) / 255.0f + 1e-4;
      return static_cast<std::uint8_t>(std::fmin(255.0, 255.0 * exponential(natural_log(linear) / 2.2)));
    };
    const float xyz[6] = {v.position.x, v.position.y, v.position.z, v.normal.x, v.normal.y, v.normal.z};
    const std::uint8_t rgb[3] = {level(m.paint.r, 0), level(m.paint.g, 8), level(m.paint.b, 16)};
    out.write(xyz, sizeof xyz);
    out.write(rgb, sizeof rgb);
  }
  for (const Face& f : mesh.faces) {
    const std::uint8_t three = 3;
    const std::uint32_t abc[3] = {f.a, f.b, f.c};
    out.write(&three, 1);
    out.write(abc, sizeof abc);
  }
  out.close();
}

}  // namespace

TextFile::TextFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (file_ == nullptr) fail();
}

TextFile::~TextFile() {
  if (file_ != nullptr) std::fclose(file_);
}

void TextFile::fail() const {
  throw Failure(ExitCode::kBadInput, path_ + ": cannot be written (" + std::strerror(errno) +
                                         "); check the folder and the free space");
}

void TextFile::write(const void* data, std::size_t bytes) {
  if (std::fwrite(data, 1, bytes, file_) != bytes) fail();
}

void TextFile::print(const char* format, ...) {
  std::va_list args;
  va_start(args, format);
  const int n = std::vfprintf(file_, format, args);
  va_end(args);
  if (n < 0) fail();
}

void TextFile::close() {
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) fail();
}

void write_camera_file(const Calibration& c, const std::string& path) {
  TextFile out(path);
  print_intrinsics(out, c.depth);
  out.print("raw_a = %.6f   # depth in metres = raw_a / (raw_b - raw)\nraw_b = %.6f\n\n[color]\n", c.raw_a,
            c.raw_b);
  print_intrinsics(out, c.color);
  const double* R = c.T_color_depth.R.m;
  const Vec3& t = c.T_color_depth.t;
  out.print(
      "registered = false\nR = [%.9f, %.9f, %.9f, %.9f, %.9f, %.9f, %.9f, %.9f, %.9f]   # p_color = R "
      "p_depth + t, row by row\n",
      R[0], R[1], R[2], R[3], R[4], R[5], R[6], R[7], R[8]);
  out.print("t = [%.6f, %.6f, %.6f]\n", t.x, t.y, t.z);
  out.close();
}

void write_preset(const Scene& scene, const std::string& path) {
  if (scene.preset.empty()) return;
  TextFile out(path);
  out.print("t,x,y,yaw,v,w\n");
  for (const PresetSample& s : scene.preset)
    out.print("%.3f,%.6f,%.6f,%.6f,%.4f,%.4f\n", s.t_s, s.pose.x, s.pose.y, wrap_angle(s.pose.yaw), s.v_mps,
              s.w_rps);
  out.close();
}

void write_true_shapes(const Scene& scene, const std::string& folder) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    write_shape(scene.objects[i].mesh, numbered(scene, folder, i, ".ply"));
  if (scene.camera_motion) write_shape(scene.still, folder + "/truth.ply");
}

TruthFiles::TruthFiles(const Scene& scene, const std::string& folder)
    : scene_(scene), visible_(folder + "/visible.csv") {
  visible_.print("host_t,clk_t,tick,frame");
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const char* label = scene.objects[i].label.c_str();
    poses_.push_back(std::make_unique<TextFile>(numbered(scene, folder, i, ".tum")));
    visible_.print(",%s_px,%s_frac,%s_valid", label, label, label);
  }
  if (scene.camera_motion) poses_.push_back(std::make_unique<TextFile>(folder + "/truth.tum"));
  visible_.print(",valid_frac\n");
}

void TruthFiles::add(double t_s, const FrameStamp& stamp, const std::vector<Visibility>& seen,
                     ImageView<const std::uint16_t> raw) {
  visible_.print("%.6f,%.6f,%u,%llu", stamp.host_s, stamp.device_s, stamp.ticks,
                 static_cast<unsigned long long>(stamp.frame));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const double share =
        seen[i].whole_pixels > 0 ? static_cast<double>(seen[i].pixels) / seen[i].whole_pixels : 0.0;
    visible_.print(",%d,%.3f,%d", seen[i].pixels, share, seen[i].valid);
    Pose T_room_object;
    if (!scene_.objects[i].motion(t_s, T_room_object)) continue;
    print_pose(*poses_[i], stamp.host_s, scene_.camera_at(t_s) * T_room_object);
  }
  if (scene_.camera_motion) print_pose(*poses_.back(), stamp.host_s, scene_.camera_at(t_s).inverse());
  int valid = 0;
  for (int i = 0; i < raw.pixels(); ++i) valid += raw.data[i] != DepthSensor::kNoReading ? 1 : 0;
  visible_.print(",%.4f\n", static_cast<double>(valid) / raw.pixels());
}

void TruthFiles::close() {
  for (auto& file : poses_) file->close();
  visible_.close();
}

}  // namespace st::sim
