#include <cmath>

#include "firmware_like/path_file.hpp"
#include "hal/error.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace st;
using namespace st::fuzz;

namespace {

// Whatever is accepted can be driven: no wheel above the robot's most, every sample a number, rest at the
// end.
void check(const Path& path) {
  require(!path.empty() && path.size() <= Path::kMaxSegments, "has steps, and no more than fit");
  require(std::isfinite(path.duration_s()) && path.duration_s() >= 0, "takes a time");
  for (int i = 0; i <= 16; ++i) {
    const PathSample p = sample(path, path.duration_s() * i / 16);
    require(std::isfinite(p.x_m) && std::isfinite(p.y_m) && std::isfinite(p.yaw_rad), "is somewhere");
    require(std::fabs(p.v_mps) <= 0.5 + 1e-9, "is no faster than the robot");
  }
  const PathSample end = sample(path, path.duration_s() + 1);
  require(end.v_mps == 0 && end.w_rps == 0, "stands at the end");
}

template <typename Parse>
void try_to(Parse parse) {
  Path path;
  try {
    path = parse();
  } catch (const Failure& failure) {
    require(failure.code() == ExitCode::kBadInput, "refused as bad input");
    require(std::string_view(failure.what()).find("p:") == 0, "names the file and the line");
    return;
  }
  check(path);
}

}  // namespace

ST_FUZZ(path_toml,
        "speed_mps = 0.2\naccel_mps2 = 0.4\nturn_deg_per_s = 60\n[[step]]\nline = 1.0\n[[step]]\nturn = 90\n",
        "[[step]]\narc = { radius_m = 0.4, angle_deg = 90 }\n[[step]]\nwait = 2.0\n",
        "[[step]]\ncircle = { radius_m = 0.5, turns = 1, direction = \"right\" }\n",
        "[[step]]\nsquare = { side_m = 1.0 }\n",
        "area = { x_m = [-1, 2], y_m = [-1, 1] }\n[[step]]\npolygon = { sides = 5, side_m = 0.5 }\n",
        "[[step]]\nfigure_eight = { radius_m = 0.4, turns = 2, direction = \"left\" }\n",
        "[[step]]\nrepeat = { times = 3, steps = [ { line = 0.5 }, { turn = 120 } ] }\n") {
  try_to([&] { return parse_path_toml(text_of(data), "p"); });
}

ST_FUZZ(path_csv, "x,y\n1,0\n1,1\n0,0\n", "# way\nx, y\r\n0.5,-0.25\r\n") {
  try_to([&] { return parse_path_csv(text_of(data), "p"); });
}
