#include "firmware_like/scan_loop.hpp"

namespace st {

// KinectFusion (Newcombe et al. 2011, figure 3): measure, predict the surface, estimate the pose against it,
// fuse; the pose is judged before it may change the scene.
LoopEnd ScanLoop::run() {
  while (acquire()) {
    const LadderStep& step = ladder_step(level_);
    tracker_.preprocess(input_, report_);
    stages_.done(Stage::kPreprocess);
    tracker_.predict();
    stages_.done(Stage::kPredict);
    tracker_.render(step);
    stages_.done(Stage::kRender);
    tracker_.align(step);
    stages_.done(Stage::kAlign);
    tracker_.judge();
    stages_.done(Stage::kJudge);
    tracker_.integrate(step);
    stages_.done(Stage::kIntegrate);
    tracker_.decide();
    stages_.done(Stage::kDecide);
    tracker_.publish(report_);
    publish();
  }
  return end_;
}

}  // namespace st
