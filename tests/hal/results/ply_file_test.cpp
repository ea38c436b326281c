#include "hal/results/ply_file.hpp"

#include <CppUTest/TestHarness.h>

#include <cstring>
#include <sstream>

#include "hal/error.hpp"
#include "tests/support/demo_run.hpp"

using namespace st;

namespace {

// Reads only what the header says, by nothing that the writer shares.
struct OtherReader {
  std::size_t vertices = 0, faces = 0, vertex_bytes = 0;
  std::string order, list;
  std::string body;

  explicit OtherReader(const std::string& bytes) {
    const std::size_t end = bytes.find("end_header\n") + 11;
    std::istringstream head(bytes.substr(0, end));
    std::string word, element;
    for (std::string line; std::getline(head, line);) {
      std::istringstream words(line);
      words >> word;
      if (word == "element") {
        std::size_t count = 0;
        words >> element >> count;
        (element == "vertex" ? vertices : faces) = count;
      } else if (word == "property" && element == "vertex") {
        std::string type, name;
        words >> type >> name;
        vertex_bytes += type == "float" ? 4 : type == "ushort" ? 2 : 1;
        order += name + " ";
      } else if (word == "property") {
        list = line;
      }
    }
    body = bytes.substr(end);
  }
  template <typename T>
  T at(std::size_t offset) const {
    T value;
    std::memcpy(&value, body.data() + offset, sizeof value);
    return value;
  }
};

}  // namespace

TEST_GROUP(PlyFile) { Mesh mesh = disc_mesh({0.01, 0.02, 0.5}); };

TEST(PlyFile, AnIndependentReaderFindsWhatWasWritten) {
  const OtherReader read(format_ply(mesh.view()));
  STRCMP_EQUAL("x y z nx ny nz red green blue observations ", read.order.c_str());
  STRCMP_EQUAL("property list uchar int vertex_indices", read.list.c_str());
  LONGS_EQUAL(mesh.vertices.size(), read.vertices);
  LONGS_EQUAL(mesh.indices.size() / 3, read.faces);
  LONGS_EQUAL(read.vertices * read.vertex_bytes + read.faces * 13, read.body.size());
  const std::size_t i = 1234, at = i * read.vertex_bytes;
  DOUBLES_EQUAL(mesh.vertices[i].position.y, read.at<float>(at + 4), 0);
  DOUBLES_EQUAL(mesh.vertices[i].normal.z, read.at<float>(at + 20), 0);
  LONGS_EQUAL(mesh.vertices[i].b, read.at<std::uint8_t>(at + 26));
  LONGS_EQUAL(40, read.at<std::uint16_t>(at + 27));
  const std::size_t face = read.vertices * read.vertex_bytes + 77 * 13;
  LONGS_EQUAL(3, read.at<std::uint8_t>(face));
  LONGS_EQUAL(mesh.indices[77 * 3 + 2], read.at<std::int32_t>(face + 9));
}

TEST(PlyFile, ReadsBackItsOwn) {
  const Mesh back = parse_ply(format_ply(mesh.view()), "m.ply");
  CHECK(back.indices == mesh.indices);
  LONGS_EQUAL(mesh.vertices.size(), back.vertices.size());
  DOUBLES_EQUAL(mesh.vertices[9].position.x, back.vertices[9].position.x, 0);
}

TEST(PlyFile, CutOrForeignFilesAreRefused) {
  const std::string whole = format_ply(mesh.view());
  std::string wrong_index = whole;
  wrong_index[whole.size() - 1] = 0x7f;
  for (const std::string& bytes : {std::string(), whole.substr(0, whole.size() - 1), whole + "x",
                                   std::string("ply\nformat ascii 1.0\n"), wrong_index})
    CHECK_THROWS(Failure, parse_ply(bytes, "m.ply"));
}
