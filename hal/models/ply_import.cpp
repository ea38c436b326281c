#include "hal/models/ply_import.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <vector>

#include "hal/error.hpp"

namespace st {
namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they lie in memory");

constexpr std::size_t kMostElements = 20'000'000;
constexpr std::uint64_t kMostCorners = 64;

struct Type {
  const char* names[2];
  std::size_t bytes;
  char kind;  // i, u, f
};
constexpr Type kTypes[] = {{{"char", "int8"}, 1, 'i'},     {{"uchar", "uint8"}, 1, 'u'},
                           {{"short", "int16"}, 2, 'i'},   {{"ushort", "uint16"}, 2, 'u'},
                           {{"int", "int32"}, 4, 'i'},     {{"uint", "uint32"}, 4, 'u'},
                           {{"float", "float32"}, 4, 'f'}, {{"double", "float64"}, 8, 'f'}};

struct Property {
  std::string name;
  const Type* type = nullptr;
  const Type* count_type = nullptr;  // of a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

class PlyReader {
 public:
  PlyReader(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

  Mesh read(double scale) {
    read_header();
    Mesh mesh;
    for (const Element& element : elements_) {
      const bool is_face = element.name == "face";
      for (std::size_t i = 0; i < element.count; ++i) {
        MeshVertex vertex;
        for (const Property& property : element.properties) {
          if (property.count_type != nullptr)
            read_list(property, is_face, mesh);
          else
            set(vertex, property.name, value(*property.type), scale);
        }
        if (element.name == "vertex") mesh.vertices.push_back(vertex);
      }
    }
    check(mesh);
    return mesh;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw Failure(ExitCode::kBadInput,
                  name_ + ": " + why + "; needed is a PLY mesh, ascii or binary_little_endian");
  }

  std::string_view line() {
    const std::size_t end = rest_.find('\n');
    if (end == std::string_view::npos) fail("its header has no end");
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    return text;
  }

  static std::string_view word(std::string_view& text) {
    while (!text.empty() && (text[0] == ' ' || text[0] == '\t')) text.remove_prefix(1);
    std::size_t n = 0;
    while (n < text.size() && text[n] != ' ' && text[n] != '\t') ++n;
    const std::string_view first = text.substr(0, n);
    text.remove_prefix(n);
    return first;
  }

  const Type* type_named(std::string_view name) const {
    for (const Type& type : kTypes)
      for (const char* known : type.names)
        if (name == known) return &type;
    fail("property type " + std::string(name) + " is unknown");
  }

  void read_header() {
    if (line() != "ply") fail("is no PLY file");
    for (;;) {
      std::string_view text = line();
      const std::string_view key = word(text);
      if (key == "end_header") return;
      if (key == "format") {
        const std::string_view format = word(text);
        ascii_ = format == "ascii";
        if (!ascii_ && format != "binary_little_endian")
          fail("format " + std::string(format) + " is not read");
      } else if (key == "element") {
        Element element;
        element.name = word(text);
        const std::string_view count = word(text);
        const auto end = std::from_chars(count.data(), count.data() + count.size(), element.count);
        if (end.ec != std::errc() || element.count > kMostElements)
          fail("a count in its header is no number");
        elements_.push_back(element);
      } else if (key == "property") {
        if (elements_.empty()) fail("its header is damaged");
        Property property;
        std::string_view type = word(text);
        if (type == "list") {
          property.count_type = type_named(word(text));
          type = word(text);
        }
        property.type = type_named(type);
        property.name = word(text);
        elements_.back().properties.push_back(property);
      }
    }
  }

  double value(const Type& type) {
    if (ascii_) return ascii_value();
    if (rest_.size() < type.bytes) fail("is cut off");
    const char* const at = rest_.data();
    rest_.remove_prefix(type.bytes);
    if (type.kind == 'f') return type.bytes == 4 ? static_cast<double>(as<float>(at)) : as<double>(at);
    if (type.bytes == 1) return type.kind == 'i' ? as<std::int8_t>(at) : as<std::uint8_t>(at);
    if (type.bytes == 2) return type.kind == 'i' ? as<std::int16_t>(at) : as<std::uint16_t>(at);
    return type.kind == 'i' ? static_cast<double>(as<std::int32_t>(at)) : as<std::uint32_t>(at);
  }

  double ascii_value() {
    while (!rest_.empty() && std::strchr(" \t\r\n", rest_[0]) != nullptr) rest_.remove_prefix(1);
    double number = 0;
    const auto end = std::from_chars(rest_.data(), rest_.data() + rest_.size(), number);
    if (end.ec != std::errc()) fail("is cut off, or has something else where a number should be");
    rest_.remove_prefix(static_cast<std::size_t>(end.ptr - rest_.data()));
    return number;
  }

  template <typename T>
  static T as(const char* at) {
    T number;
    std::memcpy(&number, at, sizeof number);
    return number;
  }

  static void set(MeshVertex& vertex, const std::string& name, double number, double scale) {
    const auto coordinate = static_cast<float>(number);
    const auto level = [&] {  // of a number that may be none
      return static_cast<std::uint8_t>(number > 0 ? std::min(number, 255.0) : 0.0);
    };
    if (name.size() == 1 && name[0] >= 'x' && name[0] <= 'z')
      vertex.position[name[0] - 'x'] = static_cast<float>(number * scale);
    else if (name.size() == 2 && name[0] == 'n' && name[1] >= 'x' && name[1] <= 'z')
      vertex.normal[name[1] - 'x'] = coordinate;
    else if (name == "red")
      vertex.r = level();
    else if (name == "green")
      vertex.g = level();
    else if (name == "blue")
      vertex.b = level();
  }

  // Polygons become fans.
  void read_list(const Property& property, bool is_face, Mesh& mesh) {
    const double count = value(*property.count_type);
    if (!(count >= 0 && count <= kMostCorners)) fail("a face has an impossible number of corners");
    const bool corners = is_face && (property.name == "vertex_indices" || property.name == "vertex_index");
    std::uint32_t first = 0, before = 0;
    for (int k = 0; k < static_cast<int>(count); ++k) {
      const double number = value(*property.type);
      if (!corners) continue;
      if (!(number >= 0 && number < kMostElements)) fail("a face names a vertex that is not there");
      const auto corner = static_cast<std::uint32_t>(number);
      if (k == 0) first = corner;
      if (k >= 2)
        for (const std::uint32_t index : {first, before, corner}) mesh.indices.push_back(index);
      before = corner;
    }
  }

  void check(Mesh& mesh) const {
    if (mesh.vertices.empty() || mesh.indices.empty()) fail("has no faces");
    for (const std::uint32_t index : mesh.indices)
      if (index >= mesh.vertices.size()) fail("a face names a vertex that is not there");
    for (const MeshVertex& vertex : mesh.vertices) {
      const Vec3f& p = vertex.position;
      if (!(std::fabs(p.x) < 1e4f && std::fabs(p.y) < 1e4f && std::fabs(p.z) < 1e4f))
        fail("a vertex is not near");
    }
    bool has_normals = true;
    for (const MeshVertex& vertex : mesh.vertices)
      has_normals = has_normals && dot(vertex.normal, vertex.normal) > 0;
    if (has_normals) return;
    for (MeshVertex& vertex : mesh.vertices) vertex.normal = {};
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      MeshVertex* const corner[3] = {&mesh.vertices[mesh.indices[i]], &mesh.vertices[mesh.indices[i + 1]],
                                     &mesh.vertices[mesh.indices[i + 2]]};
      const Vec3f n =
          cross(corner[1]->position - corner[0]->position, corner[2]->position - corner[0]->position);
      for (MeshVertex* vertex : corner) vertex->normal += n;
    }
    for (MeshVertex& vertex : mesh.vertices) vertex.normal = normalized(vertex.normal);
  }

  std::string_view rest_;
  std::string name_;
  bool ascii_ = false;
  std::vector<Element> elements_;
};

}  // namespace

Mesh import_ply(std::string_view bytes, double scale, const std::string& name) {
  return PlyReader(bytes, name).read(scale);
}

}  // namespace st
