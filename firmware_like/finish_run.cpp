#include "firmware_like/finish_run.hpp"

#include <vector>

#include "firmware_like/run_study.hpp"
#include "hal/results/line_file.hpp"

namespace st {

void finish_run(ResultWriter& writer, const RunEnd& end, std::span<const PathSample> path) {
  writer.close_rows(end);
  RunAnalysis analysis;
  if (!writer.failed()) {
    std::vector<ObjectTrack> tracks;
    for (const ObjectEnd& object : end.objects) {
      const std::string name = writer.folder() + "/object-" + std::to_string(object.id) + ".csv";
      tracks.push_back({object.id, parse_object_csv(read_whole_file(name), name), object.mesh.vertices});
    }
    analysis = to_analysis(study_run(tracks, path, {end.steering_object, end.path_begins_t_s}));
  }
  writer.write_end(end, analysis);
}

}  // namespace st
