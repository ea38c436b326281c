// The camera's lag beside the wheels' reports, by trying: coarsely over all that it may be, then finely about
// the best.
#pragma once

namespace st {

// `at(lag_s)` is what the lag explains, with the lag as its lag_s; `better(a, b)`: a explains more.
template <typename At, typename Better>
auto best_lag(At&& at, Better&& better) {
  constexpr double kLeast_s = -0.06, kMost_s = 0.20, kCoarse_s = 0.02, kFine_s = 0.0025;
  auto best = at(0.0);
  const auto search = [&](double from_s, double until_s, double step_s) {
    for (double lag_s = from_s; lag_s <= until_s; lag_s += step_s)
      if (const auto tried = at(lag_s); better(tried, best)) best = tried;
  };
  search(kLeast_s, kMost_s, kCoarse_s);
  search(best.lag_s - kCoarse_s, best.lag_s + kCoarse_s, kFine_s);
  return best;
}

}  // namespace st
