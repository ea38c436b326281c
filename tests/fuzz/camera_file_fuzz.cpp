#include "hal/error.hpp"
#include "hal/recording/camera_file.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace st;
using namespace st::fuzz;

ST_FUZZ(camera_file,
        "width = 640\nheight = 480\nfx = 578\nk = [0, 0, 0, 0, 0]\nraw_b = 1089.408\n[color]\nregistered = "
        "false\n"
        "R = [1, 0, 0, 0, 1, 0, 0, 0, 1]\nt = [-0.025, 0, 0]\n",
        "[correction]\ncolumns = 2\nrows = 2\nsteps = [0.5, -0.25, 1e1, 0]\n",
        "depth_scale = 5e3 # comment\ncolor = {fx = 525.0, registered = true}\n") {
  Calibration calibration;
  try {
    calibration = parse_camera_toml(text_of(data), "camera.toml", CameraKind::kKinect);
  } catch (const Failure& failure) {
    require(failure.code() == ExitCode::kBadInput, "refused as bad input");
    return;
  }
  require(calibration.depth.width >= 1 && calibration.depth.width <= kMaxWidth, "a width that fits");
  const DisparityCorrection& correction = calibration.correction;
  require(correction.empty() ||
              (correction.columns >= 2 && correction.columns <= DisparityCorrection::kMostColumns &&
               correction.rows >= 2 && correction.rows <= DisparityCorrection::kMostRows),
          "a grid that fits");
  require(calibration.depth.fx > 0 && calibration.color.fy > 0, "focal lengths above 0");
  parse_camera_toml(format_camera_toml(calibration), "camera.toml", CameraKind::kKinect);
}
