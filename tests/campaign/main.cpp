#include <cstdio>
#include <string_view>

#include "tests/campaign/campaign.hpp"

int main(int argc, char** argv) {
  const std::string_view name = argc == 2 ? argv[1] : "";
  if (name == "convergence") {
    st::campaign::print_convergence();
  } else if (name == "fusion") {
    st::campaign::print_fusion();
  } else {
    std::fputs("usage: startrack_campaign convergence | fusion\n", stderr);
    return 2;
  }
  return 0;
}
