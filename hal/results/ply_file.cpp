#include "hal/results/ply_file.hpp"

#include <bit>
#include <cmath>
#include <cstring>

#include "hal/error.hpp"
#include "hal/results/csv_table.hpp"

namespace st {
namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they lie in memory");

constexpr std::size_t kVertexBytes = 6 * sizeof(float) + 3 + sizeof(std::uint16_t);
constexpr std::size_t kFaceBytes = 1 + 3 * sizeof(std::int32_t);

std::string header(std::size_t vertices, std::size_t faces) {
  return "ply\nformat binary_little_endian 1.0\ncomment metres\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float "
         "ny\nproperty float nz\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty ushort "
         "observations\nelement face " +
         std::to_string(faces) + "\nproperty list uchar int vertex_indices\nend_header\n";
}

template <typename T>
void put(std::string& out, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

template <typename T>
T get(const char*& at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
  return value;
}

float or_zero(float value) { return std::isfinite(value) ? value : 0.0f; }

std::size_t count_after(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) return 0;
  const std::string_view rest = text.substr(at + key.size());
  double value = 0;
  constexpr double kMost = 1e9;
  return parse_number(rest.substr(0, rest.find('\n')), value) && value >= 0 && value < kMost
             ? static_cast<std::size_t>(value)
             : 0;
}

}  // namespace

std::string format_ply(const MeshView& mesh) {
  const std::size_t faces = mesh.indices.size() / 3;
  std::string out = header(mesh.vertices.size(), faces);
  out.reserve(out.size() + mesh.vertices.size() * kVertexBytes + faces * kFaceBytes);
  for (const MeshVertex& vertex : mesh.vertices) {
    for (const Vec3f& v : {vertex.position, vertex.normal})
      for (const float part : {v.x, v.y, v.z}) put(out, or_zero(part));
    for (const std::uint8_t part : {vertex.r, vertex.g, vertex.b}) put(out, part);
    put(out, vertex.observations);
  }
  for (std::size_t face = 0; face < faces; ++face) {
    put(out, std::uint8_t{3});
    for (std::size_t k = 0; k < 3; ++k) put(out, static_cast<std::int32_t>(mesh.indices[3 * face + k]));
  }
  return out;
}

Mesh parse_ply(std::string_view bytes, const std::string& name) {
  const std::size_t vertices = count_after(bytes.substr(0, 1024), "element vertex ");
  const std::size_t faces = count_after(bytes.substr(0, 1024), "element face ");
  const std::string expected = header(vertices, faces);
  if (!bytes.starts_with(expected) ||
      bytes.size() != expected.size() + vertices * kVertexBytes + faces * kFaceBytes)
    throw Failure(ExitCode::kBadInput,
                  name + ": is not a whole mesh as startrack writes it; run the recording again");
  Mesh mesh;
  mesh.vertices.resize(vertices);
  mesh.indices.reserve(3 * faces);
  const char* at = bytes.data() + expected.size();
  for (MeshVertex& vertex : mesh.vertices) {
    for (Vec3f* v : {&vertex.position, &vertex.normal})
      for (int i = 0; i < 3; ++i) (*v)[i] = or_zero(get<float>(at));
    for (std::uint8_t* part : {&vertex.r, &vertex.g, &vertex.b}) *part = get<std::uint8_t>(at);
    vertex.observations = get<std::uint16_t>(at);
  }
  for (std::size_t face = 0; face < faces; ++face) {
    bool good = get<std::uint8_t>(at) == 3;
    for (int k = 0; k < 3; ++k)
      mesh.indices.push_back(get<std::uint32_t>(at)), good = good && mesh.indices.back() < vertices;
    if (!good)
      throw Failure(ExitCode::kBadInput,
                    name + ": face " + std::to_string(face) + " names a vertex that is not there");
  }
  return mesh;
}

}  // namespace st
