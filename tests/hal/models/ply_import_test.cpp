#include "hal/models/ply_import.hpp"

#include "hal/error.hpp"

#include <CppUTest/TestHarness.h>  // last: its macro for new

using namespace st;

namespace {

const char* const kSquare =
    "ply\r\nformat ascii 1.0\ncomment from elsewhere\nelement vertex 4\nproperty double x\nproperty double "
    "y\n"
    "property double z\nproperty float quality\nproperty uchar red\nproperty uchar green\nproperty uchar "
    "blue\n"
    "element face 1\nproperty list uchar int vertex_index\nend_header\n"
    "0 0 0 9 255 0 0\n100 0 0 9 0 255 0\n100 100 0 9 0 0 255\n0 100 0 9 1 2 3\n4 0 1 2 3\n";

}  // namespace

TEST_GROUP(PlyImport){};

TEST(PlyImport, ReadsWhatOtherProgramsWrite) {
  const Mesh mesh = import_ply(kSquare, 0.001, "square.ply");
  LONGS_EQUAL(4, mesh.vertices.size());
  LONGS_EQUAL(6, mesh.indices.size());  // the square became two triangles
  DOUBLES_EQUAL(0.1, static_cast<double>(mesh.vertices[2].position.y), 1e-7);
  DOUBLES_EQUAL(1, static_cast<double>(mesh.vertices[0].normal.z), 1e-6);  // from the faces
  LONGS_EQUAL(255, mesh.vertices[1].g);
}

TEST(PlyImport, ReadsWhatThisProgramWrites) {
  const Mesh square = import_ply(kSquare, 1, "square.ply");
  const Mesh again = import_ply(format_ply(square.view()), 1, "again.ply");
  LONGS_EQUAL(4, again.vertices.size());
  DOUBLES_EQUAL(100, static_cast<double>(again.vertices[2].position.x), 1e-5);
  LONGS_EQUAL(3, again.vertices[3].b);
}

TEST(PlyImport, RefusesWhatIsNoMeshOrIsCut) {
  const std::string good = kSquare, binary = format_ply(import_ply(kSquare, 1, "s").view());
  for (const std::string& bad :
       {std::string("solid cube"), std::string("ply\nformat ascii 1.0\n"), good.substr(0, good.size() - 12),
        good.substr(0, good.find("4 0 1 2 3")) + "4 0 1 2 7\n", binary.substr(0, binary.size() - 3),
        std::string("ply\nformat binary_big_endian 1.0\nend_header\n"),
        std::string("ply\nformat ascii 1.0\nelement vertex 99999999999999999999\nend_header\n")})
    CHECK_THROWS(Failure, import_ply(bad, 1, "bad.ply"));
}
