// startrack_faults [--times N] [--jobs N] [--seed N] [--log FILE] [RULE...]: provokes every row of the safety
// rules N times at random moments, and prints how long the simulated robot took to stand and how far it went
// until then. With --log every outcome is appended to FILE at once, and what stands there already is not done
// again.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "tests/support/provocations.hpp"

using namespace st;
using namespace st::test;

namespace {

constexpr int kLongestWait_ms = 1500;  // under way, before it happens
constexpr int kTriesToDrive = 3;

struct Tally {
  std::vector<double> stood_ms, way_mm;
  int late = 0, went_on = 0, wrong_code = 0, never_drove = 0;
  bool good() const { return late + went_on + wrong_code + never_drove == 0 && !stood_ms.empty(); }
};

void count(Tally& tally, const Provocation& what, const Outcome& outcome) {
  if (!outcome.drove) {
    ++tally.never_drove;
    return;
  }
  if (what.exit_code != kAny && outcome.exit_code != what.exit_code) {
    ++tally.wrong_code;
    std::fprintf(stderr, "%s: code %d %s\n", what.name, outcome.exit_code, outcome.why.c_str());
  }
  if (outcome.stood_ms < 0) {
    ++tally.went_on;
    return;
  }
  if (outcome.stood_ms > row_named(what.rule).stands_within_ms) ++tally.late;
  tally.stood_ms.push_back(outcome.stood_ms);
  tally.way_mm.push_back(1000 * outcome.way_m);
}

// `provoked by<TAB>drove stood_ms way_m exit_code`, a line each.
class OutcomeLog {
 public:
  explicit OutcomeLog(const std::string& path) {
    if (path.empty()) return;
    std::ifstream before(path);
    for (std::string line; std::getline(before, line);) lines_.push_back(line);
    file_.open(path, std::ios::app);
  }
  std::vector<Outcome> of(const Provocation& what) const {
    std::vector<Outcome> outcomes;
    for (const std::string& line : lines_) {
      Outcome outcome;
      const std::size_t tab = line.find('\t');
      if (line.substr(0, tab) != what.name || tab == std::string::npos) continue;
      std::istringstream numbers(line.substr(tab));
      if (numbers >> outcome.drove >> outcome.stood_ms >> outcome.way_m >> outcome.exit_code)
        outcomes.push_back(outcome);
    }
    return outcomes;
  }
  void add(const Provocation& what, const Outcome& outcome) {
    if (file_.is_open())
      file_ << what.name << '\t' << outcome.drove << ' ' << outcome.stood_ms << ' ' << outcome.way_m << ' '
            << outcome.exit_code << std::endl;
  }

 private:
  std::vector<std::string> lines_;
  std::ofstream file_;
};

Tally repeat(const Provocation& what, int times, int jobs, unsigned seed, OutcomeLog& log) {
  Tally tally;
  const std::vector<Outcome> before = log.of(what);
  for (const Outcome& outcome : before) count(tally, what, outcome);
  std::mutex at_tally;
  std::atomic<int> left{times - static_cast<int>(before.size())};
  std::vector<std::thread> workers;
  for (int job = 0; job < jobs; ++job)
    workers.emplace_back([&, job] {
      std::mt19937 random(seed + static_cast<unsigned>(job) + 1000 * static_cast<unsigned>(before.size()));
      while (left.fetch_sub(1) > 0) {
        Outcome outcome;
        for (int attempt = 0; attempt < kTriesToDrive && !outcome.drove; ++attempt)
          outcome = provoke(what, static_cast<int>(random() % kLongestWait_ms));
        const std::lock_guard lock(at_tally);
        log.add(what, outcome);
        count(tally, what, outcome);
      }
    });
  for (std::thread& worker : workers) worker.join();
  return tally;
}

double at(std::vector<double>& values, double share) {
  if (values.empty()) return -1;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

}  // namespace

int main(int argc, char** argv) {
  int times = 10, jobs = 2;
  unsigned seed = 1;
  std::string log_file;
  std::vector<std::string_view> rules;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    int* number = word == "--times" ? &times : word == "--jobs" ? &jobs : nullptr;
    if (number != nullptr && i + 1 < argc)
      *number = std::max(1, std::atoi(argv[++i]));
    else if (word == "--seed" && i + 1 < argc)
      seed = static_cast<unsigned>(std::atoi(argv[++i]));
    else if (word == "--log" && i + 1 < argc)
      log_file = argv[++i];
    else
      rules.push_back(word);
  }
  OutcomeLog log(log_file);
  std::printf("%-15s %-42s %6s %8s %8s %8s %8s %8s  %s\n", "rule", "provoked by", "times", "limit ms",
              "p50 ms", "max ms", "p50 mm", "max mm", "verdict");
  bool good = true, any = false;
  for (const Provocation& what : provocations()) {
    if (!rules.empty() && std::find(rules.begin(), rules.end(), what.rule) == rules.end()) continue;
    any = true;
    Tally tally = repeat(what, times, jobs, seed, log);
    good = good && tally.good();
    std::printf("%-15s %-42s %6zu %8d %8.0f %8.0f %8.0f %8.0f  ", what.rule, what.name, tally.stood_ms.size(),
                row_named(what.rule).stands_within_ms, at(tally.stood_ms, 0.5), at(tally.stood_ms, 1),
                at(tally.way_mm, 0.5), at(tally.way_mm, 1));
    if (tally.good())
      std::printf("held\n");
    else
      std::printf("FAILED: %d late, %d drove on, %d wrong exit codes, %d never drove\n", tally.late,
                  tally.went_on, tally.wrong_code, tally.never_drove);
    std::fflush(stdout);
  }
  if (!any) std::fprintf(stderr, "startrack_faults: no such rule; `startrack drive --rules` lists them\n");
  return !any ? 2 : good ? 0 : 1;
}
