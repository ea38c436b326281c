// What the tools read back of a run, which may have been cut, edited or made by somebody else.
#include <cmath>

#include "hal/error.hpp"
#include "hal/results/object_files.hpp"
#include "hal/results/ply_file.hpp"
#include "hal/results/summary_file.hpp"
#include "hal/results/tum_file.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace st;
using namespace st::fuzz;

namespace {

template <typename Read>
void refuses_or_reads(Read read) {
  try {
    read();
  } catch (const Failure& failure) {
    require(failure.code() == ExitCode::kBadInput, "refused as bad input");
  }
}

std::string object_csv() {
  std::string text = std::string(kObjectColumns) + "\n";
  ObjectSample sample;
  for (const TrackState state :
       {TrackState::kGood, TrackState::kPredicted, TrackState::kPoor, TrackState::kLost}) {
    sample.state = state;
    append_object_row(text, 1.5, sample);
  }
  return text;
}

std::string small_ply() {
  const Mesh mesh{std::vector<MeshVertex>(3), {0, 1, 2}};
  return format_ply(mesh.view());
}

std::string summary() {
  RunEnd end;
  end.objects.resize(1);
  return format_summary(end, {}, {}, "0123456789abcdef");
}

}  // namespace

ST_FUZZ(tum_file, "# t x y z qx qy qz qw\n1.5 0.1 0.2 1.3 0 0 0 1\n", "1,2,3,4,0,0,0.7,0.7,robot\r\n") {
  const TumTrajectory read = parse_tum(text_of(data));
  for (std::size_t i = 0; i < read.poses.size(); ++i) {
    require(i == 0 || read.poses[i - 1].t_s <= read.poses[i].t_s, "sorted by time");
    for (const double r : read.poses[i].T.R.m) require(std::isfinite(r), "a rotation of numbers");
  }
}

ST_FUZZ(object_csv, object_csv()) {
  refuses_or_reads([&] { parse_object_csv(text_of(data), "object-1.csv"); });
}

ST_FUZZ(ply_file, small_ply()) {
  refuses_or_reads([&] {
    const Mesh mesh = parse_ply(text_of(data), "object-1.ply");
    for (const std::uint32_t index : mesh.indices)
      require(index < mesh.vertices.size(), "faces name vertices");
    require(parse_ply(format_ply(mesh.view()), "again").vertices.size() == mesh.vertices.size(),
            "what is read is written");
  });
}

ST_FUZZ(summary_file, summary()) {
  refuses_or_reads([&] { parse_summary(text_of(data), "summary.json"); });
}
