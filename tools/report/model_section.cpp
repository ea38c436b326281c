#include "algo/core/scalar_math.hpp"
#include "tools/report/mesh_picture.hpp"
#include "tools/report/sections.hpp"
#include "tools/report/svg_chart.hpp"

namespace st {
namespace {

std::string picture(const MeshView& mesh, const MeshFrame& frame, const ViewDirection& view,
                    const std::string& name) {
  constexpr int kPixels = 420;
  return "<div class=\"view\"><img alt=\"" + name + "\" src=\"data:image/png;base64," +
         base64(encode_png(render_mesh(mesh, frame, view, kPixels))) + "\"><div class=\"caption\">" + name +
         "</div></div>";
}

const ObjectStudy* study_of(const RunStudy& study, int id) {
  for (const ObjectStudy& object : study.objects)
    if (object.id == id) return &object;
  return nullptr;
}

std::string base_line(const ObjectStudy& study) {
  const BaseEstimate& base = study.base;
  return "<p>Turning centre at (" + number(base.x_m * 1e3, 1) + ", " + number(base.y_m * 1e3, 1) +
         ") mm in the object's frame, &plusmn; " + number(base.sigma_m * 1e3, 1) + " mm; forward at " +
         number(base.yaw_rad * 180 / kPi, 2) + "&deg; &plusmn; " + number(base.sigma_rad * 180 / kPi, 2) +
         "&deg;.</p>";
}

}  // namespace

std::string model_section(const ReportInput& input) {
  std::string content;
  for (const RunRecord::Object& object : input.run.objects) {
    if (object.mesh.vertices.empty()) continue;
    const ObjectStudy* study = study_of(input.study, object.id);
    const bool has_base = study != nullptr && study->has_base;
    const double forward = has_base ? study->base.yaw_rad : 0;
    const MeshView mesh = object.mesh.view();
    const MeshFrame frame = frame_of(mesh);
    content += "<h3>Object " + std::to_string(object.id) + "</h3><div class=\"views\">" +
               picture(mesh, frame, view_from_above(forward),
                       has_base ? "from above, forward is up" : "from above") +
               picture(mesh, frame, view_from_front(forward), "from the front") +
               picture(mesh, frame, view_oblique(forward), "from the front left") + "</div>";
    content += "<p class=\"note\">" + std::to_string(mesh.vertices.size()) + " vertices, " +
               std::to_string(mesh.indices.size() / 3) + " triangles.</p>";
    if (has_base) content += base_line(*study);
  }
  return section("Reconstructed models", content);
}

std::string scene_section(const ReportInput& input) {
  std::string content;
  if (!input.run.camera.empty()) {
    Chart map;
    map.x_label = "x, to the right of the first view (m)";
    map.y_label = "z, along the first view (m)";
    map.equal_axes = true;
    map.height = 480;
    map.series.push_back({"camera", "actual", {{}}});
    for (const TumPose& pose : input.run.camera) map.series[0].lines[0].push_back({pose.T.t.x, pose.T.t.z});
    const Vec3 &first = input.run.camera.front().T.t, &last = input.run.camera.back().T.t;
    map.marks.push_back({first.x, first.z, 0.5 * kPi, "actual", ChartMark::Kind::kArrow});
    map.marks.push_back({last.x, last.z, 0, "actual", ChartMark::Kind::kSquare});
    content += figure(
        draw(map), "The way of the camera, seen from above. Arrow: its first view; square: its last place.");
  }
  if (const MeshView mesh = input.run.scene.view(); !mesh.vertices.empty())
    content += "<div class=\"views\">" +
               picture(mesh, frame_of(mesh), view_of_scene(), "as the camera first saw it") + "</div>";
  return section("Scan", content);
}

}  // namespace st
