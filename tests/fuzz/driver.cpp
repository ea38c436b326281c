// startrack_fuzz [--seconds S] [--seed N] [--only NAME] [FILE...]: runs every harness on its seeds, on the
// given files and on random mutations of both, S seconds in all. A crash leaves its input in crash-NAME.bin.
// Without coverage feedback, so that it needs no compiler's run-time library; the same harnesses build with
// libFuzzer.
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <ctime>
#include <fstream>
#include <iterator>
#include <random>

#include "tests/fuzz/fuzz.hpp"

namespace st::fuzz {
namespace {

constexpr std::size_t kMaxInput = 1 << 16;

// The input at work, for the signal handler.
const std::uint8_t* g_data = nullptr;
std::size_t g_size = 0;
char g_crash_file[128];

void on_crash(int number) {
  const int file = open(g_crash_file, O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file >= 0 && write(file, g_data, g_size) >= 0) close(file);
  std::signal(number, SIG_DFL);
  std::raise(number);
}

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  std::size_t below(std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random_() % n); }

  std::string mutate(const std::vector<std::string>& corpus) {
    std::string text = corpus[below(corpus.size())];
    for (std::size_t steps = 1 + below(6); steps > 0; --steps) step(text, corpus);
    if (text.size() > kMaxInput) text.resize(kMaxInput);
    return text;
  }

 private:
  void step(std::string& text, const std::vector<std::string>& corpus) {
    static const std::string kWords[] = {"-",
                                         ".",
                                         "..",
                                         "/",
                                         "\n",
                                         "\r\n",
                                         "#",
                                         " ",
                                         "0",
                                         "-1",
                                         "1e308",
                                         "nan",
                                         "inf",
                                         "4294967295",
                                         "99999999999999999999",
                                         "65536",
                                         std::string(1, '\0'),
                                         "\xff\xff\xff\xff"};
    const std::size_t at = below(text.size() + 1),
                      length = below(std::min<std::size_t>(text.size() - at, 32) + 1);
    switch (below(8)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        break;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 2:
        text.erase(at, length);
        break;
      case 3:
        text.insert(at, text.substr(at, length));
        break;
      case 4:
        text.insert(at, kWords[below(std::size(kWords))]);
        break;
      case 5:
        text.resize(at);
        break;
      case 6: {  // the rest of another input
        const std::string& other = corpus[below(corpus.size())];
        text = text.substr(0, at) + other.substr(below(other.size() + 1));
        break;
      }
      default:
        if (at < text.size()) text[at] = static_cast<char>("0123456789-. \n"[below(14)]);
        break;
    }
  }

  std::mt19937_64 random_;
};

double now_s() {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_nsec) * 1e-9;
}

void run_one(const Harness& harness, const std::string& input) {
  // A copy of the exact size, so that a sanitizer sees a read beyond its end.
  const std::vector<std::uint8_t> bytes(input.begin(), input.end());
  g_data = bytes.data();
  g_size = bytes.size();
  harness.run(bytes);
}

void run_harness(const Harness& harness, const std::vector<std::string>& files, double seconds,
                 std::uint64_t seed) {
  std::snprintf(g_crash_file, sizeof g_crash_file, "crash-%s.bin", harness.name);
  std::vector<std::string> corpus = harness.seeds;
  corpus.insert(corpus.end(), files.begin(), files.end());
  corpus.emplace_back();
  for (const std::string& input : corpus) run_one(harness, input);
  Mutator mutator(seed);
  unsigned long long runs = corpus.size();
  for (const double end_s = now_s() + seconds; now_s() < end_s;)
    for (int i = 0; i < 64; ++i, ++runs) run_one(harness, mutator.mutate(corpus));
  std::printf("%s: %llu inputs\n", harness.name, runs);
}

}  // namespace
}  // namespace st::fuzz

int main(int argc, char** argv) {
  using namespace st::fuzz;
  double seconds = 10;
  std::uint64_t seed = 1;
  std::string only;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    const bool has_value = i + 1 < argc;
    if (word == "--seconds" && has_value) {
      seconds = std::atof(argv[++i]);
    } else if (word == "--seed" && has_value) {
      seed = std::strtoull(argv[++i], nullptr, 10);
    } else if (word == "--only" && has_value) {
      only = argv[++i];
    } else {
      std::ifstream in(argv[i], std::ios::binary);
      if (!in) {
        std::fprintf(stderr, "startrack_fuzz: %s: cannot be read\n", argv[i]);
        return 2;
      }
      files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
  }
  std::vector<Harness> chosen;
  for (const Harness& harness : harnesses())
    if (only.empty() || only == harness.name) chosen.push_back(harness);
  if (chosen.empty()) {
    std::fprintf(stderr, "startrack_fuzz: no harness %s\n", only.c_str());
    return 2;
  }
  for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) std::signal(number, on_crash);
  for (const Harness& harness : chosen)
    run_harness(harness, files, seconds / static_cast<double>(chosen.size()), seed);
  return 0;
}
