// A program with a sealed section that makes a known number of malloc and free pairs, to test the counter and
// its script: heap_probe PAIRS RUN writes RUN/summary.json as startrack does.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include "firmware_like/sealed_section.hpp"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const int pairs = std::atoi(argv[1]);
  std::uint64_t counted = 0;
  std::thread loop([pairs, &counted] {
    st::SealedSection sealed;
    for (int i = 0; i < pairs; ++i) {
      void* p = std::malloc(64);
      asm volatile("" : : "g"(p) : "memory");  // else the compiler leaves the pair out
      std::free(p);
    }
    sealed.end();
    counted = sealed.heap_calls();
  });
  loop.join();
  std::FILE* out = std::fopen((std::string(argv[2]) + "/summary.json").c_str(), "w");
  if (out == nullptr) return 2;
  std::fprintf(out, "{\"memory\": {\"heap_calls_after_seal\": %llu}}\n",
               static_cast<unsigned long long>(counted));
  std::fclose(out);
  std::printf("run: %s\n", argv[2]);
}
